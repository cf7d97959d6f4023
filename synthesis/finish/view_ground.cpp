#include "synthesis/finish/view_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/landforms/population.h"

namespace astrolith {
namespace view_ground {

constexpr int kCells = 63;          // along a cube: with the one below its sides 8 blocks of 8
constexpr int kCoarsestCells = 96;  // along the longest side of the body
constexpr int kMostLevels = 24;
constexpr double kLeastLandform = 1.5;  // cells
constexpr double kMostTriangles = 3e7;
constexpr std::int64_t kBlock = 8;  // cubes along the side of a field
constexpr std::size_t kKeptFields = 16;
constexpr int kEveryLevel = -1;

// A cube of space; its place counts in sides of the cubes of its level.
struct GroundCube {
  int level = 0;
  std::array<std::int64_t, 3> at{};
  auto operator<=>(const GroundCube&) const = default;
};

// The lattices of cubes.
struct CubeLattice {
  Vec3d corner;
  double coarsest = 0.0;  // edge of the cells of level 0

  double cell(int level) const { return coarsest / static_cast<double>(std::int64_t{1} << level); }
  double side(int level) const { return kCells * cell(level); }
  Box box(const GroundCube& cube, std::int64_t cubes = 1) const {
    const double s = side(cube.level);
    const auto place = [&](std::int64_t more) {
      return corner + s * Vec3d{static_cast<double>(cube.at[0] + more),
                                static_cast<double>(cube.at[1] + more),
                                static_cast<double>(cube.at[2] + more)};
    };
    return {place(0), place(cubes)};
  }
  GroundCube at(int level, const Vec3d& p) const {
    const Vec3d q = (1.0 / side(level)) * (p - corner);
    const auto whole = [](double v) { return static_cast<std::int64_t>(std::floor(v)); };
    return {level, {whole(q.x), whole(q.y), whole(q.z)}};
  }
};

// The first cube of the block of cubes that share a field.
GroundCube block_begin(const GroundCube& cube) {
  const auto begin = [](std::int64_t at) { return at - ((at % kBlock) + kBlock) % kBlock; };
  return {cube.level, {begin(cube.at[0]), begin(cube.at[1]), begin(cube.at[2])}};
}

// The recipe as cells of this edge show it: without landforms that are drawn by cells and are finer. Returns
// whether there are any.
bool leave_out_fine_landforms(Recipe& recipe, double cell) {
  const double least = kLeastLandform * cell;
  bool is_less = false;
  for (Layer& layer : recipe.layers) {
    const auto cut = [&]<class Landforms>(Landforms& l) {
      if (!l.population || !l.population->drawn.by_cells) return;
      Population& drawn = l.population->drawn;
      if (!(drawn.least_diameter < least)) return;
      is_less = true;
      if (!(least < drawn.greatest_diameter)) return l.population.reset();
      *drawn.density *= 1.0 - share_below(drawn, least);
      drawn.least_diameter = least;
    };
    if (auto* craters = std::get_if<CraterLayer>(&layer)) cut(*craters);
    if (auto* boulders = std::get_if<BoulderLayer>(&layer)) cut(*boulders);
  }
  return is_less;
}

// The pyramid that a camera sees, with its distortion, and how far away cells look how wide.
class SeenPyramid {
 public:
  // `origin` is that of the axes in which points are asked for, in those of the camera.
  SeenPyramid(const SceneCamera& camera, const Vec3d& origin)
      : camera_(camera), eye_(camera.position() - origin) {
    constexpr int kSteps = 16;
    const Calibration& c = camera.calibration();
    for (int k = 0; k <= kSteps; ++k) {
      const double along = static_cast<double>(k) / kSteps;
      const double column = -0.5 + along * c.width, row = -0.5 + along * c.height;
      for (const ImagePoint& p :
           {ImagePoint{column, -0.5}, {column, c.height - 0.5}, {-0.5, row}, {c.width - 0.5, row}}) {
        const Vec3d d = camera.direction(p);
        const double depth = dot(d, camera.boresight());
        across_ = std::max(across_, std::fabs(dot(d, camera.right())) / depth);
        down_ = std::max(down_, std::fabs(dot(d, camera.down())) / depth);
      }
    }
  }

  const Vec3d& eye() const { return eye_; }

  // What a pixel is wide at this distance, length units.
  double pixel_at(double distance) const {
    const Calibration& c = camera_.calibration();
    return distance / std::max(c.fx, c.fy);
  }

