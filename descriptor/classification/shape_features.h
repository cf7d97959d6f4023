// The feature vector of a shape: forests learn from it, and retrieval measures distances between such
// vectors.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

enum class FeatureKind {
  wahl,     // surflet pairs; bins^4 features
  ahd,      // adaptive hybrid descriptor; bins^6 features
  d2,       // shape distribution; `bins` features
  shapedna  // Laplacian spectrum; `eigenvalues` features
};

struct FeatureOptions {
  FeatureKind kind = FeatureKind::ahd;
  int bins = 5;                // along each axis, 2 to 10; 2 to 1024 for d2; shapedna has none
  int eigenvalues = 20;        // for shapedna, 1 to 500
  std::int64_t points = 5000;  // Poisson-disk samples, 16 to 100,000; shapedna takes none
  std::uint64_t seed = 1;      // seed of the samples
};

// Names of the kinds as above. Throws InputError for an unknown name.
FeatureKind feature_kind_from_name(const std::string& name);
std::string feature_name(FeatureKind kind);

// The usual options of the literature: five bins, or 64 for d2.
FeatureOptions default_features(FeatureKind kind);

// Throws InputError when an option is outside its range above.
void check(const FeatureOptions& options);

// The length of the vectors.
std::size_t feature_count(const FeatureOptions& options);

// The feature vector of a mesh, or of its vertices and normals where it has no triangles. For a histogram it
// holds the frequencies times the number of bins. The mean feature is then 1, which matters because OpenCV's
// forest takes values that differ by less than 2.4e-7 as equal. For shapedna it holds the eigenvalues over 4
// pi i, to which the i-th eigenvalue of every surface tends (Weyl's law). Throws InputError for shapes that
// the descriptor refuses, and WorkError when progress asks to stop.
std::vector<float> shape_features(const TriangleMesh& mesh, const FeatureOptions& options,
                                  const Progress& progress = {});

// The feature vector of (n) points of a surface with (n) normals, all of which are used.
std::vector<float> point_features(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                  const FeatureOptions& options);

// The distance between two vectors of one kind. For histograms it is 1 - similarity = |f - g| / sqrt(|f|^2 +
// |g|^2) in [0, 1], for shapedna the Euclidean distance.
double feature_distance(FeatureKind kind, std::span<const float> f, std::span<const float> g);

}  // namespace astrolith
