#include "synthesis/picture/image_file.h"

#include <png.h>
#include <tiffio.h>

#include <fstream>
#include <iterator>
#include <string>

#include "numerics/errors.h"

namespace astrolith {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) / ("astrolith_image_" + name);
}

// Decodes with libpng's own simplified reader.
std::vector<std::uint8_t> read_png(const std::filesystem::path& file, png_uint_32 format, int& width,
                                   int& height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0);
  width = static_cast<int>(image.width);
  height = static_cast<int>(image.height);
  image.format = format;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr), 0);
  return bytes;
}

TEST(ImageFile, RgbComesBack) {
  const RgbImage image{3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 100, 110, 120, 255, 255, 255}};
  const auto file = temporary("rgb.png");
  write_png8_rgb(image, file);
  int width = 0, height = 0;
  EXPECT_EQ(read_png(file, PNG_FORMAT_RGB, width, height), image.pixels);
  EXPECT_EQ(width, 3);
  EXPECT_EQ(height, 2);
  std::filesystem::remove(file);
}

TEST(ImageFile, SixteenBitGreyIsBigEndianAndExact) {
  const std::vector<std::uint16_t> grey{0, 1, 256, 32768, 65535, 4660};
  const auto file = temporary("grey.png");
  write_png16_grey(grey, 2, 3, file);
  std::FILE* in = std::fopen(file.c_str(), "rb");
  ASSERT_NE(in, nullptr);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, in);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  ASSERT_EQ(png_get_bit_depth(png, info), 16);
  ASSERT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_GRAY);
  for (std::size_t y = 0; y < 3; ++y) {
    const png_bytep row = png_get_rows(png, info)[y];
    for (std::size_t x = 0; x < 2; ++x) EXPECT_EQ(row[2 * x] * 256 + row[2 * x + 1], grey[2 * y + x]);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(in);
  std::filesystem::remove(file);
}

TEST(ImageFile, EightBitGreyComesBack) {
  const std::vector<std::uint8_t> grey{0, 10, 200, 255};
  const auto file = temporary("grey8.png");
  write_png8_grey(grey, 4, 1, file);
  int width = 0, height = 0;
  EXPECT_EQ(read_png(file, PNG_FORMAT_GRAY, width, height), grey);
  std::filesystem::remove(file);
}

TEST(ImageFile, SixteenBitColoursComeBack) {
  const std::vector<std::uint16_t> rgb{0, 1, 256, 65535, 4660, 7};
  const auto file = temporary("rgb16.png");
  write_png16_rgb(rgb, 2, 1, file);
  std::FILE* in = std::fopen(file.c_str(), "rb");
  ASSERT_NE(in, nullptr);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, in);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  ASSERT_EQ(png_get_bit_depth(png, info), 16);
  ASSERT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
  const png_bytep row = png_get_rows(png, info)[0];
  for (std::size_t i = 0; i < rgb.size(); ++i) EXPECT_EQ(row[2 * i] * 256 + row[2 * i + 1], rgb[i]);
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(in);
  std::filesystem::remove(file);
}

TEST(ImageFile, FloatColoursComeBack) {
  const std::vector<float> rgb{-0.5f, 0.0f, 1.25f, 0.1f, 0.2f, 0.3f};
  const auto file = temporary("rgb.tif");
  write_tiff_float(rgb, 1, 2, file, 3);
  TIFF* tiff = TIFFOpen(file.c_str(), "r");
  ASSERT_NE(tiff, nullptr);
  for (std::uint32_t y = 0; y < 2; ++y) {
    std::array<float, 3> pixel{};
    ASSERT_EQ(TIFFReadScanline(tiff, pixel.data(), y), 1);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(pixel[c], rgb[3 * y + c]);
  }
  TIFFClose(tiff);
  std::filesystem::remove(file);
}

TEST(ImageFile, FloatsComeBackBitForBit) {
  const std::vector<float> heights{-1.5f, 0.0f, 3.25e-7f, 1e30f, -0.1f, 42.0f};
  const auto file = temporary("height.tif");
  write_tiff_float(heights, 3, 2, file);
  TIFF* tiff = TIFFOpen(file.c_str(), "r");
  ASSERT_NE(tiff, nullptr);
  for (std::uint32_t y = 0; y < 2; ++y) {
    std::array<float, 3> row{};
    ASSERT_EQ(TIFFReadScanline(tiff, row.data(), y), 1);
    for (std::size_t x = 0; x < 3; ++x) EXPECT_EQ(row[x], heights[3 * y + x]);
  }
  TIFFClose(tiff);
  std::filesystem::remove(file);
}

TEST(ImageFile, SameImageSameBytes) {
  const std::vector<std::uint16_t> grey(64 * 64, 1234);
  const auto contents = [&](const std::string& name) {
    const auto file = temporary(name);
    write_png16_grey(grey, 64, 64, file);
    std::ifstream in(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    std::filesystem::remove(file);
    return bytes;
  };
  EXPECT_EQ(contents("a.png"), contents("b.png"));
}

TEST(ImageFile, WrongSizesAndFoldersLeaveNothingBehind) {
  const auto file = temporary("wrong.png");
  EXPECT_THROW(write_png8_rgb({2, 2, {1, 2, 3}}, file), InputError);
  EXPECT_THROW(write_png16_grey({}, 0, 0, file), InputError);
  EXPECT_THROW(write_tiff_float(std::vector<float>(4), 4, -1, file), InputError);
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_THROW(write_png8_rgb({1, 1, {1, 2, 3}}, "/no/such/folder/a.png"), InputError);
  EXPECT_THROW(write_tiff_float(std::vector<float>(1), 1, 1, "/no/such/folder/a.tif"), InputError);
}

}  // namespace
}  // namespace astrolith