  // Whether the picture shows a point or the ground within `margin` of it.
  bool shows(const Vec3d& p, double margin) const {
    const Vec3d from = p - eye_;
    const double depth = dot(from, camera_.boresight());
    const auto within = [&](const Vec3d& axis, double tangent) {
      return std::fabs(dot(from, axis)) <= tangent * std::max(depth, 0.0) + margin * (1.0 + tangent);
    };
    return depth > -margin && within(camera_.right(), across_) && within(camera_.down(), down_);
  }

 private:
  const SceneCamera& camera_;
  Vec3d eye_;
  double across_ = 0.0, down_ = 0.0;
};

struct Tile {
  TriangleMesh mesh;
  std::vector<float> albedo;
};

// The field of a level, for a block of cubes or for all.
struct LevelField {
  GroundCube block;  // level kEveryLevel: all levels
  Recipe recipe;
  Vec3d center;
  bool is_patch;
  ImplicitField field;
  std::optional<SurfaceColors> colors;

  LevelField(const GroundCube& given_block, Recipe given_recipe, const std::string& name,
             const std::optional<Box>& around, const Progress& progress, const ImplicitField* like)
      : block(given_block),
        recipe(std::move(given_recipe)),
        center(around ? around->center() : Vec3d{}),
        is_patch(around.has_value()),
        field(recipe, name, around ? std::optional(PatchCube{center, around->extent().x}) : std::nullopt,
              progress, like) {
    if (stated_albedo(recipe)) colors.emplace(recipe, name, field);
  }

  Tile make_tile(const Box& cube, double cell) const {
    const Vec3d origin = is_patch ? center : cube.center();
    MeshCollector made;
    // As in make_patch_grid(), a layer of cells below each lower side owns the samples in that side.
    const SampleGrid grid{
        cube.min - origin - Vec3d{cell, cell, cell}, cell, {kCells + 1, kCells + 1, kCells + 1}};
    mesh_part(PatchField(field, origin), grid, made);
    Tile tile{std::move(made.mesh), {}};
    if (colors) tile.albedo = find_albedo(origin, tile.mesh);
    for (Vec3d& v : tile.mesh.vertices) v += origin;
    return tile;
  }

  std::vector<float> find_albedo(const Vec3d& origin, const TriangleMesh& mesh) const {
    std::vector<MeshVertex> vertices(mesh.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
      vertices[i] = {to_float(mesh.vertices[i]), to_float(mesh.normals[i])};
    std::vector<Vec3f> albedo(vertices.size());
    colors->find_albedo(origin, vertices, albedo);
    std::vector<float> grey(vertices.size());
    for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = (albedo[i].x + albedo[i].y + albedo[i].z) / 3.0f;
    return grey;
  }
};

class Cubes {
 public:
  Cubes(const Recipe& recipe, std::string name, double width, const Progress& progress)
      : recipe_(recipe), name_(std::move(name)), width_(width) {
    Recipe bare = recipe;
    leave_out_fine_landforms(bare, std::numeric_limits<double>::max());
    body_.emplace(bare, name_, std::nullopt, progress);
    const Box bounds = body_->bounds();
    if (bounds.empty()) throw InputError(name_ + ": body: has no surface");
    lattice_ = {bounds.min, bounds.longest_side() / kCoarsestCells};
    const GroundCube low = lattice_.at(0, bounds.min), high = lattice_.at(0, bounds.max);
    for (std::int64_t x = low.at[0] - 1; x <= high.at[0] + 1; ++x) {
      for (std::int64_t y = low.at[1] - 1; y <= high.at[1] + 1; ++y) {
        for (std::int64_t z = low.at[2] - 1; z <= high.at[2] + 1; ++z) all_.insert({0, {x, y, z}});
      }
    }
    Recipe coarsest = recipe;
    const bool is_less = leave_out_fine_landforms(coarsest, lattice_.coarsest);
    const bool is_every_level = !is_less && body_->left_out().empty();
    fields_.push_back(std::make_shared<const LevelField>(GroundCube{is_every_level ? kEveryLevel : 0, {}},
                                                         std::move(coarsest), name_, std::nullopt, progress,
                                                         &*body_));
  }

