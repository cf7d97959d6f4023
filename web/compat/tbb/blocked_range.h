// oneTBB's range, for the loops of tbb/parallel_for.h beside it.
#pragma once

#include <cstddef>

namespace tbb {

template <typename Index>
class blocked_range {
 public:
  blocked_range(Index begin, Index end, std::size_t /*grain*/ = 1) : begin_(begin), end_(end) {}
  Index begin() const { return begin_; }
  Index end() const { return end_; }

 private:
  Index begin_, end_;
};

}  // namespace tbb
