#include "synthesis/field/feature_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/surface_labels.h"

namespace astrolith {
namespace {

bool reaches_patch(const Vec3d& center, double radius, const std::optional<PatchCube>& cube) {
  if (!cube) return true;
  Vec3d d = center - cube->center;
  double side = cube->side;
  if (cube->turned) {
    const GroundAxes& axes = cube->turned->axes;
    d = {dot(d, axes.right), dot(d, axes.ahead), dot(d, axes.up)};
    side = cube->turned->side;
  }
  const auto beyond = [&](double x) { return std::max(std::abs(x) - 0.5 * side, 0.0); };
  return norm(Vec3d{beyond(d.x), beyond(d.y), beyond(d.z)}) <= radius;
}

constexpr std::size_t kPoints = 65;

struct Stretch {
  double low, high;

  double at(std::size_t k) const { return low + (high - low) * (static_cast<double>(k) / (kPoints - 1)); }
};

using Values = std::array<float, kPoints>;

Values values_along(const ImplicitField& field, const Vec3d& from, const Vec3d& direction, const Stretch& t) {
  Values x, y, z, values;
  Box box;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Vec3d p = from + t.at(k) * direction;
    x[k] = static_cast<float>(p.x);
    y[k] = static_cast<float>(p.y);
    z[k] = static_cast<float>(p.z);
    box.extend({x[k], y[k], z[k]});
  }
  field.gather(box).evaluate(x, y, z, values);
  return values;
}

// The part of the stretch between two neighbours on different sides, those that lie nearest to t = 0.
std::optional<Stretch> narrowed(const Values& values, const Stretch& t) {
  std::optional<Stretch> nearest;
  for (std::size_t k = 0; k + 1 < kPoints; ++k) {
    if ((values[k] > 0.0f) == (values[k + 1] > 0.0f)) continue;
    const Stretch part{t.at(k), t.at(k + 1)};
    if (!nearest || std::abs(part.low + part.high) < std::abs(nearest->low + nearest->high)) nearest = part;
  }
  return nearest;
}

constexpr std::array kNumbers = {"x",        "y",        "z",        "mesh_x",   "mesh_y", "mesh_z",
                                 "center_x", "center_y", "center_z", "diameter", "depth",  "rim_height",
                                 "age",      "axis_b",   "axis_c",   "heading",  "tilt",   "burial"};
constexpr std::size_t kSurfaceColumn = 0, kMeshColumn = 3, kCenterColumn = 6, kFirstSizeColumn = 9;

constexpr const char* kBoulder = "boulder";
constexpr double kHigh = 0.1;  // cells: what is lower does not show

using Numbers = std::array<std::optional<double>, kNumbers.size()>;  // absent where the kind has none

struct Row {
  int layer;
  std::string kind;
  Numbers numbers;
  bool resolved;  // by the mesh
  double top;     // the surface is looked for about this height above the centre ...
  double reach;   // ... and so far from there, length units
};

void set_point(Numbers& numbers, std::size_t column, const Vec3d& p) {
  numbers[column] = p.x;
  numbers[column + 1] = p.y;
  numbers[column + 2] = p.z;
}

void add_to_point(Numbers& numbers, std::size_t column, const Vec3d& p) {
  if (!numbers[column]) return;
  *numbers[column] += p.x;
  *numbers[column + 1] += p.y;
  *numbers[column + 2] += p.z;
}

Vec3d row_point(const Row& row, std::size_t column) {
  return {*row.numbers[column], *row.numbers[column + 1], *row.numbers[column + 2]};
}

Row crater_row(int layer, const PlacedCrater& c, double height_bound) {
  Row row{layer, c.complex ? "complex crater" : "simple crater", {}, false, 0.0, height_bound};
  set_point(row.numbers, kCenterColumn, c.position);
  const std::array sizes{c.diameter, c.depth, c.rim_height, c.age};
  std::copy(sizes.begin(), sizes.end(), row.numbers.begin() + kFirstSizeColumn);
  return row;
}

// Half the boulder's extent along a unit vector, as if it were an ellipsoid.
double half_extent(const PlacedBoulder& b, const Vec3d& direction) {
  double square = 0.0;
  const std::array axes{b.axes.x, b.axes.y, b.axes.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const double part = 0.5 * axes[k] * dot(b.directions[k], direction);
    square += part * part;
  }
  return std::sqrt(square);
}

Row boulder_row(int layer, const PlacedBoulder& b, const BareSurface& bare) {
  const double top = half_extent(b, bare.normal(b.center));
  Row row{layer, kBoulder, {}, false, top, top};
  set_point(row.numbers, kCenterColumn, b.center);
  const std::array<std::optional<double>, 9> sizes{b.axes.x, {},        {},     {},      b.axes.y,
                                                   b.axes.z, b.heading, b.tilt, b.burial};
  std::copy(sizes.begin(), sizes.end(), row.numbers.begin() + kFirstSizeColumn);
  return row;
}

std::vector<Row> list_rows(const ImplicitField& field, const BareSurface& bare,
                           const std::optional<PatchCube>& patch, double cell) {
  std::vector<Row> rows;
  for (const Feature& listed : list_features(field, patch)) {
    rows.push_back(listed.crater != nullptr ? crater_row(listed.layer, *listed.crater, field.height_bound())
                                            : boulder_row(listed.layer, *listed.boulder, bare));
    rows.back().resolved = is_resolved(listed, cell);
  }
  return rows;
}

void find_surface_points(const ImplicitField& field, const BareSurface& bare, const Vec3d& origin,
                         std::vector<Row>& rows) {
  parallel_for(
      0, static_cast<std::int64_t>(rows.size()),
      [&](std::int64_t i) {
        Row& row = rows[static_cast<std::size_t>(i)];
        const Vec3d center = row_point(row, kCenterColumn), normal = bare.normal(center);
        const auto point = nearest_crossing(field, center + row.top * normal, normal, row.reach);
        if (!point) return;
        set_point(row.numbers, kSurfaceColumn, *point);
        set_point(row.numbers, kMeshColumn, *point - origin);
      },
      16);
}

// A boulder is resolved where the surface above its centre is its rock, and stands out of the ground there by
// a tenth of a cell: the ground of layers below, or a larger boulder, may cover it.
void leave_out_hidden_boulders(const ImplicitField& field, const Recipe& recipe,
                               const std::optional<PatchCube>& patch, double cell, std::vector<Row>& rows) {
  std::vector<std::size_t> shown;
  std::vector<MeshVertex> tops;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = rows[i];
    if (row.kind != kBoulder || !row.resolved) continue;
    row.resolved = row.numbers[kMeshColumn].has_value();
    if (!row.resolved) continue;
    shown.push_back(i);
    tops.push_back({to_float(row_point(row, kMeshColumn)), {}});
  }
  const Vec3d origin = patch ? patch->center : Vec3d{};
  std::vector<VertexLabel> labels(tops.size());
  std::vector<float> ground(tops.size());
  SurfaceLabels(recipe, field, patch).label(origin, tops, labels, ground);
  const FeatureFinder finder(field, recipe, patch, cell);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    Row& row = rows[shown[k]];
    const bool stands_out = double{ground[k]} < -kHigh * cell;
    row.resolved = stands_out && finder.row_at(origin + row_point(row, kMeshColumn), ground[k]) ==
                                     static_cast<std::int32_t>(shown[k]);
  }
}

