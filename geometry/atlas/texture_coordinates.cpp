#include "geometry/atlas/texture_coordinates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "numerics/portable_angles.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

// Cuts a mesh and keeps it closed: the triangles on both sides of an edge share the vertex of its cut.
class MeridianCut {
 public:
  MeridianCut(const TriangleMesh& mesh, const Vec3d& origin) : mesh_(mesh), origin_(origin) {}

  TriangleMesh result() {
    std::vector<Triangle> pierced, cut;
    for (const Triangle& t : mesh_.triangles) cut_at_axis(t, pierced);
    for (const Triangle& t : pierced) cut_at_meridian(t, cut);
    mesh_.triangles = std::move(cut);
    return std::move(mesh_);
  }

 private:
  Vec3d place(std::uint32_t v) const { return mesh_.vertices[v] + origin_; }

  // Above 0 where the axis lies to the left of the way from a to b, seen from +z.
  double side(std::uint32_t a, std::uint32_t b) const {
    const Vec3d p = place(a), q = place(b);
    return p.x * q.y - p.y * q.x;
  }

  std::uint32_t add(const Triangle& of, const std::array<double, 3>& weights, const Vec3d& at) {
    const auto mixed = [&](const std::vector<Vec3d>& values) {
      return weights[0] * values[of[0]] + weights[1] * values[of[1]] + weights[2] * values[of[2]];
    };
    mesh_.vertices.push_back(at - origin_);
    if (!mesh_.normals.empty()) mesh_.normals.push_back(normalized(mixed(mesh_.normals)));
    if (!mesh_.colors.empty()) {
      VertexColor color{};
      for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0.5;
        for (std::size_t c = 0; c < 3; ++c) sum += weights[c] * mesh_.colors[of[c]][k];
        color[k] = static_cast<std::uint8_t>(std::clamp(sum, 0.0, 255.0));
      }
      mesh_.colors.push_back(color);
    }
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  // The vertex where an edge meets the axis or the meridian, at share `s` of the way from its first vertex.
  std::uint32_t add_on_edge(std::uint32_t a, std::uint32_t b, bool on_axis) {
    const auto [found, is_new] = on_edges_.try_emplace(std::minmax(a, b), 0);
    if (!is_new) return found->second;
    const auto [first, second] = found->first;
    const Vec3d p = place(first), q = place(second);
    const double s = on_axis && p.y == q.y ? p.x / (p.x - q.x) : p.y / (p.y - q.y);
    Vec3d at = p + s * (q - p);
    at.y = 0.0;
    if (on_axis) at.x = 0.0;
    return found->second = add({first, second, second}, {1.0 - s, s, 0.0}, at);
  }

  void cut_at_axis(const Triangle& t, std::vector<Triangle>& out) {
    const std::array<double, 3> sides{side(t[0], t[1]), side(t[1], t[2]), side(t[2], t[0])};
    const double sum = sides[0] + sides[1] + sides[2];
    const auto is_inside = [&](double s) { return sum > 0.0 ? s > 0.0 : s < 0.0; };
    if (std::all_of(sides.begin(), sides.end(), is_inside)) {
      const std::array<double, 3> weights{sides[1] / sum, sides[2] / sum, sides[0] / sum};
      const double z = weights[0] * place(t[0]).z + weights[1] * place(t[1]).z + weights[2] * place(t[2]).z;
      const std::uint32_t pole = add(t, weights, {0.0, 0.0, z});
      for (std::size_t k = 0; k < 3; ++k) out.push_back({t[k], t[(k + 1) % 3], pole});
      return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      if (sides[k] != 0.0 || !passes_axis(a, b)) continue;
      const std::uint32_t pole = add_on_edge(a, b, true);
      cut_at_axis({a, pole, c}, out);
      cut_at_axis({pole, b, c}, out);
      return;
    }
    out.push_back(t);
  }

  // Whether an edge in a plane with the axis has it between its ends.
  bool passes_axis(std::uint32_t a, std::uint32_t b) const {
    const Vec3d p = place(a), q = place(b);
    return p.x * q.x + p.y * q.y < 0.0;
  }

  bool crosses_meridian(std::uint32_t a, std::uint32_t b) const {
    const Vec3d p = place(a), q = place(b);
    if (!((p.y < 0.0 && q.y > 0.0) || (p.y > 0.0 && q.y < 0.0))) return false;
    // The edge meets y = 0 at x = (p.x q.y - p.y q.x) / (q.y - p.y).
    return q.y > p.y ? side(a, b) < 0.0 : side(a, b) > 0.0;
  }

  void cut_at_meridian(const Triangle& t, std::vector<Triangle>& out) {
    std::vector<std::uint32_t> polygon;  // corners and cuts in their order, the first cut first
    std::array<bool, 3> cut;
    for (std::size_t k = 0; k < 3; ++k) cut[k] = crosses_meridian(t[k], t[(k + 1) % 3]);
    const auto cuts = std::count(cut.begin(), cut.end(), true);
    if (cuts == 0) return out.push_back(t);
    // With two cuts, edge `start` and the next one are cut, and the corner between them stands alone.
    std::size_t start = 0;
    while (!(cut[start] && (cuts == 1 || cut[(start + 1) % 3]))) ++start;
    const std::uint32_t a = t[start], b = t[(start + 1) % 3], c = t[(start + 2) % 3];
    const std::uint32_t first = add_on_edge(a, b, false);
    if (cuts == 1) {
      out.push_back({a, first, c});
      out.push_back({first, b, c});
      return;
    }
    const std::uint32_t second = add_on_edge(b, c, false);
    out.push_back({first, b, second});
    out.push_back({a, first, second});
    out.push_back({a, second, c});
  }

