# Writes a C++ file that says from which code the programs are built. A build runs this script every time and compiles the
# file anew only where its content has changed.
#   cmake -DSOURCE=FOLDER -DRELEASE=0.2.0 -DOUTPUT=FILE.cpp -P AstrolithGitVersion.cmake
# Without git, or outside a checkout of this project, the commit is empty.
function(git result)
  execute_process(COMMAND git --no-optional-locks ${ARGN} WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE output ERROR_QUIET RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT status STREQUAL "0")
    set(output "")
  endif()
  set(${result} "${output}" PARENT_SCOPE)
  set(${result}_status "${status}" PARENT_SCOPE)
endfunction()

set(commit "")
set(changes "")
git(prefix rev-parse --show-prefix)
# A source archive that was unpacked inside some other checkout lies in a subfolder of it, and has its prefix.
if(prefix_status STREQUAL "0" AND prefix STREQUAL "")
  git(commit rev-parse --short=7 HEAD)
endif()
if(commit)
  # The digest tells one modified tree from another. Checkpoints need that, people need not.
  git(difference diff HEAD --no-color --no-ext-diff --binary)
  if(NOT difference STREQUAL "")
    string(SHA256 changes "${difference}")
    string(SUBSTRING ${changes} 0 16 changes)
  endif()
endif()

set(content "// Written by cmake/AstrolithGitVersion.cmake.
#include \"numerics/version/code_version.h\"

const astrolith::CodeVersion astrolith::kCodeVersion{\"${RELEASE}\", \"${commit}\", \"${changes}\"};
")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL content)
  file(WRITE ${OUTPUT} "${content}")
endif()