std::string to_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string to_csv(const std::vector<Row>& rows, const Recipe& recipe) {
  std::string text = "layer,kind";
  for (const char* column : kNumbers) text += std::string(",") + column;
  text += ",length_unit,resolved";
  for (const Row& row : rows) {
    text += '\n' + std::to_string(row.layer) + ',' + row.kind;
    for (const auto& number : row.numbers) text += ',' + (number ? to_text(*number) : "");
    text += ',' + recipe.length_unit + (row.resolved ? ",1" : ",0");
  }
  return text + '\n';
}

std::string to_json(const std::vector<Row>& rows, const Recipe& recipe, const Vec3d& origin) {
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  std::string text = "{\n  \"length_unit\": " + quoted(recipe.length_unit) +
                     ",\n  \"frame\": " + quoted(recipe.frame) + ",\n  \"origin\": [" + to_text(origin.x) +
                     ", " + to_text(origin.y) + ", " + to_text(origin.z) + "],\n  \"features\": [";
  const char* separator = "\n";
  for (const Row& row : rows) {
    text += std::string(separator) + "    {\"layer\": " + std::to_string(row.layer) + ", \"kind\": \"" +
            row.kind + '"';
    for (std::size_t k = 0; k < kNumbers.size(); ++k) {
      if (row.numbers[k]) text += std::string(", \"") + kNumbers[k] + "\": " + to_text(*row.numbers[k]);
    }
    text += row.resolved ? ", \"resolved\": true}" : ", \"resolved\": false}";
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

constexpr int kProjectionSteps = 3;  // of Newton's method, which doubles the digits with each

// The point of the bare surface below or above a point near it.
Vec3d on_bare_body(const BareBody& body, Vec3d p) {
  for (int step = 0; step < kProjectionSteps; ++step) {
    const Vec3d gradient = body.gradient(p);
    const double square = squared_norm(gradient);
    if (!(square > 0.0)) break;
    p = p - (body.value(p) / square) * gradient;
  }
  return p;
}

Box box_about(const Vec3d& center, double reach) {
  const Vec3d r{reach, reach, reach};
  return {center - r, center + r};
}

}  // namespace

bool is_resolved(const Feature& landform, double cell) {
  constexpr double kAcross = 2.0;  // cells
  const PlacedCrater* const crater = landform.crater;
  if (crater != nullptr)
    return crater->diameter >= kAcross * cell && crater->depth + crater->rim_height >= kHigh * cell;
  const PlacedBoulder& boulder = *landform.boulder;
  return boulder.axes.y >= kAcross * cell && (1.0 - boulder.burial) * boulder.axes.z >= kHigh * cell;
}

std::vector<Feature> list_features(const ImplicitField& field, const std::optional<PatchCube>& patch) {
  std::vector<Feature> listed;
  for (const LayerCraters& layer : field.craters()) {
    for (const PlacedCrater& c : layer.craters) {
      if (reaches_patch(c.position, 0.5 * c.diameter, patch)) listed.push_back({layer.layer, &c, nullptr});
    }
  }
  for (const LayerBoulders& layer : field.boulders()) {
    for (const PlacedBoulder& b : layer.boulders) {
      if (reaches_patch(b.center, 0.5 * std::max({b.axes.x, b.axes.y, b.axes.z}), patch))
        listed.push_back({layer.layer, nullptr, &b});
    }
  }
  return listed;
}

std::optional<Vec3d> nearest_crossing(const ImplicitField& field, const Vec3d& from, const Vec3d& direction,
                                      double reach) {
  std::optional<Stretch> t = Stretch{-reach, reach};
  for (int round = 0; t && round < 3; ++round) {
    t = narrowed(values_along(field, from, direction, *t), *t);
  }
  if (!t) return std::nullopt;
  return from + 0.5 * (t->low + t->high) * direction;
}

void write_feature_list(const ImplicitField& field, const Recipe& recipe,
                        const std::optional<PatchCube>& patch, double cell,
                        const std::filesystem::path& file) {
  const BareSurface bare(bare_body(recipe));
  const Vec3d origin = patch ? patch->center : Vec3d{};
  std::vector<Row> rows = list_rows(field, bare, patch, cell);
  find_surface_points(field, bare, origin, rows);
  leave_out_hidden_boulders(field, recipe, patch, cell, rows);
  for (Row& row : rows) {
    for (const std::size_t column : {kCenterColumn, kSurfaceColumn}) {
      add_to_point(row.numbers, column, recipe.origin);
    }
  }
  write_file(file, file.extension() == ".json" ? to_json(rows, recipe, recipe.origin + origin)
                                               : to_csv(rows, recipe));
}

FeatureFinder::FeatureFinder(const ImplicitField& field, const Recipe& recipe,
                             const std::optional<PatchCube>& patch, double cell)
    : bare_(bare_body(recipe)),
      origin_(patch ? patch->center : Vec3d{}),
      listed_(list_features(field, patch)) {
  std::vector<Box> rock_boxes, rim_boxes;
  for (std::size_t row = 0; row < listed_.size(); ++row) {
    const Feature& listed = listed_[row];
    if (!is_resolved(listed, cell)) continue;
    if (listed.crater != nullptr) {
      rims_.push_back(static_cast<std::int32_t>(row));
      rim_boxes.push_back(
          box_about(listed.crater->position, 0.5 * listed.crater->diameter + field.height_bound()));
    } else {
      const auto& layer = std::get<BoulderLayer>(recipe.layers[static_cast<std::size_t>(listed.layer)]);
      PlacedBoulder moved = *listed.boulder;
      moved.center -= origin_;
      const FieldBoulder rock = field_boulders(layer, {&moved, 1}).front();
      rocks_.push_back({static_cast<std::int32_t>(row), rock.kernel});
      rock_boxes.push_back(rock.box);
    }
  }
  rock_tree_ = BoxTree(rock_boxes);
  rim_tree_ = BoxTree(rim_boxes);
}

std::int32_t FeatureFinder::row_at(const Vec3d& p, float ground) const {
  const std::int32_t rock = boulder_at(p, ground);
  return rock >= 0 ? rock : crater_at(p);
}

std::int32_t FeatureFinder::boulder_at(const Vec3d& p, float ground) const {
  const Vec3d local = p - origin_;
  const Vec3f at = to_float(local);
  std::int32_t row = -1;
  float outermost = ground;
  for (const std::uint32_t k : rock_tree_.touching({local, local})) {
    const Rock& rock = rocks_[k];
    const float inside = boulder_distance(rock.kernel, boulder_coordinates(rock.kernel, at.x, at.y, at.z));
    if (inside > outermost) {
      outermost = inside;
      row = rock.row;
    }
  }
  return row;
}

std::int32_t FeatureFinder::crater_at(const Vec3d& p) const {
  const std::vector<std::uint32_t> near = rim_tree_.touching({p, p});
  if (near.empty()) return -1;
  const Vec3d foot = on_bare_body(bare_, p);
  for (auto k = near.rbegin(); k != near.rend(); ++k) {
    const PlacedCrater& crater = *listed_[static_cast<std::size_t>(rims_[*k])].crater;
    if (squared_norm(foot - crater.position) < 0.25 * crater.diameter * crater.diameter) return rims_[*k];
  }
  return -1;
}

}  // namespace astrolith
