// One vector of numbers a shape: what a forest learns from and retrieval measures distances between.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

enum class FeatureKind {
  wahl,     // surflet pairs, bins^4
  ahd,      // adaptive hybrid descriptor, bins^6
  d2,       // shape distribution, bins
  shapedna  // Laplacian spectrum, eigenvalues
};

struct FeatureOptions {
  FeatureKind kind = FeatureKind::ahd;
  int bins = 5;                // an axis; 2 to 10, of d2 2 to 1024; shapedna has none
  int eigenvalues = 20;        // of shapedna, 1 to 500
  std::int64_t points = 5000;  // Poisson-disk samples of a mesh, 16 to 100,000; shapedna takes none
  std::uint64_t seed = 1;      // of the samples
};

// The names above. Throws InputError for another one.
FeatureKind feature_kind_from_name(const std::string& name);
std::string name_of(FeatureKind kind);

// Five bins, of d2 64: what the papers take.
FeatureOptions default_features(FeatureKind kind);

// Throws InputError when a number is outside its range above.
void check(const FeatureOptions& options);

// Length of the vectors.
std::size_t feature_count(const FeatureOptions& options);

// Of a histogram the frequencies times the number of bins, so that the mean is 1 (the forest of OpenCV takes
// values that differ by less than 2.4e-7 for equal); of shapedna the eigenvalues over 4 pi i, to which the
// i-th of every surface tends (Weyl's law). Throws InputError for shapes that the descriptor refuses.
std::vector<float> shape_features(const TriangleMesh& mesh, const FeatureOptions& options);

// The same of (n) points of a surface with (n) normals, all of them.
std::vector<float> point_features(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                  const FeatureOptions& options);

// Between vectors of one kind: of histograms 1 - similarity, |f - g| / sqrt(|f|^2 + |g|^2) in [0, 1]; of
// shapedna the Euclidean distance.
double feature_distance(FeatureKind kind, std::span<const float> f, std::span<const float> g);

}  // namespace astrolith
