// Points of a surface in chunks, each with the block of the field around it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "numerics/parallel_for.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

struct PointChunk {
  static constexpr std::size_t kMost = 256;

  std::size_t first, count;  // of the points
  FieldBlock block;
  const Vec3d*
      origin;  // of the coordinates, those of the field's patch; null for coordinates of the body's frame
  std::array<std::array<float, kMost>, 3> coordinates;

  std::span<const float> along(std::size_t axis) const { return {coordinates[axis].data(), count}; }
};

// Calls use(chunk) for `count` points origin + local(i), with many threads.
template <class Local, class Use>
void for_each_chunk(const ImplicitField& field, const Vec3d& origin, std::size_t count, const Local& local,
                    const Use& use) {
  const bool in_patch = field.has_patch_layers();
  const std::size_t chunks = (count + PointChunk::kMost - 1) / PointChunk::kMost;
  parallel_for(0, static_cast<std::int64_t>(chunks), [&](std::int64_t c) {
    const std::size_t first = static_cast<std::size_t>(c) * PointChunk::kMost;
    const std::size_t size = std::min(PointChunk::kMost, count - first);
    std::array<std::array<float, PointChunk::kMost>, 3> coordinates;
    Box box;
    for (std::size_t i = 0; i < size; ++i) {
      const Vec3f p = local(first + i);
      const Vec3f at = to_float(origin + Vec3d{double{p.x}, double{p.y}, double{p.z}});
      box.extend({double{at.x}, double{at.y}, double{at.z}});
      const Vec3f& given = in_patch ? p : at;
      coordinates[0][i] = given.x, coordinates[1][i] = given.y, coordinates[2][i] = given.z;
    }
    use(PointChunk{first, size, field.gather(box), in_patch ? &origin : nullptr, coordinates});
  });
}

}  // namespace astrolith
