// Finds the option that a misspelt word on the command line was probably meant to be.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/edit_distance.h"

namespace astrolith {

// The name that is nearest to the word, both without dashes in front: one that differs by at most a third of
// the word's letters, or one that the word begins. Empty where there is none, and for words above 64 letters.
inline std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t kLongestWord = 64;
  if (word.size() < 2 || word.size() > kLongestWord) return "";
  std::size_t least = std::numeric_limits<std::size_t>::max();
  std::string nearest;
  for (const std::string& name : names) {
    const bool begun = name.starts_with(word);
    const std::size_t distance = begun ? 1 : edit_distance(word, name);
    if (distance >= least || (!begun && 3 * distance > std::max(word.size(), std::size_t{3}))) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

}  // namespace astrolith
