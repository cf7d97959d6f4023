#include "descriptor/pair_count.h"

#include <tbb/combinable.h>

#include <algorithm>
#include <array>

#include "descriptor/shape_histogram.h"
#include "descriptor/surflet_pair.h"
#include "numerics/errors.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

// Rows of pairs in one task. Times the largest number of points this stays below 2^32, the range of a
// counter.
constexpr std::int64_t kRowsPerTask = 64;
// One AVX-512 vector of codes.
constexpr std::int64_t kLanes = 16;
// Codes wait for this many vectors before they are counted. The processor then computes and counts at the
// same time and need not wait until a vector has been written before it reads the vector's parts.
constexpr std::int64_t kDelay = 3, kRing = kDelay + 1;
static_assert(kRing * kLanes <= std::int64_t{kSurfletPadding});
// There are this many copies of the counters, so that an increment need not wait for the one before it.
constexpr std::int64_t kCopies = 4;

// The number of codes: two for each surflet bin, since the first or the second point may be the origin.
template <int kBins>
constexpr std::int64_t kCodes = 2 * bin_count(PairFeatures::wahl, kBins);

// The loop below calls this function, which makes its Surflet itself. If the loop made it in its own body,
// the compiler would not keep it in vector registers. Everything that is called is always inlined, so that
// the compiler vectorises the loop in every clone.
template <int kBins>
ASTROLITH_KERNEL std::int32_t code_with(const SurfletRun& run, const Surflet& one, std::int64_t k) {
  const auto& c = run.c;
  return surflet_code<kBins>(
      one, {{c[0][k], c[1][k], c[2][k]}, {c[3][k], c[4][k], c[5][k]}, {c[6][k], c[7][k], c[8][k]}});
}

using Codes = std::int32_t[kLanes];

template <int kBins>
ASTROLITH_KERNEL void make_codes(const Surflet& one, const SurfletRun& run, std::int64_t first,
                                 Codes& codes) {
#pragma omp simd
  for (std::int64_t k = 0; k < kLanes; ++k) codes[k] = code_with<kBins>(run, one, first + k);
}

template <int kBins>
ASTROLITH_KERNEL void count_codes(const Codes& codes, std::uint32_t* counters) {
  ASTROLITH_UNROLL
  for (std::int64_t k = 0; k < kLanes; ++k) ++counters[k % kCopies * kCodes<kBins> + codes[k]];
}

// Adds the pairs of one surflet with `count` surflets of the run to kCopies tables of kCodes<kBins> counters.
template <int kBins>
ASTROLITH_SIMD_CLONES void count_row(const Surflet& given, SurfletRun run, std::int64_t count,
                                     std::uint32_t* __restrict counters) {
  alignas(64) Codes ring[kRing];
  const Surflet one = given;
  const std::int64_t vectors = count / kLanes, rest = count % kLanes;
  for (std::int64_t v = 0; v < kDelay; ++v) make_codes<kBins>(one, run, v * kLanes, ring[v]);
  for (std::int64_t v = 0; v < vectors; ++v) {
    make_codes<kBins>(one, run, (v + kDelay) * kLanes, ring[(v + kDelay) % kRing]);
    count_codes<kBins>(ring[v % kRing], counters);
  }
  for (std::int64_t k = 0; k < rest; ++k) ++counters[ring[vectors % kRing][k]];
}

template <int kBins>
void add_half(const std::vector<std::uint32_t>& counters, std::int64_t half, std::uint64_t* total) {
  constexpr std::int64_t kHalf = kCodes<kBins> / 2;
  for (std::int64_t copy = 0; copy < kCopies; ++copy) {
    const std::uint32_t* from = counters.data() + copy * kCodes<kBins> + half * kHalf;
    for (std::int64_t b = 0; b < kHalf; ++b) total[b] += from[b];
  }
}

// Some rows of one local code: the pairs of their points with all points before them.
struct Task {
  std::int64_t local, first_row, last_row;
};

std::vector<Task> make_tasks(const SurfletArrays& s) {
  std::vector<Task> tasks;
  for (std::size_t l = 0; l + 1 < s.code_first.size(); ++l) {
    const std::int64_t end = s.code_first[l + 1];
    for (std::int64_t row = s.code_first[l]; row < end; row += kRowsPerTask) {
      tasks.push_back({static_cast<std::int64_t>(l), row, std::min(end, row + kRowsPerTask)});
    }
  }
  return tasks;
}

// Counts the pairs of a task, for one other local code at a time. With both local codes fixed, only the side
// of the origin distinguishes pairs, and few counters are enough.
template <int kBins>
void count_task(const SurfletArrays& s, const Task& task, std::vector<std::uint64_t>& total) {
  constexpr std::int64_t kHalf = kCodes<kBins> / 2;
  std::vector<std::uint32_t> counters;
  for (std::int64_t other = 0; other <= task.local; ++other) {
    const std::int64_t begin = s.code_first[static_cast<std::size_t>(other)];
    const std::int64_t end = s.code_first[static_cast<std::size_t>(other) + 1];
    if (begin == end) continue;
    counters.assign(static_cast<std::size_t>(kCopies * kCodes<kBins>), 0);
    for (std::int64_t i = task.first_row; i < task.last_row; ++i) {
      count_row<kBins>(s.at(i), s.from(begin), std::min(end, i) - begin, counters.data());
    }
    add_half<kBins>(counters, 0, total.data() + task.local * kHalf);
    add_half<kBins>(counters, 1, total.data() + other * kHalf);
  }
}

template <int kBins>
std::vector<std::uint64_t> count_with(const SurfletArrays& s, int num_local, const Progress& progress) {
  const std::vector<Task> tasks = make_tasks(s);
  const auto num_tasks = static_cast<std::int64_t>(tasks.size());
  const auto size = static_cast<std::size_t>(num_local * kCodes<kBins> / 2);
  // Sums of integers do not depend on their order, so that each thread may keep its own.
  tbb::combinable<std::vector<std::uint64_t>> totals([&] { return std::vector<std::uint64_t>(size, 0); });
  const auto report_pairs = [&](double rows, std::string_view) {
    const double left = 1 - rows;
    if (!report(progress, 1 - left * left, "")) throw WorkError("stopped; nothing was written");
    return true;
  };
  // The longest rows come first, so that no thread is left with one at the end.
  reported_parallel_for({0, num_tasks, num_tasks}, report_pairs, "pairs", [&](std::int64_t t) {
    count_task<kBins>(s, tasks[static_cast<std::size_t>(num_tasks - 1 - t)], totals.local());
  });
  std::vector<std::uint64_t> sum(size, 0);
  totals.combine_each([&](const std::vector<std::uint64_t>& one) {
    for (std::size_t b = 0; b < size; ++b) sum[b] += one[b];
  });
  return sum;
}

}  // namespace

std::vector<std::uint64_t> count_pairs(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                       std::span<const std::int32_t> local, int num_local, int bins,
                                       const Progress& progress) {
  const SurfletArrays s(points, normals, local, num_local);
  return with_bins(bins, [&]<int kBins>() { return count_with<kBins>(s, num_local, progress); });
}

}  // namespace astrolith
