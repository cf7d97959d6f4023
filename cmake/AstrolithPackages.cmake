# The packages that Astrolith is built on. scripts/setup.sh installs them on Debian 12.
find_package(TBB REQUIRED)                 # threads
find_package(Eigen3 3.4 REQUIRED NO_MODULE)  # dense linear algebra
find_package(nlohmann_json 3.11 REQUIRED)  # recipes and summaries
find_package(OpenSSL REQUIRED COMPONENTS Crypto)  # SHA-256
find_package(embree 4 QUIET)               # rays for previews, closest points on surfaces
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
find_package(OpenMesh REQUIRED)            # half-edges for curvature, decimation
find_package(nanoflann REQUIRED)            # nearest points of a cloud
find_package(TIFF REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)               # command lines
find_package(PkgConfig REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)  # .ply.zst
find_package(ZLIB REQUIRED)                # meshes in .gz
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip)  # NPZ
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)  # PNG
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)  # text and lines of pictures
if(CAIRO_LINK_LIBRARIES MATCHES "[.]a$")  # scripts/wheel_packages.sh
  target_link_libraries(PkgConfig::CAIRO INTERFACE ${CAIRO_STATIC_LDFLAGS})
endif()
if(ASTROLITH_ESTIMATION)
  find_package(Ceres REQUIRED)             # least squares
  find_package(NLopt REQUIRED)             # global optimisers
  find_package(OpenCV REQUIRED COMPONENTS core ml)  # random forests
  option(ASTROLITH_GDAL "Read photos and rasters by GDAL; without it PNG alone" ON)
  if(ASTROLITH_GDAL)
    pkg_check_modules(GDAL REQUIRED IMPORTED_TARGET gdal)  # rasters in
  endif()
  find_package(Spectra REQUIRED)           # eigenvalues of large matrices
  find_package(CGAL REQUIRED)              # repair of meshes
  pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3 fftw3f)  # Fourier transforms
endif()

# The architectures of this machine's GPUs as CMake names them, such as "90-real". Where nvidia-smi finds no GPU, the result
# is PTX for Turing: the driver of every newer GPU compiles PTX when a program first uses it.
function(astrolith_cuda_architectures result)
  find_program(ASTROLITH_NVIDIA_SMI nvidia-smi)
  mark_as_advanced(ASTROLITH_NVIDIA_SMI)
  set(capabilities)
  if(ASTROLITH_NVIDIA_SMI)
    execute_process(COMMAND ${ASTROLITH_NVIDIA_SMI} --query-gpu=compute_cap --format=csv,noheader
      OUTPUT_VARIABLE capabilities ERROR_QUIET)
    string(REGEX MATCHALL "[0-9]+\\.[0-9]" capabilities "${capabilities}")
    list(REMOVE_DUPLICATES capabilities)
    list(TRANSFORM capabilities REPLACE "([0-9]+)\\.([0-9])" "\\1\\2-real")
  endif()
  if(NOT capabilities)
    set(capabilities 75-virtual)
  endif()
  set(${result} "${capabilities}" PARENT_SCOPE)
endfunction()

# The GPU code takes three processor minutes and is built where it is asked for; scripts/build.sh asks where there is a GPU.
# No program needs it. Sanitizers do not see GPU code, so their builds leave it out.
option(ASTROLITH_CUDA "Build the GPU code where a CUDA compiler is found" OFF)
if(ASTROLITH_CUDA AND NOT ASTROLITH_SANITIZE)
  include(CheckLanguage)
  check_language(CUDA)
endif()
if(ASTROLITH_CUDA AND NOT ASTROLITH_SANITIZE AND CMAKE_CUDA_COMPILER)
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    # One architecture keeps the build short: gpu_mesher.cu alone takes 20 to 50 seconds for each. Programs for other machines
    # are built with -DCMAKE_CUDA_ARCHITECTURES="75-real;80-real;90", as the preset synth-only does.
    astrolith_cuda_architectures(CMAKE_CUDA_ARCHITECTURES)
  endif()
  enable_language(CUDA)
  # CMake 3.25 does not know that nvcc can compile C++20.
  set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
  set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
  find_package(CUDAToolkit REQUIRED)
  set(ASTROLITH_HAS_CUDA ON)
  message(STATUS "GPU code: built by ${CMAKE_CUDA_COMPILER} for ${CMAKE_CUDA_ARCHITECTURES}")
else()
  message(STATUS "GPU code: left out, because ASTROLITH_CUDA is OFF, or ASTROLITH_SANITIZE is set, or no CUDA compiler was found")
endif()

if(ASTROLITH_TESTS)
  find_package(GTest REQUIRED)
  find_package(PNG REQUIRED)  # reads what was written
  include(GoogleTest)
endif()

# Real data used by tests where present: the folder beside the checkout, and the two Debian packages that
# scripts/fetch_data.sh unpacks.
set(ASTROLITH_SHARED_DATA "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH "Folder with shapes/ and textures/")
set(ASTROLITH_PACKAGE_DATA "${PROJECT_SOURCE_DIR}/data-cache" CACHE PATH "Folder that scripts/fetch_data.sh fills")
