#include "numerics/parallel_for.h"

#include <stdexcept>
#include <vector>

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

}  // namespace
}  // namespace astrolith
