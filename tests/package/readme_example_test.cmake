# Arguments: BUILD, WORK (a folder of our own), BODY, README, GENERATOR, COMPILER, CONFIG, LAUNCHER (may be empty).
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nfailed with status ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# The first block of README.md fenced as the given language.
function(readme_block language variable)
  file(READ ${README} text)
  string(FIND "${text}" "```${language}\n" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${README} has no example in ${language}")
  endif()
  string(LENGTH "```${language}\n" fence)
  math(EXPR begin "${begin} + ${fence}")
  string(SUBSTRING "${text}" ${begin} -1 text)
  string(FIND "${text}" "```" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/source)
readme_block(cpp program)
readme_block(cmake use_package)
file(WRITE ${WORK}/source/main.cpp "${program}")
file(WRITE ${WORK}/source/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
add_executable(mine main.cpp)
${use_package}")
file(COPY ${BODY} DESTINATION ${WORK})

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --config ${CONFIG})
run(${CMAKE_COMMAND} -S source -B build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build build --config ${CONFIG})
run(build/mine)

# A lone sphere of radius R at the origin, seen from (r, 0, 0): its log field is 1 - r^2/R^2, so the
# first-order distance is s = (R^2 - r^2) / (2 r) and ds/dr = -(R^2 / r^2 + 1) / 2. With R = 0.2 and r = 0.1
# that is 0.15, inside, and -2.5.
if(NOT output MATCHES "^([-0-9.]+) 1 ([-0-9.]+)\n$")
  message(FATAL_ERROR "unexpected output: ${output}")
endif()
set(value ${CMAKE_MATCH_1})
set(slope ${CMAKE_MATCH_2})
if(value LESS 0.14999 OR value GREATER 0.15001 OR slope LESS -2.5001 OR slope GREATER -2.4999)
  message(FATAL_ERROR "value ${value} is not 0.15, or slope ${slope} not -2.5")
endif()

# The installed program finds the installed library.
run(${WORK}/prefix/bin/synth eros --resolution 16 -o eros.ply --quiet)

foreach(file share/astrolith/library/SOURCES.md share/astrolith/recipe.schema.json include/astrolith/recipe/recipe.h)
  if(NOT EXISTS ${WORK}/prefix/${file})
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()
file(GLOB_RECURSE headers ${WORK}/prefix/include/*.h)
foreach(header IN LISTS headers)
  file(STRINGS ${header} internal REGEX "#include \".*_internal\\.h\"")
  if(internal)
    message(FATAL_ERROR "${header} includes a header that is not installed: ${internal}")
  endif()
endforeach()
