#include "synthesis/picture/image_file.h"

#include <png.h>
#include <tiffio.h>

#include <string>

#include "numerics/errors.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

class ImageFile : public ::testing::Test {
 protected:
  const testing::ScratchFolder folder_;
  const std::filesystem::path file_ = folder_ / "image";
};

// Decodes with libpng's own simplified reader.
std::vector<std::uint8_t> read_png(const std::filesystem::path& file, png_uint_32 format, int width,
                                   int height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0);
  EXPECT_EQ(static_cast<int>(image.width), width);
  EXPECT_EQ(static_cast<int>(image.height), height);
  image.format = format;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0);
  return bytes;
}

TEST_F(ImageFile, BytesComeBack) {
  const RgbImage image{3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 100, 110, 120, 255, 255, 255}};
  write_png8_rgb(image, file_);
  EXPECT_EQ(read_png(file_, PNG_FORMAT_RGB, 3, 2), image.pixels);
  const std::vector<std::uint8_t> grey{0, 10, 200, 255};
  write_png8_grey(grey, 4, 1, file_);
  EXPECT_EQ(read_png(file_, PNG_FORMAT_GRAY, 4, 1), grey);
}

// The words of a PNG of 16 bits, which must be big-endian, in rows of so many words.
std::vector<int> words_of(const std::filesystem::path& file, int color_type, std::size_t rows,
                          std::size_t words) {
  std::FILE* in = std::fopen(file.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, in);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  EXPECT_EQ(png_get_bit_depth(png, info), 16);
  EXPECT_EQ(png_get_color_type(png, info), color_type);
  std::vector<int> values;
  for (std::size_t y = 0; y < rows; ++y) {
    const png_bytep row = png_get_rows(png, info)[y];
    for (std::size_t i = 0; i < words; ++i) values.push_back(row[2 * i] * 256 + row[2 * i + 1]);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(in);
  return values;
}

TEST_F(ImageFile, SixteenBitsAreBigEndianAndExact) {
  const std::vector<std::uint16_t> values{0, 1, 256, 32768, 65535, 4660};
  const std::vector<int> expected(values.begin(), values.end());
  write_png16_grey(values, 2, 3, file_);
  EXPECT_EQ(words_of(file_, PNG_COLOR_TYPE_GRAY, 3, 2), expected);
  write_png16_rgb(values, 2, 1, file_);
  EXPECT_EQ(words_of(file_, PNG_COLOR_TYPE_RGB, 1, 6), expected);
}

TEST_F(ImageFile, FloatsComeBackBitForBit) {
  const std::vector<float> values{-1.5f, 0.0f, 3.25e-7f, 1e30f, -0.1f, 42.0f};
  for (const int channels : {1, 3}) {
    write_tiff_float(values, 3 / channels, 2, file_, channels);
    TIFF* tiff = TIFFOpen(file_.c_str(), "r");
    ASSERT_NE(tiff, nullptr);
    for (std::uint32_t y = 0; y < 2; ++y) {
      std::array<float, 3> row{};
      ASSERT_EQ(TIFFReadScanline(tiff, row.data(), y), 1);
      for (std::size_t x = 0; x < 3; ++x) EXPECT_EQ(row[x], values[3 * y + x]);
    }
    TIFFClose(tiff);
  }
}

TEST_F(ImageFile, SameImageSameBytes) {
  const std::vector<std::uint16_t> grey(64 * 64, 1234);
  write_png16_grey(grey, 64, 64, folder_ / "a.png");
  write_png16_grey(grey, 64, 64, folder_ / "b.png");
  EXPECT_EQ(testing::text_of(folder_ / "a.png"), testing::text_of(folder_ / "b.png"));
}

TEST_F(ImageFile, WrongSizesAndFoldersLeaveNothingBehind) {
  EXPECT_THROW(write_png8_rgb({2, 2, {1, 2, 3}}, file_), InputError);
  EXPECT_THROW(write_png16_grey({}, 0, 0, file_), InputError);
  EXPECT_THROW(write_tiff_float(std::vector<float>(4), 4, -1, file_), InputError);
  EXPECT_TRUE(folder_.files().empty());
  EXPECT_THROW(write_png8_rgb({1, 1, {1, 2, 3}}, "/no/such/folder/a.png"), InputError);
  EXPECT_THROW(write_tiff_float(std::vector<float>(1), 1, 1, "/no/such/folder/a.tif"), InputError);
}

}  // namespace
}  // namespace astrolith
