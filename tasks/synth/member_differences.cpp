#include "tasks/synth/member_differences.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/surface/surface_distance.h"

namespace astrolith {
namespace {

constexpr int kPixels = 128;  // along the longest side of the silhouettes
constexpr std::int64_t kSamples = 4000;

// The pixels of a silhouette along an axis, in a frame that holds all bodies that are compared.
class Silhouette {
 public:
  Silhouette(const TriangleMesh& mesh, const Box& frame, std::size_t axis)
      : axis_(axis), covered_(std::size_t{kPixels} * kPixels, 0) {
    corner_ = frame.min;
    pixel_ = frame.longest_side() / kPixels;
    for (const Triangle& t : mesh.triangles)
      cover(place(mesh.vertices[t[0]]), place(mesh.vertices[t[1]]), place(mesh.vertices[t[2]]));
  }
  const std::vector<char>& covered() const { return covered_; }

 private:
  struct Place {
    double u, v;  // pixels
  };
  Place place(const Vec3d& p) const {
    const std::array<double, 3> at{p.x - corner_.x, p.y - corner_.y, p.z - corner_.z};
    return {at[(axis_ + 1) % 3] / pixel_, at[(axis_ + 2) % 3] / pixel_};
  }
  static double side(const Place& a, const Place& b, double u, double v) {
    return (b.u - a.u) * (v - a.v) - (b.v - a.v) * (u - a.u);
  }
  // Covers the pixels whose middles lie in a triangle.
  void cover(const Place& a, const Place& b, const Place& c) {
    const auto first = [](double at) { return std::max(0, static_cast<int>(std::ceil(at - 0.5))); };
    const auto last = [](double at) { return std::min(kPixels - 1, static_cast<int>(std::floor(at - 0.5))); };
    for (int j = first(std::min({a.v, b.v, c.v})); j <= last(std::max({a.v, b.v, c.v})); ++j) {
      for (int i = first(std::min({a.u, b.u, c.u})); i <= last(std::max({a.u, b.u, c.u})); ++i) {
        const double u = i + 0.5, v = j + 0.5;
        const double side_ab = side(a, b, u, v), side_bc = side(b, c, u, v), side_ca = side(c, a, u, v);
        const bool in = (side_ab >= 0.0 && side_bc >= 0.0 && side_ca >= 0.0) ||
                        (side_ab <= 0.0 && side_bc <= 0.0 && side_ca <= 0.0);
        if (in) covered_[static_cast<std::size_t>(i) + static_cast<std::size_t>(j) * kPixels] = 1;
      }
    }
  }

  std::size_t axis_;
  Vec3d corner_;
  double pixel_ = 1.0;
  std::vector<char> covered_;
};

nlohmann::ordered_json range_figures(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {{"least", *least}, {"mean", sum / static_cast<double>(values.size())}, {"most", *most}};
}

}  // namespace

double silhouette_difference(const TriangleMesh& a, const TriangleMesh& b) {
  Box frame = a.bounds();
  frame.extend(b.bounds().min), frame.extend(b.bounds().max);
  std::int64_t either = 0, one = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Silhouette silhouette_a(a, frame, axis), silhouette_b(b, frame, axis);
    for (std::size_t i = 0; i < silhouette_a.covered().size(); ++i) {
      either += silhouette_a.covered()[i] | silhouette_b.covered()[i];
      one += silhouette_a.covered()[i] ^ silhouette_b.covered()[i];
    }
  }
  return either == 0 ? 0.0 : static_cast<double>(one) / static_cast<double>(either);
}

nlohmann::ordered_json member_differences(const std::vector<TriangleMesh>& members,
                                          const Progress& progress) {
  if (members.size() < 2) return nullptr;
  std::vector<SurfaceTree> trees;
  for (const TriangleMesh& mesh : members) trees.emplace_back(mesh);
  std::vector<double> distances, silhouettes;
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (std::size_t b = a + 1; b < members.size(); ++b) {
      const SurfaceDistanceReport apart =
          surface_distance(members[a], trees[a], members[b], trees[b], kSamples, 1, progress);
      distances.push_back(apart.mean / members.front().bounds().diagonal());
      silhouettes.push_back(silhouette_difference(members[a], members[b]));
    }
  }
  return {{"members", members.size()},
          {"mean_distance", range_figures(distances)},
          {"silhouettes", range_figures(silhouettes)}};
}

std::string describe_differences(const nlohmann::ordered_json& figures) {
  const auto range = [&](const char* name) {
    const nlohmann::ordered_json& of = figures[name];
    return fmt::format("{:.2g} % ({:.2g} to {:.2g})", 100.0 * of["mean"].get<double>(),
                       100.0 * of["least"].get<double>(), 100.0 * of["most"].get<double>());
  };
  return fmt::format(
      "two members differ by {} of the diagonal, their silhouettes by {} of the area; pairs of {}",
      range("mean_distance"), range("silhouettes"), figures["members"].get<int>());
}

}  // namespace astrolith
