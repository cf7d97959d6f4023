// A field in coordinates local to an origin of double precision: what mesh_patch meshes.
//
//   mesh_patch(PatchField(field, {0.12345678901, 0.2, -0.05}), 1e-5, 256, sink);   // vertices are local
//
// Float coordinates of a body's frame tell points apart to 2^-24 of its size, and its field is as uncertain:
// on a body of 500 m, 0.02 mm. Here the body and the layers that can (implicit_field.h) are evaluated to the
// digits of local coordinates; the others see their points rounded to the body's float coordinates, which
// moves their pattern by up to that, and tilts it by that over a cell. The surface is the same but for such
// rounding.
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

  // Holds the body's float coordinates of every point of a local box.
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
  // The field must live longer.
  PatchField(const ImplicitField& field, const Vec3d& origin) : field_(field), origin_(origin) {}

  PatchBlock gather(const Box& local) const {
    return {field_.gather(PatchBlock::in_body(local, origin_)), origin_};
  }

 private:
  const ImplicitField& field_;
  Vec3d origin_;
};

}  // namespace astrolith
