#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "geometry/io/longitude_latitude_internal.h"
#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

std::array<float, 2> texcoord_of(const Vec3d& place) {
  const double longitude = portable::atan2(place.y, place.x);
  const double latitude = portable::atan2(place.z, std::sqrt(place.x * place.x + place.y * place.y));
  return {static_cast<float>(0.5 + longitude / (2.0 * std::numbers::pi)),
          static_cast<float>(0.5 - latitude / std::numbers::pi)};
}

}  // namespace

LongitudeLatitude longitude_latitude(const TriangleMesh& mesh, const Vec3d& origin) {
  LongitudeLatitude result;
  result.texcoords.reserve(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) result.texcoords.push_back(texcoord_of(v + origin));
  std::unordered_map<std::uint32_t, std::uint32_t> second;
  const auto second_of = [&](std::uint32_t vertex) {
    const auto [found, is_new] =
        second.try_emplace(vertex, static_cast<std::uint32_t>(result.texcoords.size()));
    if (is_new) {
      result.doubled.push_back(vertex);
      result.texcoords.push_back({result.texcoords[vertex][0] + 1.0f, result.texcoords[vertex][1]});
    }
    return found->second;
  };
  result.triangles = mesh.triangles;
  for (Triangle& triangle : result.triangles) {
    const auto u = [&](int corner) {
      return result.texcoords[triangle[static_cast<std::size_t>(corner)]][0];
    };
    const auto [west, east] = std::minmax({u(0), u(1), u(2)});
    if (east - west <= 0.5f) continue;
    for (std::uint32_t& vertex : triangle) {
      if (result.texcoords[vertex][0] < 0.5f) vertex = second_of(vertex);
    }
  }
  return result;
}

}  // namespace astrolith
