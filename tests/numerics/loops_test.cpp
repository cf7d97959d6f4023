#include <atomic>
#include <stdexcept>
#include <vector>

#include "numerics/parallel_for.h"
#include "numerics/process_limits.h"
#include "numerics/reported_loop.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    std::vector<int> visits(10007, 0);
    parallel_for(0, static_cast<std::int64_t>(visits.size()),
                 [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; });
    for (int v : visits) ASSERT_EQ(v, 1);
  }
}

TEST(ParallelFor, EmptyRangeAndExceptions) {
  parallel_for(5, 5, [](std::int64_t) { FAIL(); });
  EXPECT_THROW(parallel_for(0, 100,
                            [](std::int64_t i) {
                              if (i == 50) throw std::runtime_error("stop");
                            }),
               std::runtime_error);
}

// The tightest of a group and those around it counts. A page that can be dropped is free.
TEST(ProcessLimits, AreThoseOfControlGroups) {
  const testing::ScratchFolder folder;
  const auto write = [&](const std::string& name, std::string_view content) {
    std::filesystem::create_directories((folder / name).parent_path());
    folder.write(name, content);
  };
  write("second", "0::/job/step\n");
  write("2/job/memory.max", "3000\n");
  write("2/job/memory.current", "1800\n");
  write("2/job/memory.stat", "anon 700\ninactive_file 500\n");
  write("2/job/step/memory.max", "max\n");
  write("2/job/step/memory.current", "100\n");
  write("2/job/step/cpu.max", "150000 100000\n");
  write("2/job/cpu.max", "max 100000\n");
  const GroupLimits second = group_limits(folder / "second", folder / "2");
  EXPECT_EQ(second.free_bytes, 1700.0);
  EXPECT_EQ(second.processors, 1.5);
  write("first",
        "4:memory:/elsewhere\n2:cpu,cpuacct:/\n0::/\n");  // a container, which sees itself as the root
  write("1/memory/memory.limit_in_bytes", "5000\n");
  write("1/memory/memory.usage_in_bytes", "1000\n");
  write("1/memory/memory.stat", "total_inactive_file 10\n");
  write("1/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  write("1/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  const GroupLimits first = group_limits(folder / "first", folder / "1");
  EXPECT_EQ(first.free_bytes, 4010.0);
  EXPECT_EQ(first.processors, GroupLimits{}.processors);
  write("1/memory/memory.limit_in_bytes", "9223372036854771712\n");  // none
  EXPECT_EQ(group_limits(folder / "first", folder / "1").free_bytes, GroupLimits{}.free_bytes);
  EXPECT_EQ(group_limits(folder / "absent", folder / "1").processors, GroupLimits{}.processors);
  EXPECT_GE(usable_processors(), 1);
  EXPECT_EQ(memory_limit(2.0), 2e9);
  EXPECT_GT(memory_limit(0.0), 0.0);
}

TEST(ReportedLoop, VisitsEveryIndexOnceAndReportsAllOfTheRange) {
  std::vector<int> visits(5000, 0);
  std::vector<double> fractions;
  const Progress progress = [&](double fraction, std::string_view words) {
    EXPECT_EQ(words, "work");
    fractions.push_back(fraction);
    return true;
  };
  reported_parallel_for({1000, 4000, 8000}, progress, "work",
                        [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; });
  for (std::size_t i = 0; i < visits.size(); ++i) EXPECT_EQ(visits[i], i >= 1000 && i < 4000 ? 1 : 0);
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 0.5);
}

TEST(ReportedLoop, StopsWhenAsked) {
  std::atomic<int> done{0};
  const Progress stop = [](double, std::string_view) { return false; };
  EXPECT_THROW(reported_parallel_for({0, 1000000, 1000000}, stop, "work", [&](std::int64_t) { ++done; }),
               WorkError);
  EXPECT_LT(done.load(), 1000000);
}

TEST(ReportedLoop, WithoutProgressAndWithoutIndices) {
  std::atomic<int> done{0};
  reported_parallel_for({0, 100, 100}, {}, "work", [&](std::int64_t) { ++done; });
  EXPECT_EQ(done.load(), 100);
  reported_parallel_for(
      {5, 5, 10}, [](double, std::string_view) { return false; }, "work", [&](std::int64_t) { ++done; });
  EXPECT_EQ(done.load(), 100);
}

}  // namespace
}  // namespace astrolith
