#include <atomic>
#include <stdexcept>
#include <vector>

#include "numerics/parallel_for.h"
#include "numerics/reported_loop.h"

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
