// A field in coordinates local to an origin of double precision, for mesh_patch().
//
//   mesh_patch(PatchField(field, {0.12345678901, 0.2, -0.05}), 1e-5, 256, sink);   // vertices are local
//
// Float coordinates in a body's frame have a spacing of about 2^-24 of its size: 0.02 mm on a body of 500 m.
// F is uncertain by as much. A PatchField evaluates a body that has_local_form() and fractal layers to the
// digits of local coordinates. If the field was made for the patch, that also holds for every layer of noise
// whose details are fine beside this spacing. Other bodies and layers are evaluated at points rounded to
// float coordinates of the body's frame. This rounding moves their pattern by up to one spacing, and changes
// its slope by one spacing over a cell. Otherwise the surface is that of the ImplicitField, which leaves out
// what float coordinates of the body's frame cannot hold.
//
// Local coordinates lie along the axes of the body's frame, or along given axes, such as those of the ground.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_place.h"

namespace astrolith {

// Points along the body's axes, from points of a turned patch, a coordinate at a time.
struct TurnedPoints {
  TurnedPoints(const PatchPlace& place, std::span<const float> along_right,
               std::span<const float> along_ahead, std::span<const float> along_up)
      : x(along_up.size()), y(along_up.size()), z(along_up.size()) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3f p = place.along_body({along_right[i], along_ahead[i], along_up[i]});
      x[i] = p.x, y[i] = p.y, z[i] = p.z;
    }
  }
  std::vector<float> x, y, z;
};

class PatchBlock {
 public:
  PatchBlock(FieldBlock block, const PatchPlace& place) : block_(std::move(block)), place_(place) {}

  BlockContent content() const { return block_.content(); }
  PatchBlock restricted_to(const Box& local) const {
    return {block_.restricted_to(place_.in_body(local)), place_};
  }
  void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> value, float band) const {
    if (!place_.turned) return block_.evaluate_local(place_.origin, x, y, z, value, band);
    const TurnedPoints p(place_, x, y, z);
    block_.evaluate_local(place_.origin, p.x, p.y, p.z, value, band);
  }
  void evaluate_tetrahedra(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                           std::span<float> value) const {
    if (!place_.turned) return block_.evaluate_local_tetrahedra(place_.origin, x, y, z, value);
    const TurnedPoints p(place_, x, y, z);
    block_.evaluate_local_tetrahedra(place_.origin, p.x, p.y, p.z, value);
  }

 private:
  FieldBlock block_;
  PatchPlace place_;
};

class PatchField {
 public:
  // The field must outlive the PatchField. Without axes, local coordinates lie along the body's.
  PatchField(const ImplicitField& field, const Vec3d& origin, const std::optional<GroundAxes>& axes = {})
      : field_(field), place_(origin, axes) {}

  PatchBlock gather(const Box& local) const { return {field_.gather(place_.in_body(local)), place_}; }

  // The field that it was made of, and where it lies in that field.
  const ImplicitField& whole() const { return field_; }
  const PatchPlace& place() const { return place_; }

 private:
  const ImplicitField& field_;
  PatchPlace place_;
};

}  // namespace astrolith
