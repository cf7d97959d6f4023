// The code that a program was built from.
#pragma once

#include <string>

namespace astrolith {

struct CodeVersion {
  std::string release;  // "0.2.0"
  std::string commit;   // the short hash of the git commit; empty where the build knew of none
  std::string changes;  // a digest of what was modified since that commit; empty where nothing was

  // "0.2.0 (1a2b3c4, modified)", "0.2.0 (1a2b3c4)" or "0.2.0"
  std::string text() const;
};

// Defined in a file that every build writes (cmake/AstrolithGitVersion.cmake).
extern const CodeVersion kCodeVersion;

}  // namespace astrolith