  std::shared_ptr<const GroundLook> look(const SceneCamera& camera, const Progress& progress) {
    const SeenPyramid seen(camera, recipe_.origin);
    std::vector<CubeSet> shown{all_};
    try {
      refine(shown, seen, progress);
    } catch (...) {
      forget_all_but(shown_);
      throw;
    }
    if (look_ && shown == shown_) return look_;
    const std::vector<CubeSet> before = std::exchange(shown_, std::move(shown));
    forget_all_but(shown_, before);
    look_ = std::make_shared<const GroundLook>(join());
    return look_;
  }

 private:
  using CubeSet = std::set<GroundCube>;

  // Adds level after level, until cells look narrow enough.
  void refine(std::vector<CubeSet>& shown, const SeenPyramid& seen, const Progress& progress) {
    double triangles = 0.0;
    for (int level = 0; level < kMostLevels && !shown.back().empty(); ++level) {
      if (!report(progress, 0.0, fmt::format("cells of {:.3g}", lattice_.cell(level))))
        throw WorkError("scene: stopped before the ground was made");
      // Half of the cubes hold no ground, and even ground has 8,000 triangles in a cube.
      constexpr double kLeastInACube = 2000.0;
      require_few(triangles + kLeastInACube * static_cast<double>(shown.back().size()));
      make_tiles(shown.back(), progress);
      for (const GroundCube& cube : shown.back())
        triangles += static_cast<double>(tiles_.at(cube)->mesh.triangles.size());
      require_few(triangles);
      shown.push_back(too_coarse(shown.back(), level, seen));
    }
    if (shown.back().empty()) shown.pop_back();
  }

  void require_few(double triangles) const {
    if (triangles <= kMostTriangles) return;
    throw InputError(name_ +
                     ": detail: this picture would take more than 3e7 triangles; raise detail, or "
                     "take fewer pixels");
  }

  // Drops the tiles that no level of either shows.
  void forget_all_but(const std::vector<CubeSet>& levels, const std::vector<CubeSet>& others = {}) {
    std::erase_if(tiles_, [&](const auto& entry) {
      const auto has = [&](const std::vector<CubeSet>& shown) {
        const auto level = static_cast<std::size_t>(entry.first.level);
        return level < shown.size() && shown[level].contains(entry.first);
      };
      return !has(levels) && !has(others);
    });
  }

  const LevelField& field_for(const GroundCube& cube, const Progress& progress) {
    const GroundCube block = block_begin(cube);
    const auto found = std::find_if(fields_.begin(), fields_.end(), [&](const auto& field) {
      const GroundCube& made = field->block;
      return made.level == kEveryLevel || (cube.level == 0 ? made.level == 0 : made == block);
    });
    if (found != fields_.end()) return **found;
    Recipe recipe = recipe_;
    leave_out_fine_landforms(recipe, lattice_.cell(cube.level));
    const Box around = widened(lattice_.box(block, kBlock), lattice_.cell(cube.level));
    if (fields_.size() > kKeptFields) fields_.erase(fields_.begin() + 1);
    fields_.push_back(
        std::make_shared<const LevelField>(block, std::move(recipe), name_, around, progress, &*body_));
    return *fields_.back();
  }

  void make_tiles(const CubeSet& cubes, const Progress& progress) {
    std::map<GroundCube, std::vector<GroundCube>> blocks;
    for (const GroundCube& cube : cubes)
      if (!tiles_.contains(cube)) blocks[block_begin(cube)].push_back(cube);
    for (const auto& entry : blocks) {
      const std::vector<GroundCube>& missing = entry.second;
      const LevelField& field = field_for(entry.first, progress);
      std::vector<std::shared_ptr<const Tile>> made(missing.size());
      parallel_for(0, static_cast<std::int64_t>(missing.size()), [&](std::int64_t i) {
        const GroundCube& cube = missing[static_cast<std::size_t>(i)];
        made[static_cast<std::size_t>(i)] =
            std::make_shared<const Tile>(field.make_tile(lattice_.box(cube), lattice_.cell(cube.level)));
      });
      for (std::size_t i = 0; i < missing.size(); ++i) tiles_[missing[i]] = std::move(made[i]);
    }
  }

