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

#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/surface/ground_axes.h"
#include "numerics/interval.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

// Points that are turned from axes of the ground to the body's frame, a coordinate at a time.
struct TurnedPoints {
  TurnedPoints(const GroundAxes& axes, std::span<const float> along_right, std::span<const float> along_ahead,
               std::span<const float> along_up)
      : x(along_up.size()), y(along_up.size()), z(along_up.size()) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vec3f p =
          to_float(axes.to_frame({double{along_right[i]}, double{along_ahead[i]}, double{along_up[i]}}));
      x[i] = p.x, y[i] = p.y, z[i] = p.z;
    }
  }
  std::vector<float> x, y, z;
};

class PatchBlock {
 public:
  PatchBlock(FieldBlock block, const Vec3d& origin, const std::optional<GroundAxes>& axes)
      : block_(std::move(block)), origin_(origin), axes_(axes) {}

  BlockContent content() const { return block_.content(); }
  PatchBlock restricted_to(const Box& local) const {
    return {block_.restricted_to(in_body(local, origin_, axes_)), origin_, axes_};
  }
  void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> value, float band) const {
    if (!axes_) return block_.evaluate_local(origin_, x, y, z, value, band);
    const TurnedPoints p(*axes_, x, y, z);
    block_.evaluate_local(origin_, p.x, p.y, p.z, value, band);
  }
  void evaluate_tetrahedra(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                           std::span<float> value) const {
    if (!axes_) return block_.evaluate_local_tetrahedra(origin_, x, y, z, value);
    const TurnedPoints p(*axes_, x, y, z);
    block_.evaluate_local_tetrahedra(origin_, p.x, p.y, p.z, value);
  }

  // A box of the body's frame that holds every point of a local box, after rounding to float coordinates.
  static Box in_body(const Box& local, const Vec3d& origin, const std::optional<GroundAxes>& axes = {}) {
    const Box turned = axes ? turned_box(local, *axes) : local;
    const Box moved{turned.min + origin, turned.max + origin};
    return widened(moved, 0x1p-23 * largest_coordinate(moved));
  }

 private:
  // A box of the body's axes that holds a box of the ground's.
  static Box turned_box(const Box& local, const GroundAxes& axes) {
    const Vec3d half = 0.5 * local.extent(), center = axes.to_frame(local.center());
    const auto reach = [&](double Vec3d::*axis) {
      return half.x * std::fabs(axes.right.*axis) + half.y * std::fabs(axes.ahead.*axis) +
             half.z * std::fabs(axes.up.*axis);
    };
    const Vec3d r{reach(&Vec3d::x), reach(&Vec3d::y), reach(&Vec3d::z)};
    return {center - r, center + r};
  }

  FieldBlock block_;
  Vec3d origin_;
  std::optional<GroundAxes> axes_;
};

class PatchField {
 public:
  // The field must outlive the PatchField. Without axes, local coordinates lie along the body's.
  PatchField(const ImplicitField& field, const Vec3d& origin, const std::optional<GroundAxes>& axes = {})
      : field_(field), origin_(origin), axes_(axes) {}

  PatchBlock gather(const Box& local) const {
    return {field_.gather(PatchBlock::in_body(local, origin_, axes_)), origin_, axes_};
  }

 private:
  const ImplicitField& field_;
  Vec3d origin_;
  std::optional<GroundAxes> axes_;
};

}  // namespace astrolith
