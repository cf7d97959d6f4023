# The version file that a build writes, in a checkout of its own: after a commit, with modifications, and in an archive
# without git. Arguments: SCRIPT, WORK (a folder of our own).
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE output
    ERROR_VARIABLE output OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# The three texts of the version file of a source folder must match a regular expression each.
function(expect_version source commit changes)
  run(${CMAKE_COMMAND} -DSOURCE=${source} -DRELEASE=1.2.3 -DOUTPUT=${WORK}/version.cpp -P ${SCRIPT})
  file(READ ${WORK}/version.cpp text)
  if(NOT text MATCHES "{\"1\\.2\\.3\", \"${commit}\", \"(${changes})\"}")
    message(FATAL_ERROR "expected commit ${commit} and changes ${changes}, but found: ${text}")
  endif()
  set(found_changes "${CMAKE_MATCH_1}" PARENT_SCOPE)
endfunction()

find_program(git git)
if(NOT git)
  message("skipped: git is not installed")
  return()
endif()
set(digest "[0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f]+")
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/checkout/archive)
set(run_git ${git} -C checkout -c user.name=test -c user.email=test@example.org -c commit.gpgsign=false)
run(${run_git} init -q)
file(WRITE ${WORK}/checkout/source.cpp "one")
run(${run_git} add source.cpp)
run(${run_git} commit -q -m first)
run(${run_git} rev-parse --short=7 HEAD)
set(first ${output})
expect_version(${WORK}/checkout ${first} "")

file(WRITE ${WORK}/checkout/source.cpp "two")
expect_version(${WORK}/checkout ${first} ${digest})
set(two ${found_changes})
file(WRITE ${WORK}/checkout/source.cpp "three")
expect_version(${WORK}/checkout ${first} ${digest})
if(found_changes STREQUAL two)
  message(FATAL_ERROR "two modified trees have the same digest ${two}")
endif()

# An archive that was unpacked inside another checkout does not take over the commit of that checkout.
file(WRITE ${WORK}/checkout/archive/source.cpp "one")
expect_version(${WORK}/checkout/archive "" "")

# A file that would not change is not written.
file(TIMESTAMP ${WORK}/version.cpp before "%s" UTC)
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 1.1)
expect_version(${WORK}/checkout/archive "" "")
file(TIMESTAMP ${WORK}/version.cpp after "%s" UTC)
if(NOT before STREQUAL after)
  message(FATAL_ERROR "the version file was written again without a change")
endif()
