#include "tests/support/data.h"

namespace astrolith::testing {

std::filesystem::path shared_shape(const std::string& name) {
  return std::filesystem::path(ASTROLITH_SHARED_DATA) / "shapes" / name;
}

std::filesystem::path shared_texture(const std::string& name) {
  return std::filesystem::path(ASTROLITH_SHARED_DATA) / "textures" / name;
}

std::filesystem::path package_file(const std::string& name) {
  return std::filesystem::path(ASTROLITH_PACKAGE_DATA) / name;
}

}  // namespace astrolith::testing
