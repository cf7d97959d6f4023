// Progress of long work: libraries never print, they call a function.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace astrolith {

// Called with the fraction done in [0, 1] and a few words ("refine 0.12 %"). Returns false to ask the work to
// stop early; the work then returns its best result so far and says so. May be empty.
using Progress = std::function<bool(double fraction, std::string_view words)>;

// Makes the callback for a stage of work that has several.
using StageProgress = std::function<Progress(const std::string& stage)>;

// True when the work may go on.
inline bool report(const Progress& progress, double fraction, std::string_view words) {
  return !progress || progress(fraction, words);
}

// The callback of a part of the work, which goes from one fraction of the whole to another.
inline Progress stretch(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double fraction, std::string_view words) {
    return progress(from + (to - from) * fraction, words);
  };
}

}  // namespace astrolith
