#include "numerics/version/code_version.h"

namespace astrolith {

std::string CodeVersion::text() const {
  if (commit.empty()) return release;
  return release + " (" + commit + (changes.empty() ? ")" : ", modified)");
}

}  // namespace astrolith
