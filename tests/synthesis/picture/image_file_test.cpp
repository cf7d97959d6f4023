#include <png.h>
#include <tiffio.h>
#include <cmath>
#include <numbers>
#include <string>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/picture/image_file.h"
#include "synthesis/picture/surface_maps.h"
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
std::vector<int> read_rows(const std::filesystem::path& file, int color_type, std::size_t rows,
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
  EXPECT_EQ(read_rows(file_, PNG_COLOR_TYPE_GRAY, 3, 2), expected);
  write_png16_rgb(values, 2, 1, file_);
  EXPECT_EQ(read_rows(file_, PNG_COLOR_TYPE_RGB, 1, 6), expected);
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
  EXPECT_EQ(testing::read_text(folder_ / "a.png"), testing::read_text(folder_ / "b.png"));
}

TEST_F(ImageFile, WrongSizesAndFoldersLeaveNothingBehind) {
  EXPECT_THROW(write_png8_rgb({2, 2, {1, 2, 3}}, file_), InputError);
  EXPECT_THROW(write_png16_grey({}, 0, 0, file_), InputError);
  EXPECT_THROW(write_tiff_float(std::vector<float>(4), 4, -1, file_), InputError);
  EXPECT_TRUE(folder_.files().empty());
  EXPECT_THROW(write_png8_rgb({1, 1, {1, 2, 3}}, "/no/such/folder/a.png"), InputError);
  EXPECT_THROW(write_tiff_float(std::vector<float>(1), 1, 1, "/no/such/folder/a.tif"), InputError);
}

// A map of heights f(x, y) in length units at pixel centres.
template <class Heights>
std::vector<float> make_map(int width, int height, const Heights& f) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) values.push_back(static_cast<float>(f(x, y)));
  }
  return values;
}

// A slope that rises by 0.5 to the right and by 0.25 up the picture has one normal, borders included.
TEST(SurfaceMaps, NormalsOfAPlaneAreThatOfItsSlopes) {
  const double pixel = 0.01;
  const std::vector<float> heights =
      make_map(40, 30, [=](int x, int y) { return pixel * (0.5 * x - 0.25 * y); });
  const std::vector<float> normals = normal_map({heights, 40, 30, pixel, false});
  const double length = std::sqrt(1.0 + 0.25 + 0.0625);
  for (std::size_t i = 0; i < normals.size(); i += 3) {
    ASSERT_NEAR(static_cast<double>(normals[i]), -0.5 / length, 1e-4);
    ASSERT_NEAR(static_cast<double>(normals[i + 1]), -0.25 / length, 1e-4);
    ASSERT_NEAR(static_cast<double>(normals[i + 2]), 1.0 / length, 1e-4);
  }
}

// A map that repeats has the slopes of its copies at its border.
TEST(SurfaceMaps, ARepeatingMapIsMovedWithoutAChange) {
  const auto wave = [](int x, int y) {
    return 3.0 * std::sin(2.0 * std::numbers::pi * x / 32.0) +
           2.0 * std::cos(2.0 * std::numbers::pi * y / 32.0);
  };
  const std::vector<float> a = make_map(32, 32, wave),
                           b = make_map(32, 32, [&](int x, int y) { return wave((x + 16) % 32, y); });
  const std::vector<float> na = normal_map({a, 32, 32, 1.0, true}), nb = normal_map({b, 32, 32, 1.0, true}),
                           oa = occlusion_map({a, 32, 32, 1.0, true}),
                           ob = occlusion_map({b, 32, 32, 1.0, true});
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 32; ++x) {
      const std::size_t i = 32 * y + x, j = 32 * y + (x + 16) % 32;
      ASSERT_EQ(oa[j], ob[i]);
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(na[3 * j + k], nb[3 * i + k]);
    }
  }
}

TEST(SurfaceMaps, OpenGroundIsNotOccluded) {
  const std::vector<float> flat(50 * 50, 7.0f);
  for (const bool repeats : {false, true}) {
    for (const float open : occlusion_map({flat, 50, 50, 1.0, repeats})) ASSERT_EQ(open, 1.0f);
  }
}

// At the bottom of a long V-shaped groove of slope t, the horizon at azimuth a has the tangent t |cos a|.
TEST(SurfaceMaps, AGrooveHidesAsMuchSkyAsItsHorizonSays) {
  const double t = 0.8, pixel = 0.1;
  const std::vector<float> heights =
      make_map(257, 257, [=](int x, int) { return t * pixel * std::abs(x - 128); });
  const std::vector<float> open = occlusion_map({heights, 257, 257, pixel, false});
  double expected = 0.0;
  for (int k = 0; k < kOcclusionAzimuths; ++k) {
    const double horizon = t * std::cos(2.0 * std::numbers::pi * k / kOcclusionAzimuths);
    expected += 1.0 / (1.0 + horizon * horizon) / kOcclusionAzimuths;
  }
  EXPECT_NEAR(static_cast<double>(open[128 * 257 + 128]), expected, 0.03);
  EXPECT_GT(open[128 * 257 + 60], open[128 * 257 + 128]);
}

TEST(SurfaceMaps, HaveTheSameBytesForOneThreadAndForMany) {
  const std::vector<float> heights = make_map(150, 90, [](int x, int y) { return (x * 37 + y * 91) % 29; });
  const auto maps = [&](int threads) {
    const ThreadLimit limit(threads);
    std::vector<float> both = normal_map({heights, 150, 90, 2.0, true});
    const std::vector<float> open = occlusion_map({heights, 150, 90, 2.0, true});
    both.insert(both.end(), open.begin(), open.end());
    return both;
  };
  EXPECT_EQ(maps(1), maps(2));
}

TEST(SurfaceMaps, TakeMapsOfOnePixel) {
  const std::vector<float> one{3.0f};
  EXPECT_EQ(normal_map({one, 1, 1, 1.0, false}), (std::vector<float>{0.0f, 0.0f, 1.0f}));
  EXPECT_EQ(occlusion_map({one, 1, 1, 1.0, false}), std::vector<float>{1.0f});
  EXPECT_EQ(occlusion_map({one, 1, 1, 1.0, true}), std::vector<float>{1.0f});
}

}  // namespace
}  // namespace astrolith
