// Counts pairs of surflets (descriptor/pair_count.h) group by group. A group holds the pairs of some rows of
// one local code with some columns of another. Within a group, pairs differ only by the surflet code and by
// which point is the origin. The counters of a group therefore fit into the memory that a group of threads
// shares. They are integers, so that the order in which groups and threads add does not change the counts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cuda/backend.h"
#include "descriptor/shape_histogram.h"
#include "descriptor/surflet_pair.h"
#include "numerics/progress.h"

namespace astrolith {

// Rows of a group. Each row has a thread of its own.
inline constexpr unsigned kGroupRows = 256;
// Columns of a group: enough that adding up the group's counters costs little beside counting its pairs, and
// few enough that no 32-bit counter overflows.
inline constexpr std::int64_t kGroupColumns = 4096;

// The pairs of rows first_row .. end_row - 1 with columns first_column .. end_column - 1 whose column is less
// than their row.
struct PairGroup {
  std::uint32_t first_row, end_row, first_column, end_column;
  std::int32_t row_code, column_code;  // local codes
};

// Groups that hold each pair of points exactly once. Points are sorted by their local codes, and those of
// code l are code_first[l] .. code_first[l + 1] - 1.
std::vector<PairGroup> pair_groups(std::span<const std::int64_t> code_first);

// A group of kGroupRows threads counts one group of pairs. Surflets lie in memory as nine arrays of `stride`
// floats. `totals` has the shape (num_local, kBins^4).
template <int kBins>
struct CountPairGroups {
  static constexpr std::int64_t kHalf = bin_count(PairFeatures::wahl, kBins), kCodes = 2 * kHalf;
  // Columns in shared memory at a time. The rest of the memory holds counters. They have several copies, each
  // for some of the rows, so that fewer threads wait for each other.
  static constexpr unsigned kChunk = 128;
  static constexpr std::int64_t kCounters =
      static_cast<std::int64_t>((kSharedBytes - 9 * kChunk * sizeof(float)) / sizeof(std::uint32_t));
  static constexpr std::int64_t kWindow = std::min(kCodes, kCounters);  // codes counted in one pass
  static constexpr std::int64_t kCopies = std::min<std::int64_t>(kCounters / kWindow, kGroupRows / 32);

  static constexpr std::size_t kGroupBytes = kSharedBytes;

  const PairGroup* groups;
  const float* surflets;
  std::size_t stride;
  std::uint64_t* totals;

  ASTROLITH_KERNEL static Surflet read_surflet(const float* from, std::size_t step, std::size_t k) {
    const auto c = [&](std::size_t d) { return from[d * step + k]; };
    return {{c(0), c(1), c(2)}, {c(3), c(4), c(5)}, {c(6), c(7), c(8)}};
  }

  template <class Group>
  ASTROLITH_HD void operator()(const Group& group) const {
    const PairGroup pairs = groups[group.index()];
    for (std::int64_t first = 0; first < kCodes; first += kWindow) count_window(group, pairs, first);
  }

  // Counts the pairs with codes first .. first + kWindow - 1.
  template <class Group>
  ASTROLITH_HD void count_window(const Group& group, const PairGroup& pairs, std::int64_t first) const {
    auto* columns = static_cast<float*>(group.shared());
    auto* counters = reinterpret_cast<std::uint32_t*>(columns + 9 * kChunk);
    group.each_thread([&](unsigned thread) {
      for (std::int64_t k = thread; k < kCopies * kWindow; k += kGroupRows) counters[k] = 0;
    });
    for (std::uint32_t begin = pairs.first_column; begin < pairs.end_column; begin += kChunk) {
      const std::uint32_t size = pairs.end_column - begin < kChunk ? pairs.end_column - begin : kChunk;
      group.each_thread([&](unsigned thread) { load_columns(thread, begin, size, columns); });
      group.each_thread(
          [&](unsigned thread) { count_row(thread, pairs, first, begin, size, columns, counters); });
    }
    group.each_thread([&](unsigned thread) { add_totals(thread, pairs, first, counters); });
  }

 private:
  ASTROLITH_HD void load_columns(unsigned thread, std::uint32_t begin, std::uint32_t size,
                                 float* columns) const {
    for (unsigned k = thread; k < 9 * kChunk; k += kGroupRows) {
      const unsigned d = k / kChunk, column = k % kChunk;
      if (column < size) columns[k] = surflets[d * stride + begin + column];
    }
  }

