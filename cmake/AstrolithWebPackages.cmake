# The packages of the web build (Emscripten). WebAssembly takes two libraries of headers from the system, and stand-ins from
# web/compat for what it has not. Sources that need other packages are named NATIVE and are left out.
set(compat ${PROJECT_SOURCE_DIR}/web/compat)
set(header_folder ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${header_folder})
foreach(library nlohmann fmt)
  # A link to each library alone: the system's folder has headers of another C library, too.
  find_path(${library}_parent ${library} PATHS /usr/include REQUIRED NO_CACHE NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
  file(CREATE_LINK ${${library}_parent}/${library} ${header_folder}/${library} SYMBOLIC)
endforeach()

foreach(target TBB::tbb nlohmann_json::nlohmann_json fmt::fmt OpenSSL::Crypto PkgConfig::ZSTD ZLIB::ZLIB embree OpenMeshCore OpenMeshTools
    Eigen3::Eigen nanoflann::nanoflann PkgConfig::SPNG PkgConfig::CAIRO TIFF::TIFF)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
endforeach()
target_include_directories(TBB::tbb INTERFACE ${compat} ${header_folder})
target_compile_definitions(TBB::tbb INTERFACE FMT_HEADER_ONLY)
