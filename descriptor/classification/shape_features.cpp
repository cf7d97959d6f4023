#include "descriptor/classification/shape_features.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "descriptor/shape_description.h"
#include "descriptor/shape_distribution.h"
#include "descriptor/spectrum/laplacian_spectrum.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr struct {
  const char* name;
  FeatureKind kind;
} kNames[] = {{"wahl", FeatureKind::wahl},
              {"ahd", FeatureKind::ahd},
              {"d2", FeatureKind::d2},
              {"shapedna", FeatureKind::shapedna}};

std::vector<float> scaled(const std::vector<double>& frequencies) {
  std::vector<float> features;
  features.reserve(frequencies.size());
  const auto bins = static_cast<double>(frequencies.size());
  for (const double f : frequencies) features.push_back(static_cast<float>(bins * f));
  return features;
}

std::vector<float> weyl_normalised(const std::vector<double>& eigenvalues) {
  std::vector<float> features;
  for (std::size_t i = 0; i < eigenvalues.size(); ++i) {
    features.push_back(
        static_cast<float>(eigenvalues[i] / (4 * std::numbers::pi * static_cast<double>(i + 1))));
  }
  return features;
}

DescriptionOptions description(const FeatureOptions& options, std::int64_t points) {
  const PairFeatures pairs = options.kind == FeatureKind::wahl ? PairFeatures::wahl : PairFeatures::ahd;
  return {pairs, options.bins, points, options.seed};
}

std::vector<float> distribution_features(std::span<const Vec3d> points, int bins) {
  return scaled(shape_distribution(points, bins).frequencies());
}

void require_range(const char* what, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value >= low && value <= high) return;
  throw InputError(std::string("features: ") + what + " " + std::to_string(value) + "; give between " +
                   std::to_string(low) + " and " + std::to_string(high));
}

}  // namespace

FeatureKind feature_kind_from_name(const std::string& name) {
  for (const auto& entry : kNames) {
    if (name == entry.name) return entry.kind;
  }
  throw InputError("features: " + name + " is unknown; give wahl, ahd, d2 or shapedna");
}

std::string feature_name(FeatureKind kind) {
  for (const auto& entry : kNames) {
    if (kind == entry.kind) return entry.name;
  }
  return "";
}

FeatureOptions default_features(FeatureKind kind) {
  FeatureOptions options;
  options.kind = kind;
  if (kind == FeatureKind::d2) options.bins = 64;
  return options;
}

void check(const FeatureOptions& options) {
  require_range("bins", options.bins, kMinBins, options.kind == FeatureKind::d2 ? 1024 : kMaxBins);
  require_range("eigenvalues", options.eigenvalues, 1, 500);
  require_range("points", options.points, 16, 100000);
}

std::size_t feature_count(const FeatureOptions& options) {
  switch (options.kind) {
    case FeatureKind::wahl:
      return static_cast<std::size_t>(bin_count(PairFeatures::wahl, options.bins));
    case FeatureKind::ahd:
      return static_cast<std::size_t>(bin_count(PairFeatures::ahd, options.bins));
    case FeatureKind::d2:
      return static_cast<std::size_t>(options.bins);
    case FeatureKind::shapedna:
      break;
  }
  return static_cast<std::size_t>(options.eigenvalues);
}

std::vector<float> shape_features(const TriangleMesh& mesh, const FeatureOptions& options,
                                  const Progress& progress) {
  check(options);
  if (mesh.triangles.empty()) return point_features(mesh.vertices, mesh.normals, options);
  switch (options.kind) {
    case FeatureKind::wahl:
    case FeatureKind::ahd:
      return scaled(
          describe_shape(mesh, description(options, options.points), progress).histogram.frequencies());
    case FeatureKind::d2:
      return distribution_features(
          sample_poisson_disk(mesh, options.points, options.seed, SampleNormals::triangle, progress).points,
          options.bins);
    case FeatureKind::shapedna:
      break;
  }
  return weyl_normalised(laplacian_spectrum(mesh, options.eigenvalues).eigenvalues);
}

std::vector<float> point_features(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                  const FeatureOptions& options) {
  check(options);
  switch (options.kind) {
    case FeatureKind::wahl:
    case FeatureKind::ahd: {
      const auto all = static_cast<std::int64_t>(points.size());
      return scaled(describe_shape(points, normals, description(options, all)).histogram.frequencies());
    }
    case FeatureKind::d2:
      return distribution_features(points, options.bins);
    case FeatureKind::shapedna:
      break;
  }
  return weyl_normalised(laplacian_spectrum(points, normals, options.eigenvalues).eigenvalues);
}

double feature_distance(FeatureKind kind, std::span<const float> f, std::span<const float> g) {
  const auto vector = [](std::span<const float> v) {
    return Eigen::Map<const Eigen::VectorXf>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  const double difference = (vector(f) - vector(g)).norm();
  if (kind == FeatureKind::shapedna) return difference;
  const double size = std::sqrt(vector(f).squaredNorm() + vector(g).squaredNorm());
  return size > 0 ? difference / size : 0;
}

}  // namespace astrolith