  ASTROLITH_HD void count_row(unsigned thread, const PairGroup& pairs, std::int64_t first,
                              std::uint32_t begin, std::uint32_t size, const float* columns,
                              std::uint32_t* counters) const {
    const std::uint32_t row = pairs.first_row + thread;
    if (row >= pairs.end_row || begin >= row) return;
    const Surflet one = read_surflet(surflets, stride, row);
    std::uint32_t* mine = counters + (thread / 32) % kCopies * kWindow;
    const std::uint32_t end = row - begin < size ? row - begin : size;
    for (std::uint32_t k = 0; k < end; ++k) {
      const std::int64_t code = surflet_code<kBins>(one, read_surflet(columns, kChunk, k)) - first;
      if (kWindow == kCodes || (code >= 0 && code < kWindow)) add_atomically(mine + code, std::uint32_t{1});
    }
  }

  // Adds the group's counters to the totals. In the second half of the codes, the column's point is the
  // origin.
  ASTROLITH_HD void add_totals(unsigned thread, const PairGroup& pairs, std::int64_t first,
                               const std::uint32_t* counters) const {
    for (std::int64_t k = thread; k < kWindow && first + k < kCodes; k += kGroupRows) {
      std::uint64_t sum = 0;
      for (std::int64_t copy = 0; copy < kCopies; ++copy) sum += counters[copy * kWindow + k];
      if (sum == 0) continue;
      const bool is_column = first + k >= kHalf;
      const std::int64_t local = is_column ? pairs.column_code : pairs.row_code;
      add_atomically(totals + local * kHalf + (first + k - (is_column ? kHalf : 0)), sum);
    }
  }
};

// Several sets of oriented points as one list of surflets. Pairs are counted within each set only. The local
// codes of set number s begin at s * num_local.
struct SurfletSets {
  std::vector<float> surflets;  // nine arrays, one after another
  std::size_t stride = 0;       // length of each array
  std::vector<PairGroup> groups;
  std::size_t num_codes = 0;  // number of local codes of all sets

  // Expects sets with one number of local codes.
  explicit SurfletSets(std::span<const SurfletArrays> sets);
};

// The groups of one launch, after which progress is reported.
inline constexpr std::size_t kGroupsPerLaunch = 16384;

// The counts of all sets (num_codes, kBins^4). Throws WorkError when progress asks to stop.
template <int kBins, class Backend>
std::vector<std::uint64_t> count_groups(Backend& backend, const SurfletSets& sets, const Progress& progress) {
  const auto points = backend.upload(std::span<const float>(sets.surflets));
  const auto list = backend.upload(std::span<const PairGroup>(sets.groups));
  std::vector<std::uint64_t> counts(sets.num_codes *
                                    static_cast<std::size_t>(bin_count(PairFeatures::wahl, kBins)));
  auto totals = backend.template allocate<std::uint64_t>(counts.size());
  backend.fill_zero(totals);
  for (std::size_t first = 0; first < sets.groups.size(); first += kGroupsPerLaunch) {
    const std::size_t size = std::min(kGroupsPerLaunch, sets.groups.size() - first);
    backend.launch_groups(
        "counting pairs", size, kGroupRows,
        CountPairGroups<kBins>{list.data() + first, points.data(), sets.stride, totals.data()});
    backend.wait();
    const double done = static_cast<double>(first + size) / static_cast<double>(sets.groups.size());
    if (!report(progress, done, "")) throw WorkError("stopped; nothing was written");
  }
  backend.download(totals, std::span(counts));
  return counts;
}

// The counts that count_pairs (descriptor/pair_count.h) finds for each set, one set after another. `bins` is
// kMinBins .. kMaxBins.
template <class Backend>
std::vector<std::uint64_t> count_sets_on(Backend& backend, std::span<const SurfletArrays> arrays, int bins,
                                         const Progress& progress) {
  const SurfletSets sets(arrays);
  return with_bins(bins, [&]<int kBins>() { return count_groups<kBins>(backend, sets, progress); });
}

// The counts of count_pairs (descriptor/pair_count.h), found on a backend.
template <class Backend>
std::vector<std::uint64_t> count_pairs_on(Backend& backend, std::span<const Vec3d> points,
                                          std::span<const Vec3d> normals, std::span<const std::int32_t> local,
                                          int num_local, int bins, const Progress& progress) {
  const SurfletArrays surflets(points, normals, local, num_local);
  return count_sets_on(backend, std::span(&surflets, 1), bins, progress);
}

}  // namespace astrolith
