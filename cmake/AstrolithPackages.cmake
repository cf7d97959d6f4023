# Everything outside our purpose comes from a well-kept package; scripts/setup.sh installs them on Debian 12.
find_package(TBB REQUIRED)                 # threads
find_package(Eigen3 3.4 REQUIRED NO_MODULE)  # dense linear algebra
find_package(nlohmann_json 3.11 REQUIRED)  # recipes and summaries
find_package(OpenSSL REQUIRED COMPONENTS Crypto)  # SHA-256
find_package(embree 3 REQUIRED)            # rays for previews, closest points on surfaces
find_package(OpenMesh REQUIRED)            # half-edges for curvature
find_package(nanoflann REQUIRED)            # nearest points of a cloud
find_package(PNG REQUIRED)
find_package(TIFF REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)               # command lines
if(ASTROLITH_ESTIMATION)
  find_package(Ceres REQUIRED)             # least squares
  find_package(NLopt REQUIRED)             # global optimisers
  find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs ml)  # images in, random forests
  find_package(Spectra REQUIRED)           # eigenvalues of large matrices
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3 fftw3f)  # Fourier transforms
  pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)  # figures
endif()

# CUDA is used where it is found, and never needed. Sanitizers do not see GPU code, so they build without.
option(ASTROLITH_CUDA "Build the GPU code where a CUDA compiler is found" ON)
if(ASTROLITH_CUDA AND NOT ASTROLITH_SANITIZE)
  include(CheckLanguage)
  check_language(CUDA)
endif()
if(ASTROLITH_CUDA AND NOT ASTROLITH_SANITIZE AND CMAKE_CUDA_COMPILER)
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    # Machine code for Turing, Ampere and Hopper, and the newest as PTX for what comes after.
    set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 90)
  endif()
  enable_language(CUDA)
  # CMake 3.25 does not know that nvcc has C++20.
  set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
  set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
  find_package(CUDAToolkit REQUIRED)
  set(ASTROLITH_HAS_CUDA ON)
  message(STATUS "GPU code: built by ${CMAKE_CUDA_COMPILER} for ${CMAKE_CUDA_ARCHITECTURES}")
else()
  message(STATUS "GPU code: left out, for want of a CUDA compiler or by ASTROLITH_CUDA or ASTROLITH_SANITIZE; the CPU computes")
endif()

if(ASTROLITH_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(ASTROLITH_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# Real data used by tests where present: the folder beside the checkout, and the two Debian packages that
# scripts/fetch_data.sh unpacks.
set(ASTROLITH_SHARED_DATA "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH "Folder with shapes/ and textures/")
set(ASTROLITH_PACKAGE_DATA "${PROJECT_SOURCE_DIR}/data-cache" CACHE PATH "Folder that scripts/fetch_data.sh fills")
