# Everything outside our purpose comes from a well-kept package; scripts/setup.sh installs them on Debian 12.
find_package(TBB REQUIRED)                 # threads
find_package(Eigen3 3.4 REQUIRED NO_MODULE)  # dense linear algebra
find_package(nlohmann_json 3.11 REQUIRED)  # recipes and summaries
find_package(OpenSSL REQUIRED COMPONENTS Crypto)  # SHA-256
find_package(embree 3 REQUIRED)            # rays for previews, closest points on surfaces
find_package(OpenMesh REQUIRED)            # half-edges for curvature
find_package(PNG REQUIRED)
find_package(TIFF REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)               # command lines
if(ASTROLITH_ESTIMATION)
  find_package(Ceres REQUIRED)             # least squares
  find_package(NLopt REQUIRED)             # global optimisers
  find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs)  # images in
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3 fftw3f)  # Fourier transforms
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
