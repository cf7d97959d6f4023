#include "numerics/files/npy_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using testing::text_of;

TEST(NpyFile, HasTheHeaderAndTheBytes) {
  const testing::ScratchFolder folder;
  const auto file = folder / "a.npy";
  const std::vector<double> values{1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  write_npy(values, std::vector<int>{2, 3}, file);
  const std::string bytes = text_of(file);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t start = bytes.size() - 6 * sizeof(double);
  EXPECT_EQ(start % 64, 0u);
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]), start - 10);
  EXPECT_NE(bytes.find("'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }"), std::string::npos);
  EXPECT_EQ(bytes[start - 1], '\n');
  EXPECT_EQ(std::memcmp(bytes.data() + start, values.data(), 6 * sizeof(double)), 0);
}

TEST(NpyFile, OneAxisAndWrongShapes) {
  const testing::ScratchFolder folder;
  const std::vector<double> values{1.0, 2.0};
  write_npy(values, std::vector<int>{2}, folder / "a.npy");
  EXPECT_NE(text_of(folder / "a.npy").find("'shape': (2, ), }"), std::string::npos);
  EXPECT_THROW(write_npy(values, std::vector<int>{2, 2}, folder / "b.npy"), WorkError);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.npy"));
}

}  // namespace
}  // namespace astrolith
