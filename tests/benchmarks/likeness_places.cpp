// How far a body of its kind goes from the measured one: the correlation of both reliefs place by place, and
// the angles between neighbouring facets of both surfaces, which seams of patches would make larger.
//
//   likeness_places RECIPE... [--seeds 1 2 3] [--resolution 256]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "tasks/synthesis/load_recipe.h"

namespace {

using namespace astrolith;

ReliefLayer* relief_of(Recipe& recipe) {
  for (Layer& layer : recipe.layers) {
    if (ReliefLayer* relief = std::get_if<ReliefLayer>(&layer)) return relief;
  }
  return nullptr;
}

// The heights of the first relief at these points.
std::vector<double> heights_at(const ImplicitField& field, const std::vector<Vec3d>& points) {
  std::vector<double> heights;
  const FieldView tables = field.tables();
  for (std::uint32_t i = 0; i < tables.num_layers; ++i) {
    const FieldLayer& layer = tables.layers[i];
    const ReliefNoise* noise = layer.noise.get_if<ReliefNoise>();
    if (noise == nullptr) continue;
    for (const Vec3d& p : points)
      heights.push_back(double{height_at(*noise, field.tables().arrays, to_float(p))});
    break;
  }
  return heights;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum_a = 0, sum_b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i], sum_b += b[i], aa += a[i] * a[i], bb += b[i] * b[i], ab += a[i] * b[i];
  }
  const double n = static_cast<double>(a.size());
  return (ab - sum_a * sum_b / n) / std::sqrt((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n));
}

// Angles between facets with a common edge, in degrees, ascending.
std::vector<double> facet_angles(const TriangleMesh& mesh) {
  std::vector<Vec3d> normals;
  std::unordered_map<std::uint64_t, std::size_t> facet_of_edge;
  std::vector<double> angles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    const Vec3d &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                &c = mesh.vertices[triangle[2]];
    normals.push_back(normalized(cross(b - a, c - a)));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [from, to] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      const std::uint64_t edge = std::uint64_t{from} << 32 | to;
      const auto found = facet_of_edge.find(edge);
      if (found == facet_of_edge.end()) {
        facet_of_edge.emplace(edge, t);
        continue;
      }
      const double cosine = std::clamp(dot(normals[found->second], normals[t]), -1.0, 1.0);
      angles.push_back(std::acos(cosine) * 180.0 / std::numbers::pi);
      facet_of_edge.erase(found);
    }
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

std::string angle_words(const TriangleMesh& mesh) {
  const std::vector<double> angles = facet_angles(mesh);
  const auto at = [&](double share) {
    return angles[static_cast<std::size_t>(share * static_cast<double>(angles.size() - 1))];
  };
  return fmt::format("angles of facets, degrees: 99 % {:.1f}, 99.9 % {:.1f}, 99.99 % {:.1f}", at(0.99),
                     at(0.999), at(0.9999));
}

void print_rows(const std::string& file, const std::vector<int>& seeds, int resolution) {
  Recipe recipe = load_recipe(file);
  ReliefLayer* relief = relief_of(recipe);
  if (relief == nullptr) {
    fmt::print("{}: has no relief\n", file);
    return;
  }
  const ImplicitField measured(recipe);
  Recipe bare = recipe;
  bare.layers.clear();
  const std::vector<Vec3d> points = coarse_mesh_of(ImplicitField(bare), 128).vertices;
  const std::vector<double> heights = heights_at(measured, points);
  fmt::print("{}: measured, {}\n", std::filesystem::path(file).stem().string(),
             angle_words(coarse_mesh_of(measured, resolution)));
  relief->arrangement = ReliefArrangement::kLike;
  for (const int seed : seeds) {
    recipe.seed = static_cast<std::uint64_t>(seed);
    const ImplicitField like(recipe);
    fmt::print("  seed {}: correlation {:.3f}, {}\n", seed, correlation(heights, heights_at(like, points)),
               angle_words(coarse_mesh_of(like, resolution)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"How far bodies of a kind go from the measured one."};
  std::vector<std::string> files;
  std::vector<int> seeds{1, 2, 3};
  int resolution = 256;
  app.add_option("recipes", files)->required();
  app.add_option("--seeds", seeds);
  app.add_option("--resolution", resolution);
  CLI11_PARSE(app, argc, argv);
  for (const std::string& file : files) print_rows(file, seeds, resolution);
  return 0;
}
