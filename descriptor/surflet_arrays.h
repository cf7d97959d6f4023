// The oriented points (surflets) of a pair count, in the order in which the CPU and the GPU both count them.
// The order matters: which of two points comes first decides how a pair on the border of a bin is rounded.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/surflet_pair.h"
#include "numerics/vec3.h"

namespace astrolith {

// Pointers to the coordinates of consecutive surflets: point, normal, moment.
struct SurfletRun {
  std::array<const float*, 9> c;
};

// The number of elements that may be read behind the last surflet of a run.
inline constexpr std::size_t kSurfletPadding = 64;

// One array for each coordinate, for vector loads, with room behind the last point. Points of one local code
// stand together. Among them a hash of the position decides the order. The order in which points are given
// therefore changes nothing, and neighbours in space do not follow one another; their pairs with a third
// point often share a bin.
struct SurfletArrays {
  std::array<std::vector<float>, 9> c;      // (n + kSurfletPadding) each
  std::vector<std::int64_t> first_of_code;  // (num_local + 1)

  // Points must be in units of their largest distance, normals must have unit length, and local codes must be
  // in [0, num_local).
  SurfletArrays(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                std::span<const std::int32_t> local, int num_local);

  std::int64_t size() const { return first_of_code.back(); }
  Surflet at(std::int64_t i) const {
    const auto k = static_cast<std::size_t>(i);
    return {{c[0][k], c[1][k], c[2][k]}, {c[3][k], c[4][k], c[5][k]}, {c[6][k], c[7][k], c[8][k]}};
  }
  SurfletRun from(std::int64_t i) const {
    SurfletRun run{};
    for (std::size_t d = 0; d < c.size(); ++d) run.c[d] = c[d].data() + i;
    return run;
  }

 private:
  void set(std::size_t k, const Surflet& s);
};

}  // namespace astrolith
