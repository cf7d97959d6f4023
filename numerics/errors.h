// Failures cross library borders as one of two exceptions; programs turn them into exit status 2 and 1.
#pragma once

#include <stdexcept>
#include <string>

namespace astrolith {

// The user's input is wrong. The message is one line: file, place in it, what is wrong, what to do.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The input was fine and the work failed all the same (disk full, no memory, a broken invariant).
class WorkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace astrolith
