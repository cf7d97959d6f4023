#include "estimation/gabor/npy_file.h"

#include <unistd.h>

#include <cstring>
#include <fstream>
#include <vector>

namespace astrolith {
namespace {

TEST(NpyFile, HasTheHeaderAndTheBytes) {
  const auto file =
      std::filesystem::temp_directory_path() / ("astrolith_" + std::to_string(::getpid()) + ".npy");
  const std::vector<double> values{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  write_npy(values, std::vector<int>{2, 3}, file);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  std::filesystem::remove(file);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t start = bytes.size() - 6 * sizeof(double);
  EXPECT_EQ(start % 64, 0u);
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]), start - 10);
  EXPECT_NE(bytes.find("'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }"), std::string::npos);
  EXPECT_EQ(bytes[start - 1], '\n');
  EXPECT_EQ(std::memcmp(bytes.data() + start, values.data(), 6 * sizeof(double)), 0);
}

}  // namespace
}  // namespace astrolith
