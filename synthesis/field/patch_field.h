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
#pragma once

#include "numerics/interval.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

class PatchBlock {
 public:
  PatchBlock(FieldBlock block, const Vec3d& origin) : block_(std::move(block)), origin_(origin) {}

  BlockContent content() const { return block_.content(); }
  PatchBlock restricted_to(const Box& local) const {
    return {block_.restricted_to(in_body(local, origin_)), origin_};
  }
  void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> value, float band) const {
    block_.evaluate_local(origin_, x, y, z, value, band);
  }
  void evaluate_tetrahedra(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                           std::span<float> value) const {
    block_.evaluate_local_tetrahedra(origin_, x, y, z, value);
  }

  // A box of the body's frame that holds every point of a local box, after rounding to float coordinates.
  static Box in_body(const Box& local, const Vec3d& origin) {
    const Box moved{local.min + origin, local.max + origin};
    return widened(moved, 0x1p-23 * largest_coordinate(moved));
  }

 private:
  FieldBlock block_;
  Vec3d origin_;
};

class PatchField {
 public:
  // The field must outlive the PatchField.
  PatchField(const ImplicitField& field, const Vec3d& origin) : field_(field), origin_(origin) {}

  PatchBlock gather(const Box& local) const {
    return {field_.gather(PatchBlock::in_body(local, origin_)), origin_};
  }

 private:
  const ImplicitField& field_;
  Vec3d origin_;
};

}  // namespace astrolith
