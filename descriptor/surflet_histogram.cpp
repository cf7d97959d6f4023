#include "descriptor/surflet_histogram.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "descriptor/largest_distance.h"
#include "numerics/errors.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// A chunk of rows times the largest number of points stays below 2^32, the range of its counters.
constexpr std::int64_t kRowsPerChunk = 64;
constexpr std::size_t kMaxPoints = std::size_t{1} << 24;

// Bins are computed in short runs that stay in the first cache, then counted: counting does not vectorise.
constexpr std::int64_t kRun = 512;
// Counters in four copies, so that an increment need not wait for the one before it.
constexpr std::int64_t kCopies = 4;

// Pointers to a run of surflets. That the loop below calls a function which makes its Surflet, rather than
// making it in its own body, is what lets the compiler keep it in vector registers.
struct SurfletRun {
  const float *x, *y, *z, *nx, *ny, *nz;

  std::int32_t bin_with(Surflet one, std::int64_t k) const {
    return surflet_bin(one, {{x[k], y[k], z[k]}, {nx[k], ny[k], nz[k]}});
  }
};

// One array a coordinate, for vector loads.
struct SurfletArrays {
  std::vector<float> x, y, z, nx, ny, nz;

  SurfletArrays(std::span<const Vec3d> points, std::span<const Vec3d> normals, double max_distance) {
    Box box;
    for (const Vec3d& p : points) box.extend(p);
    const Vec3d center = points.empty() ? Vec3d{} : box.center();
    const double scale = max_distance > 0 ? 1 / max_distance : 0;
    for (std::vector<float>* v : {&x, &y, &z, &nx, &ny, &nz}) v->reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d p = scale * (points[i] - center), n = normalized(normals[i]);
      x.push_back(static_cast<float>(p.x));
      y.push_back(static_cast<float>(p.y));
      z.push_back(static_cast<float>(p.z));
      nx.push_back(static_cast<float>(n.x));
      ny.push_back(static_cast<float>(n.y));
      nz.push_back(static_cast<float>(n.z));
    }
  }
  Surflet at(std::size_t i) const { return {{x[i], y[i], z[i]}, {nx[i], ny[i], nz[i]}}; }
  SurfletRun from(std::size_t i) const { return {&x[i], &y[i], &z[i], &nx[i], &ny[i], &nz[i]}; }
};

// bins[k] = bin of the pair (one, surflet k of the run) for k in [0, count).
ASTROLITH_SIMD_CLONES void bin_run(Surflet one, SurfletRun run, std::int32_t* __restrict bins,
                                   std::int64_t count) {
#pragma omp simd
  for (std::int64_t k = 0; k < count; ++k) bins[k] = run.bin_with(one, k);
}

using ChunkCounts = std::array<std::array<std::uint32_t, kSurfletBins>, kCopies>;

void count_run(const std::int32_t* bins, std::int64_t count, ChunkCounts& counts) {
  std::int64_t k = 0;
  for (; k + kCopies <= count; k += kCopies) {
    for (std::int64_t c = 0; c < kCopies; ++c) {
      ++counts[static_cast<std::size_t>(c)][static_cast<std::size_t>(bins[k + c])];
    }
  }
  for (; k < count; ++k) ++counts[0][static_cast<std::size_t>(bins[k])];
}

// Pairs of the chunk's rows with all surflets before them.
void count_chunk(const SurfletArrays& s, std::int64_t first_row, std::int64_t last_row,
                 std::array<std::uint64_t, kSurfletBins>& total) {
  ChunkCounts counts{};
  std::array<std::int32_t, kRun> bins;
  for (std::int64_t i = first_row; i < last_row; ++i) {
    const Surflet one = s.at(static_cast<std::size_t>(i));
    for (std::int64_t j = 0; j < i; j += kRun) {
      const std::int64_t count = std::min(kRun, i - j);
      bin_run(one, s.from(static_cast<std::size_t>(j)), bins.data(), count);
      count_run(bins.data(), count, counts);
    }
  }
  for (const auto& copy : counts) {
    for (std::size_t b = 0; b < kSurfletBins; ++b) total[b] += copy[b];
  }
}

void check(std::span<const Vec3d> points, std::span<const Vec3d> normals) {
  if (points.size() != normals.size()) {
    throw InputError("surflet histogram: " + std::to_string(points.size()) + " points have " +
                     std::to_string(normals.size()) + " normals; give one for each");
  }
  if (points.size() > kMaxPoints) {
    throw InputError("surflet histogram: " + std::to_string(points.size()) + " points are more than " +
                     std::to_string(kMaxPoints) + "; take fewer samples");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(squared_norm(points[i])) || !std::isfinite(squared_norm(normals[i]))) {
      throw InputError("surflet histogram: point " + std::to_string(i) + " or its normal is not finite");
    }
  }
}

}  // namespace

std::vector<double> SurfletHistogram::frequencies() const {
  std::vector<double> f(counts.begin(), counts.end());
  for (double& value : f) value /= static_cast<double>(std::max<std::uint64_t>(pairs, 1));
  return f;
}

SurfletHistogram surflet_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals) {
  check(points, normals);
  SurfletHistogram histogram;
  histogram.max_distance = largest_distance(points);
  const SurfletArrays surflets(points, normals, histogram.max_distance);
  const auto n = static_cast<std::int64_t>(points.size());
  const std::int64_t chunks = (n + kRowsPerChunk - 1) / kRowsPerChunk;
  std::vector<std::array<std::uint64_t, kSurfletBins>> counts(static_cast<std::size_t>(chunks));
  parallel_for(0, chunks, [&](std::int64_t c) {
    count_chunk(surflets, c * kRowsPerChunk, std::min(n, (c + 1) * kRowsPerChunk),
                counts[static_cast<std::size_t>(c)]);
  });
  for (const auto& chunk : counts) {
    for (std::size_t b = 0; b < kSurfletBins; ++b) histogram.counts[b] += chunk[b];
  }
  histogram.pairs = n > 1 ? static_cast<std::uint64_t>(n) * static_cast<std::uint64_t>(n - 1) / 2 : 0;
  return histogram;
}

double similarity(const SurfletHistogram& a, const SurfletHistogram& b) {
  return histogram_similarity(a.frequencies(), b.frequencies());
}

double histogram_similarity(std::span<const double> f, std::span<const double> g) {
  if (f.size() != g.size()) throw InputError("similarity: the histograms have different numbers of bins");
  double difference2 = 0, size2 = 0;
  for (std::size_t b = 0; b < f.size(); ++b) {
    difference2 += (f[b] - g[b]) * (f[b] - g[b]);
    size2 += f[b] * f[b] + g[b] * g[b];
  }
  return size2 > 0 ? 1 - std::sqrt(difference2 / size2) : 1;
}

}  // namespace astrolith