  // The cubes of the next level around ground that is seen with cells too wide.
  CubeSet too_coarse(const CubeSet& cubes, int level, const SeenPyramid& seen) const {
    const double cell = lattice_.cell(level), around = 1.5 * cell;
    constexpr double kTurnedAway = -0.3;  // a coarse normal's cosine, for ground that finer cells may turn
    CubeSet finer;
    for (const GroundCube& cube : cubes) {
      const TriangleMesh& mesh = tiles_.at(cube)->mesh;
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3d& p = mesh.vertices[i];
        const Vec3d to_eye = seen.eye() - p;
        const double distance = norm(to_eye);
        if (cell <= width_ * seen.pixel_at(std::max(distance - cell, 0.0))) continue;
        if (dot(mesh.normals[i], to_eye) < kTurnedAway * distance || !seen.shows(p, around)) continue;
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3d off{corner & 1 ? around : -around, corner & 2 ? around : -around,
                          corner & 4 ? around : -around};
          finer.insert(lattice_.at(level + 1, p + off));
        }
      }
    }
    return finer;
  }

  // The triangles of a tile that no finer cubes hide.
  std::vector<Triangle> left_of(const GroundCube& cube) const {
    const auto next = static_cast<std::size_t>(cube.level) + 1;
    const TriangleMesh& mesh = tiles_.at(cube)->mesh;
    if (next >= shown_.size()) return mesh.triangles;
    std::vector<char> is_hidden(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      is_hidden[i] = shown_[next].contains(lattice_.at(cube.level + 1, mesh.vertices[i])) ? 1 : 0;
    std::vector<Triangle> left;
    for (const Triangle& t : mesh.triangles)
      if (!is_hidden[t[0]] || !is_hidden[t[1]] || !is_hidden[t[2]]) left.push_back(t);
    return left;
  }

  GroundLook join() const {
    std::vector<GroundCube> cubes;
    for (const CubeSet& level : shown_) cubes.insert(cubes.end(), level.begin(), level.end());
    std::vector<std::vector<Triangle>> left(cubes.size());
    parallel_for(0, static_cast<std::int64_t>(cubes.size()), [&](std::int64_t i) {
      left[static_cast<std::size_t>(i)] = left_of(cubes[static_cast<std::size_t>(i)]);
    });
    GroundLook look;
    look.levels = static_cast<int>(shown_.size());
    look.finest = lattice_.cell(look.levels - 1);
    for (std::size_t i = 0; i < cubes.size(); ++i) add(*tiles_.at(cubes[i]), left[i], look);
    return look;
  }

  // Adds the triangles of a tile and the vertices that they name.
  void add(const Tile& tile, const std::vector<Triangle>& triangles, GroundLook& look) const {
    constexpr std::uint32_t kUnused = ~std::uint32_t{0};
    std::vector<std::uint32_t> number(tile.mesh.vertices.size(), kUnused);
    for (const Triangle& t : triangles) {
      Triangle renamed;
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& n = number[t[k]];
        if (n == kUnused) {
          n = static_cast<std::uint32_t>(look.mesh.vertices.size());
          look.mesh.vertices.push_back(recipe_.origin + tile.mesh.vertices[t[k]]);
          look.mesh.normals.push_back(tile.mesh.normals[t[k]]);
          if (!tile.albedo.empty()) look.albedo.push_back(tile.albedo[t[k]]);
        }
        renamed[k] = n;
      }
      look.mesh.triangles.push_back(renamed);
    }
  }

  Recipe recipe_;
  std::string name_;
  double width_;                       // of cells, in pixels
  std::optional<ImplicitField> body_;  // without landforms that are drawn by cells
  CubeLattice lattice_;
  CubeSet all_;                                            // of level 0
  std::vector<std::shared_ptr<const LevelField>> fields_;  // first that of level 0 or of every level
  std::map<GroundCube, std::shared_ptr<const Tile>> tiles_;
  std::vector<CubeSet> shown_;  // by level
  std::shared_ptr<const GroundLook> look_;
};

}  // namespace view_ground

ViewGround::ViewGround(const Recipe& recipe, const std::string& name, double cell, const Progress& progress) {
  if (!(cell >= 0.25 && cell <= 16.0))
    throw InputError(fmt::format("detail: {:g} is outside .25 to 16 pixels", cell));
  if (recipe.erosion) {
    throw InputError(name +
                     ": erosion: acts on a whole mesh, which a scene in detail never makes; leave "
                     "erosion out, or give the mesh");
  }
  cubes_ = std::make_unique<view_ground::Cubes>(recipe, name, cell, progress);
}

ViewGround::~ViewGround() = default;

std::shared_ptr<const GroundLook> ViewGround::look(const SceneCamera& camera, const Progress& progress) {
  return cubes_->look(camera, progress);
}

}  // namespace astrolith
