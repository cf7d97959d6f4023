// Paths of the real data for tests: the folder beside the checkout, and what scripts/fetch_data.sh unpacked.
// A test that needs a file which is absent skips with a word.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace astrolith::testing {

std::filesystem::path shared_shape(const std::string& name);
std::filesystem::path shared_texture(const std::string& name);
// data-cache/gravel.png, data-cache/<body>.bmf
std::filesystem::path package_file(const std::string& name);

}  // namespace astrolith::testing

#define ASTROLITH_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << (path).string() << " here"
