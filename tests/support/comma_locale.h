// A locale whose decimal point is a comma, as a program around the Python package may have set.
#pragma once

#include <clocale>
#include <cstdlib>
#include <string>

#include "tests/support/scratch_folder.h"

namespace astrolith::testing {

// While it lives, the C library writes 0,5 for 0.5, if is_set().
class CommaLocale {
 public:
  CommaLocale() {
    const std::string file = (folder_ / "de_DE.UTF-8").string();
    const std::string make = "localedef -i de_DE -f UTF-8 " + file + " >/dev/null 2>&1";
    if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr && std::system(make.c_str()) == 0) {
      setenv("LOCPATH", folder_.path().c_str(), 1);
      std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    }
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
  }
  static bool is_set() { return std::localeconv()->decimal_point[0] == ','; }

 private:
  ScratchFolder folder_;
};

}  // namespace astrolith::testing
