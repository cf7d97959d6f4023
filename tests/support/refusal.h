// What is said when an input is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "numerics/errors.h"

namespace astrolith::testing {

// The message of the InputError that the work throws; "no error" where it throws none.
template <typename Work>
std::string refusal_text(const Work& work) {
  try {
    work();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

inline ::testing::AssertionResult has(const std::string& text, const std::string& words) {
  const bool found = text.find(words) != std::string::npos;
  return (found ? ::testing::AssertionSuccess() : ::testing::AssertionFailure())
         << "\"" << words << "\" is " << (found ? "in: " : "not in: ") << text;
}

}  // namespace astrolith::testing
