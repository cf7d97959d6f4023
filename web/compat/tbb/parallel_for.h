// oneTBB's loop on the calling thread: WebAssembly has one.
#pragma once

#include "tbb/blocked_range.h"

namespace tbb {

template <typename Range, typename Body>
void parallel_for(const Range& range, const Body& body) {
  if (range.begin() < range.end()) body(range);
}

}  // namespace tbb