  TriangleMesh mesh_;
  Vec3d origin_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> on_edges_;
};

double longitude_share(const Vec3d& p) { return 0.5 + portable::atan2(p.y, p.x) / (2.0 * std::numbers::pi); }

float latitude_share(const Vec3d& p) {
  const double latitude = portable::atan2(p.z, std::sqrt(p.x * p.x + p.y * p.y));
  return static_cast<float>(0.5 - latitude / std::numbers::pi);
}

bool is_on_axis(const Vec3d& p) { return p.x == 0.0 && p.y == 0.0; }

// The u of a triangle's corners, which lie on one side of the 180th meridian.
std::array<double, 3> triangle_longitudes(const std::array<Vec3d, 3>& p) {
  const bool is_east = p[0].y + p[1].y + p[2].y > 0.0;
  std::array<double, 3> u{};
  double sum = 0.0, others = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_on_axis(p[k])) continue;
    u[k] = p[k].y == 0.0 && p[k].x < 0.0 ? (is_east ? 1.0 : 0.0) : longitude_share(p[k]);
    sum += u[k], others += 1.0;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_on_axis(p[k])) u[k] = others > 0.0 ? sum / others : 0.5;
  }
  return u;
}

// The derivative of position by u over a triangle, times a positive number, and twice the area of its image,
// negative for a mirrored one.
struct TextureSlope {
  Vec3d along_u;
  double area;
};

TextureSlope texture_slope(const std::array<Vec3d, 3>& p, const std::array<TexturePoint, 3>& t) {
  const double u1 = double{t[1][0]} - t[0][0], u2 = double{t[2][0]} - t[0][0];
  // Upwards in the image, which is -v.
  const double v1 = double{t[0][1]} - t[1][1], v2 = double{t[0][1]} - t[2][1];
  const double area = u1 * v2 - u2 * v1;
  const double sign = area < 0.0 ? -1.0 : 1.0;
  return {sign * (v2 * (p[1] - p[0]) - v1 * (p[2] - p[0])), area};
}

Vec3d along_plane(const Vec3d& v, const Vec3d& normal) { return v - dot(v, normal) * normal; }

double corner_angle(const Vec3d& a, const Vec3d& b) { return portable::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace

LongitudeMap longitude_map(const TriangleMesh& mesh, const Vec3d& origin) {
  LongitudeMap map{MeridianCut(mesh, origin).result(), {}};
  TextureCoordinates& made = map.coordinates;
  std::map<std::pair<std::uint32_t, float>, std::uint32_t> known;
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> first_textured(map.mesh.vertices.size(),
                                            kNone);  // textured vertices, one for most
  const auto textured = [&](std::uint32_t vertex, const Vec3d& place, float u) {
    const auto number = static_cast<std::uint32_t>(made.uv.size());
    std::uint32_t& first = first_textured[vertex];
    if (first != kNone && made.uv[first][0] == u) return first;
    if (first != kNone) {
      const auto [found, is_new] = known.try_emplace({vertex, u}, number);
      if (!is_new) return found->second;
    } else {
      first = number;
    }
    made.mesh_vertex.push_back(vertex);
    made.uv.push_back({u, latitude_share(place)});
    return number;
  };
  for (const Triangle& t : map.mesh.triangles) {
    std::array<Vec3d, 3> places;
    for (std::size_t k = 0; k < 3; ++k) places[k] = map.mesh.vertices[t[k]] + origin;
    const std::array<double, 3> u = triangle_longitudes(places);
    Triangle& out = made.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) out[k] = textured(t[k], places[k], static_cast<float>(u[k]));
  }
  return map;
}

std::vector<VertexTangent> vertex_tangents(const TriangleMesh& mesh, const TextureCoordinates& coordinates) {
  std::vector<Vec3d> sums(coordinates.uv.size());
  std::vector<double> areas(coordinates.uv.size());  // slivers, whose sign is that of rounding, count little
  for (const Triangle& t : coordinates.triangles) {
    std::array<Vec3d, 3> p;
    std::array<TexturePoint, 3> uv;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = mesh.vertices[coordinates.mesh_vertex[t[k]]], uv[k] = coordinates.uv[t[k]];
    const TextureSlope slope = texture_slope(p, uv);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& normal = mesh.normals[coordinates.mesh_vertex[t[k]]];
      const Vec3d next = along_plane(p[(k + 1) % 3] - p[k], normal),
                  last = along_plane(p[(k + 2) % 3] - p[k], normal);
      sums[t[k]] += corner_angle(next, last) * normalized(along_plane(slope.along_u, normal));
      areas[t[k]] += slope.area;
    }
  }
  std::vector<VertexTangent> tangents(sums.size());
  for (std::size_t w = 0; w < sums.size(); ++w) {
    const Vec3d& normal = mesh.normals[coordinates.mesh_vertex[w]];
    Vec3d tangent = normalized(along_plane(sums[w], normal));
    if (!(squared_norm(tangent) > 0.0)) tangent = crossed_tangents(normal).first;
    const Vec3f t = to_float(tangent);
    tangents[w] = {t.x, t.y, t.z, areas[w] < 0.0 ? -1.0f : 1.0f};
  }
  return tangents;
}

}  // namespace astrolith
