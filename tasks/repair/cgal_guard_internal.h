// Calls of CGAL: what CGAL finds wrong becomes an InputError.
#pragma once

#include <CGAL/assertions_behaviour.h>
#include <CGAL/exceptions.h>

#include <string>

#include "numerics/errors.h"

namespace astrolith {

// CGAL prints what it finds wrong before it throws. Libraries are silent. The handlers are those of the whole
// process, and stay: other threads may be at work.
inline void silence_cgal() {
  static const bool done = [] {
    const auto ignore = [](const char*, const char*, const char*, int, const char*) {};
    CGAL::set_error_handler(ignore);
    CGAL::set_warning_handler(ignore);
    return true;
  }();
  static_cast<void>(done);
}

// Runs a step of CGAL. Throws InputError "NAME: WHAT" where CGAL finds its input or result wrong.
template <typename Step>
auto guarded(const std::string& name, const std::string& what, const Step& step) {
  silence_cgal();
  try {
    return step();
  } catch (const CGAL::Failure_exception&) {
    throw InputError(name + ": " + what);
  }
}

}  // namespace astrolith
