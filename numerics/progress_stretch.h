// Progress of the parts of long work.
#pragma once

#include "numerics/progress.h"

namespace astrolith {

// The callback of a part of the work, which goes from one fraction of the whole to another.
inline Progress stretch(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double fraction, std::string_view words) {
    return progress(from + (to - from) * fraction, words);
  };
}

}  // namespace astrolith
