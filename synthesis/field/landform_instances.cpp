#include "synthesis/field/landform_instances.h"

#include <variant>

#include "synthesis/field/bare_body.h"

namespace astrolith {
namespace {

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

LandformInstances::LandformInstances(const ImplicitField& field, const Recipe& recipe,
                                     const std::optional<PatchCube>& patch, double cell)
    : bare_(bare_body(recipe)),
      origin_(patch ? patch->center : Vec3d{}),
      listed_(listed_landforms(field, patch)) {
  std::vector<Box> rock_boxes, rim_boxes;
  for (std::size_t row = 0; row < listed_.size(); ++row) {
    const ListedLandform& listed = listed_[row];
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

std::int32_t LandformInstances::row_at(const Vec3d& p, float ground) const {
  const std::int32_t rock = boulder_at(p, ground);
  return rock >= 0 ? rock : crater_at(p);
}

std::int32_t LandformInstances::boulder_at(const Vec3d& p, float ground) const {
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

std::int32_t LandformInstances::crater_at(const Vec3d& p) const {
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
