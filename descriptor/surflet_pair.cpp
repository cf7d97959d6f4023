#include "descriptor/surflet_pair.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

std::uint32_t position_hash(const Vec3d& p) {
  std::uint32_t hash = 0;
  for (const double value : {p.x, p.y, p.z}) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    hash = hash_append(hash_append(hash, static_cast<std::uint32_t>(bits)),
                       static_cast<std::uint32_t>(bits >> 32));
  }
  return hash;
}

std::vector<std::uint32_t> sort_surflets(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                         std::span<const std::int32_t> local) {
  // Places with the same hash, such as repeated points, are ordered by all their numbers.
  const auto all = [&](std::uint32_t i) {
    const Vec3d &p = points[i], &n = normals[i];
    return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z);
  };
  std::vector<std::tuple<std::int32_t, std::uint32_t, std::uint32_t>> keys(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) keys[i] = {local[i], position_hash(points[i]), i};
  std::sort(keys.begin(), keys.end(), [&](const auto& a, const auto& b) {
    const auto [code_a, hash_a, i] = a;
    const auto [code_b, hash_b, j] = b;
    return std::tie(code_a, hash_a) != std::tie(code_b, hash_b)
               ? std::tie(code_a, hash_a) < std::tie(code_b, hash_b)
               : all(i) < all(j);
  });
  std::vector<std::uint32_t> order;
  for (const auto& key : keys) order.push_back(std::get<2>(key));
  return order;
}

}  // namespace

SurfletArrays::SurfletArrays(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                             std::span<const std::int32_t> local, int num_local) {
  for (auto& v : c) v.assign(points.size() + kSurfletPadding, 0.0f);
  code_first.assign(static_cast<std::size_t>(num_local) + 1, 0);
  std::size_t k = 0;
  for (const std::uint32_t i : sort_surflets(points, normals, local)) {
    set(k++, surflet(to_float(points[i]), to_float(normals[i])));
    ++code_first[static_cast<std::size_t>(local[i]) + 1];
  }
  std::partial_sum(code_first.begin(), code_first.end(), code_first.begin());
}

void SurfletArrays::set(std::size_t k, const Surflet& s) {
  const float values[] = {s.point.x,  s.point.y,  s.point.z,  s.normal.x, s.normal.y,
                          s.normal.z, s.moment.x, s.moment.y, s.moment.z};
  for (std::size_t d = 0; d < c.size(); ++d) c[d][k] = values[d];
}

}  // namespace astrolith
