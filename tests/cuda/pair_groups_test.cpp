// Compares the GPU's pair count with the CPU's: on the host thread by thread, and on a GPU if there is one.
#include "cuda/pair_groups.h"

#include "cuda/device.h"
#include "cuda/pair_count.h"
#include "numerics/errors.h"
#include "tests/cuda/host_backend.h"
#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

using namespace testing;

struct Surflets {
  std::vector<Vec3d> points, normals;
  std::vector<std::int32_t> local;
};

Surflets random_input(int n, int num_local, std::uint64_t seed) {
  const SurfaceSamples s = random_surflets(n, seed);
  Surflets input{s.points, s.normals, {}};
  for (Vec3d& p : input.points) p = 0.57 * (p - Vec3d{0.5, 0.5, 0.5});
  CounterRandom random(seed + 1);
  for (int i = 0; i < n; ++i) {  // some codes are rare, some never occur
    const double u = random.uniform();
    input.local.push_back(static_cast<std::int32_t>(u * u * 0.9 * num_local));
  }
  return input;
}

// A lattice with parallel and opposite normals: ties of all kinds, and points that repeat.
Surflets tied_input(int num_local) {
  Surflets input;
  for (int k = 0; k < 1200; ++k) {
    const int i = k % 600;
    input.points.push_back(0.1 *
                           Vec3d{double(i % 8) - 3.5, double(i / 8 % 8) - 3.5, double(i / 64 % 8) - 3.5});
    input.normals.push_back(i % 3 == 0 ? Vec3d{0, 0, 1} : i % 3 == 1 ? Vec3d{0, 0, -1} : Vec3d{1, 0, 0});
    input.local.push_back(i % num_local);
  }
  return input;
}

using Counts = std::vector<std::uint64_t>;
Counts on_cpu(const Surflets& s, int num_local, int bins) {
  return count_pairs(s.points, s.normals, s.local, num_local, bins, {});
}
Counts on_twin(const Surflets& s, int num_local, int bins) {
  HostBackend backend;
  return count_pairs_on(backend, s.points, s.normals, s.local, num_local, bins, {});
}

TEST(PairGroups, HoldEveryPairOnce) {
  for (const std::vector<std::int64_t>& first :
       {std::vector<std::int64_t>{0, 0}, {0, 1}, {0, 2}, {0, 256}, {0, 257}, {0, 3, 3, 800, 801}}) {
    const auto n = static_cast<std::size_t>(first.back());
    std::vector<int> times(n * n, 0);
    for (const PairGroup& t : pair_groups(first)) {
      ASSERT_LE(t.end_row - t.first_row, kGroupRows);
      ASSERT_LE(t.end_column - t.first_column, kGroupColumns);
      for (std::size_t i = t.first_row; i < t.end_row; ++i) {
        ASSERT_GE(static_cast<std::int64_t>(i), first[static_cast<std::size_t>(t.row_code)]);
        ASSERT_LT(static_cast<std::int64_t>(i), first[static_cast<std::size_t>(t.row_code) + 1]);
        for (std::size_t j = t.first_column; j < std::min<std::size_t>(t.end_column, i); ++j) {
          ASSERT_LT(static_cast<std::int64_t>(j), first[static_cast<std::size_t>(t.column_code) + 1]);
          ++times[i * n + j];
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) ASSERT_EQ(times[i * n + j], j < i ? 1 : 0) << i << " " << j;
    }
  }
}

// Numbers of points at and around the sizes of groups of threads, chunks and groups of pairs.
TEST(PairGroups, CountWhatTheCpuCounts) {
  for (const int n : {0, 1, 2, 3, 31, 127, 128, 129, 255, 256, 257, 511, 513, 1000}) {
    const Surflets wahl = random_input(n, 1, 5), ahd = random_input(n, 25, 6);
    ASSERT_EQ(on_twin(wahl, 1, 5), on_cpu(wahl, 1, 5)) << n;
    ASSERT_EQ(on_twin(ahd, 25, 5), on_cpu(ahd, 25, 5)) << n;
  }
  const Surflets many = random_input(4500, 1, 7);  // two groups of columns
  EXPECT_EQ(on_twin(many, 1, 5), on_cpu(many, 1, 5));
}

TEST(PairGroups, TakeThreadsInAnyOrder) {
  const Surflets s = random_input(700, 4, 12);
  for (const std::size_t seed : {1, 2, 31}) {
    HostBackend backend(std::size_t{1} << 30, {seed});
    EXPECT_EQ(count_pairs_on(backend, s.points, s.normals, s.local, 4, 5, {}), on_cpu(s, 4, 5));
  }
}

TEST(PairGroups, CountTiesAsTheCpu) {
  for (const int num_local : {1, 9}) {
    EXPECT_EQ(on_twin(tied_input(num_local), num_local, 5), on_cpu(tied_input(num_local), num_local, 5));
    EXPECT_EQ(on_twin(tied_input(num_local), num_local, 4), on_cpu(tied_input(num_local), num_local, 4));
  }
}

// Nine and ten bins have more codes than shared memory has counters.
TEST(PairGroups, CountWithEveryNumberOfBins) {
  for (int bins = kMinBins; bins <= kMaxBins; ++bins) {
    const Surflets s = random_input(400, 4, 8);
    ASSERT_EQ(on_twin(s, 4, bins), on_cpu(s, 4, bins)) << bins;
  }
}

// Sets of many sizes, among them an empty set and a set of one point.
TEST(PairGroups, CountSetsTogetherAsOneByOne) {
  std::vector<SurfletArrays> sets;
  Counts one_by_one;
  for (const int n : {300, 0, 1, 700, 2}) {
    const Surflets s = random_input(n, 9, static_cast<std::uint64_t>(n));
    sets.emplace_back(s.points, s.normals, s.local, 9);
    const Counts counts = on_cpu(s, 9, 5);
    one_by_one.insert(one_by_one.end(), counts.begin(), counts.end());
  }
  HostBackend backend;
  EXPECT_EQ(count_sets_on(backend, sets, 5, {}), one_by_one);
}

TEST(PairGroups, StopWhenAskedTo) {
  HostBackend backend;
  const Surflets s = random_input(300, 1, 9);
  const Progress stop = [](double, std::string_view) { return false; };
  EXPECT_THROW(count_pairs_on(backend, s.points, s.normals, s.local, 1, 5, stop), WorkError);
  HostBackend small(1000);
  EXPECT_THROW(count_pairs_on(small, s.points, s.normals, s.local, 1, 5, {}), OutOfDeviceMemory);
}

TEST(PairCountOnGpu, CountsWhatTheCpuCounts) {
  const DeviceStatus status = probe_device();
  if (!status.usable) GTEST_SKIP() << "no GPU here: " << status.reason;
  for (const int n : {0, 1, 2, 257, 5000, 30000}) {
    const Surflets s = random_input(n, 25, 10);
    ASSERT_EQ(count_pairs_on_gpu(s.points, s.normals, s.local, 25, 5, {}), on_cpu(s, 25, 5)) << n;
  }
  for (int bins = kMinBins; bins <= kMaxBins; ++bins) {
    const Surflets s = random_input(3000, 4, 11);
    ASSERT_EQ(count_pairs_on_gpu(s.points, s.normals, s.local, 4, bins, {}), on_cpu(s, 4, bins)) << bins;
  }
}

}  // namespace
}  // namespace astrolith
