# The functions that make a library, a program and a test. Warnings, floating-point rules and installation are stated here
# only.

# The floating-point rules behind "same input, same bytes": no contraction of a*b+c unless the code says
# fma, and no errno or trap bookkeeping, which would keep loops from vectorising without changing a value.
add_library(astrolith_compile_rules INTERFACE)
target_compile_options(astrolith_compile_rules INTERFACE
  $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-ffp-contract=off;-fno-math-errno;-fno-trapping-math>
  # g++ 12.2 drops the rounding of double(float(x)) when it vectorises such statements pairwise.
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-tree-slp-vectorize>
  # No other library takes the place of these functions, so that calls within a source can be inlined.
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-semantic-interposition>)
if(ASTROLITH_SANITIZE)
  target_compile_options(astrolith_compile_rules INTERFACE
    -fsanitize=${ASTROLITH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(astrolith_compile_rules INTERFACE -fsanitize=${ASTROLITH_SANITIZE})
  # Eigen asks how malloc aligns and answers otherwise under the address sanitizer. Ceres was built without it, and
  # what one side takes the other gives back.
  target_compile_definitions(astrolith_compile_rules INTERFACE ASTROLITH_SANITIZED EIGEN_MALLOC_ALREADY_ALIGNED=1)
  if(ASTROLITH_SANITIZE STREQUAL "thread")
    target_compile_definitions(astrolith_compile_rules INTERFACE ASTROLITH_THREAD_SANITIZER)
  endif()
endif()
if(ASTROLITH_FUZZ)
  target_compile_options(astrolith_compile_rules INTERFACE -fsanitize=fuzzer-no-link)  # counts what inputs reach
endif()
# scripts/check_simd.sh builds with one instruction set at a time and compares the bits of their results. "scalar"
# vectorises nothing.
set(ASTROLITH_SIMD "" CACHE STRING "scalar or a -march value; empty: the machine chooses among three at start")
set(vectorised -fopenmp-simd)
if(ASTROLITH_SIMD)
  target_compile_definitions(astrolith_compile_rules INTERFACE ASTROLITH_ONE_SIMD)
endif()
if(ASTROLITH_SIMD STREQUAL "scalar")
  set(vectorised -fno-tree-vectorize -Wno-unknown-pragmas)
elseif(ASTROLITH_SIMD)
  target_compile_options(astrolith_compile_rules INTERFACE -march=${ASTROLITH_SIMD})
endif()

add_library(astrolith_warnings INTERFACE)
target_compile_options(astrolith_warnings INTERFACE
  $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wno-psabi;${vectorised}>
  $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-pass-failed>  # clang 14 does not vectorise all that g++ does
  $<$<AND:$<BOOL:${ASTROLITH_WERROR}>,$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>>:-Werror>)

# astrolith_library(NAME [ROOMS] [SOURCES a.cpp ...] PUBLIC link ... PRIVATE link ...)
# Makes target astrolith_NAME with alias astrolith::NAME. ROOMS says that astrolith_room adds the
# sources of folders. A library with neither is header-only.
function(astrolith_library name)
  cmake_parse_arguments(ARG "ROOMS" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target astrolith_${name})
  if(ARG_SOURCES OR ARG_ROOMS)
    add_library(${target} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:astrolith_warnings>)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
    target_link_libraries(${target} INTERFACE ${ARG_PUBLIC})
  endif()
  add_library(astrolith::${name} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_link_libraries(${target} ${scope} astrolith_compile_rules)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/astrolith>)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY ASTROLITH_LIBRARIES ${target})
endfunction()

# astrolith_room(NAME FOLDER SOURCES a.cpp ... [NATIVE b.cpp ...] [WEB c.cpp ...])  adds the sources of a folder to library
# NAME, which the same CMakeLists.txt makes. NATIVE sources need a package that WebAssembly has not; WEB sources take the place of
# such in the web build.
function(astrolith_room name folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;NATIVE;WEB" ${ARGN})
  if(EMSCRIPTEN)
    set(sources ${ARG_SOURCES} ${ARG_WEB})
  else()
    set(sources ${ARG_SOURCES} ${ARG_NATIVE})
  endif()
  list(TRANSFORM sources PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/)
  target_sources(astrolith_${name} PRIVATE ${sources})
endfunction()

# astrolith_program(NAME [SOURCES x.cpp ...] LINK link ...)  builds NAME.cpp of this folder, with further sources
function(astrolith_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${name}.cpp ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} astrolith_program_common astrolith_warnings)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  set_property(GLOBAL APPEND PROPERTY ASTROLITH_PROGRAMS ${name})
endfunction()

# How the tests' own code is compiled; the libraries under test keep the flags of the preset. In a release build -O1 takes half
# the time of -O3. With a sanitizer the compiler takes a third of the time without optimisation.
if(ASTROLITH_SANITIZE)
  set(astrolith_test_options -O0)
else()
  set(astrolith_test_options $<$<CONFIG:Release>:-O1>)
endif()

# astrolith_test(NAME [OPTIMISED] [FOLDERS folder ...] [SOURCES x_test.cpp ...] LINK link ...)  one executable of GoogleTest
# cases. FOLDERS stands for all sources in each of these folders.
# OPTIMISED is for tests that run an algorithm of a header at length: their code keeps the flags of the preset, too.
# Six processes run the cases in turn, since a start takes longer than most cases. The environment's GTEST_FILTER chooses
# among the cases. A case whose name ends in Long takes seconds; scripts/test.sh leaves it out.
function(astrolith_test name)
  cmake_parse_arguments(ARG "OPTIMISED" "" "FOLDERS;SOURCES;LINK" ${ARGN})
  foreach(folder IN LISTS ARG_FOLDERS)
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
    list(APPEND ARG_SOURCES ${sources})
  endforeach()
  add_executable(${name}_tests ${ARG_SOURCES})
  target_link_libraries(${name}_tests PRIVATE ${ARG_LINK} astrolith_test_data astrolith_warnings GTest::gtest_main)
  if(ARG_OPTIMISED)
    target_precompile_headers(${name}_tests PRIVATE <gtest/gtest.h>)
  else()
    target_compile_options(${name}_tests PRIVATE ${astrolith_test_options})
    target_precompile_headers(${name}_tests REUSE_FROM astrolith_test_headers)
  endif()
  foreach(shard RANGE 5)
    add_test(NAME ${name}.shard_${shard} COMMAND ${name}_tests --gtest_brief=1)
    set_tests_properties(${name}.shard_${shard} PROPERTIES TIMEOUT 3600
      ENVIRONMENT "GTEST_TOTAL_SHARDS=6;GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()
