#include "estimation/gabor/image/image_reader.h"

#include <png.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "numerics/errors.h"
#include "synthesis/picture/image_file.h"
#include "tests/estimation/gabor/image/raster_inputs.h"
#include "tests/support/data.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

class ImageReaderTest : public ::testing::Test {
 protected:
  static std::string error_message(const fs::path& file) {
    return testing::refusal_text([&] { read_image(file, false); });
  }

  testing::ScratchFolder folder;
};

TEST_F(ImageReaderTest, FullScaleOfIntegersIsOne) {
  const std::vector<std::uint8_t> bytes{0, 51, 102, 255};
  write_png8_grey(bytes, 2, 2, folder / "a.png");
  const std::vector<std::uint16_t> words{0, 13107, 26214, 65535};
  write_png16_grey(words, 2, 2, folder / "b.png");
  for (const char* name : {"a.png", "b.png"}) {
    const GreyImage image = read_image(folder / name, false).planes[0];
    ASSERT_EQ(image.values.size(), 4u);
    EXPECT_EQ(image.width, 2);
    const double expected[] = {0.0, 0.2, 0.4, 1.0};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(image.values[i], expected[i]) << name;
  }
}

TEST_F(ImageReaderTest, FloatsStayAsTheyAre) {
  const std::vector<float> values{-3.5f, 0.0f, 1e-3f, 1200.0f, 7.0f, 8.0f};
  write_tiff_float(values, 3, 2, folder / "h.tif");
  const GreyImage image = read_image(folder / "h.tif", false).planes[0];
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(image.values[i], static_cast<double>(values[i]));
}

TEST_F(ImageReaderTest, AlphaIsIgnoredAndSaidWhereItHides) {
  const auto write_rgba = [&](const char* name, std::uint8_t alpha) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2;
    image.height = 1;
    image.format = PNG_FORMAT_RGBA;
    const std::uint8_t pixels[8] = {255, 255, 255, 255, 51, 51, 51, alpha};
    png_image_write_to_file(&image, (folder / name).c_str(), 0, pixels, 0, nullptr);
    return read_image(folder / name, false);
  };
  EXPECT_TRUE(write_rgba("opaque.png", 255).remarks.empty());
  const ImageFile half = write_rgba("half.png", 0);
  EXPECT_DOUBLE_EQ(half.planes[0].values[1], 0.2);
  ASSERT_EQ(half.remarks.size(), 1u);
  EXPECT_NE(half.remarks[0].find("50.0 %"), std::string::npos) << half.remarks[0];
}

TEST_F(ImageReaderTest, AnimationsAreSaid) {
  write_png8_grey(std::vector<std::uint8_t>{1, 2, 3, 4}, 2, 2, folder / "still.png");
  std::string bytes = testing::read_text(folder / "still.png");
  // An acTL chunk (8 bytes of data) between IHDR, which ends at byte 33, and IDAT.
  bytes.insert(33, std::string("\0\0\0\x08"
                               "acTL\0\0\0\x02\0\0\0\0\xf3\x8d\x93\x70",
                               20));
  const ImageFile file = read_image(folder.write("animated.png", bytes), false);
  ASSERT_EQ(file.remarks.size(), 1u);
  EXPECT_NE(file.remarks[0].find("first frame"), std::string::npos);
}

TEST_F(ImageReaderTest, ColoursComeAsPlanes) {
  write_png8_rgb({2, 1, {255, 0, 51, 0, 102, 0}}, folder / "c.png");
  const ImageFile color = read_image(folder / "c.png", true);
  ASSERT_EQ(color.planes.size(), 3u);
  EXPECT_DOUBLE_EQ(color.planes[0].values[0], 1.0);
  EXPECT_DOUBLE_EQ(color.planes[1].values[1], 0.4);
  EXPECT_DOUBLE_EQ(color.planes[2].values[0], 0.2);
  write_png8_grey(std::vector<std::uint8_t>{51, 255}, 2, 1, folder / "g.png");
  for (const GreyImage& plane : read_image(folder / "g.png", true).planes)
    EXPECT_DOUBLE_EQ(plane.values[0], 0.2);
}

TEST_F(ImageReaderTest, ColoursBecomeLuma) {
  write_png8_rgb({3, 1, {255, 0, 0, 0, 255, 0, 0, 0, 255}}, folder / "c.png");
  const ImageFile file = read_image(folder / "c.png", false);
  EXPECT_DOUBLE_EQ(file.planes[0].values[0], 0.2126);
  EXPECT_DOUBLE_EQ(file.planes[0].values[1], 0.7152);
  EXPECT_DOUBLE_EQ(file.planes[0].values[2], 0.0722);
  EXPECT_TRUE(file.remarks.empty());
}

TEST_F(ImageReaderTest, NamesTheFileAndTheRemedy) {
  EXPECT_NE(error_message(folder / "missing.png").find("missing.png: cannot be read"), std::string::npos);
  EXPECT_NE(error_message(folder.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(
      error_message(folder.write("text.png", "this is no picture, it is a line of text")).find("first bytes"),
      std::string::npos);
  EXPECT_NE(error_message(folder.write("empty.png", "")).find("is empty"), std::string::npos);
}

TEST_F(ImageReaderTest, DamagedFilesAreErrors) {
  std::vector<std::uint8_t> grey(64 * 64);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint8_t>(i * 37 % 251);
  write_png8_grey(grey, 64, 64, folder / "whole.png");
  const std::string bytes = testing::read_text(folder / "whole.png");
  EXPECT_NE(error_message(folder.write("cut.png", bytes.substr(0, 60))).find("cut.png"), std::string::npos);
  EXPECT_NE(error_message(folder.write("cut.jpg", std::string("\xff\xd8\xff\xe0\x00\x10JFIF", 10) +
                                                      std::string(30, 'x')))
                .find("cut.jpg"),
            std::string::npos);
  EXPECT_NE(
      error_message(folder.write("cut.tif", std::string("II*\0\xff\xff\xff\x7f", 8) + std::string(30, '\0')))
          .find("cut.tif"),
      std::string::npos);
}

TEST_F(ImageReaderTest, ADamagedPictureWithAlphaIsAnError) {
  std::string bytes(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x10\0\0\0\x10\x08\x06\0\0\0\x1f\xf3\xff\x61\0\0\0\x1dIDAT", 41);
  bytes.resize(80, '\x9c');
  EXPECT_NE(error_message(folder.write("alpha.png", bytes)).find("damaged"), std::string::npos);
}

// libpng prints about each of these files. What others print meanwhile is neither lost nor held back.
TEST_F(ImageReaderTest, DamagedFilesAreSilentInManyThreads) {
  write_png8_grey(std::vector<std::uint8_t>(64, 7), 8, 8, folder / "whole.png");
  std::string bytes = testing::read_text(folder / "whole.png");
  bytes[bytes.find("IDAT") + 6] ^= 1;
  const fs::path damaged = folder.write("damaged.png", bytes);
  struct stat before {
  }, after{};
  ASSERT_EQ(::fstat(STDERR_FILENO, &before), 0);
  std::FILE* const stream = stderr;
  ::testing::internal::CaptureStderr();
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int k = 0; k < 200; ++k) EXPECT_NE(error_message(damaged), "no error");
    });
  }
  std::string expected;
  for (int k = 0; k < 200; ++k) {
    ASSERT_EQ(::write(STDERR_FILENO, "line\n", 5), 5);
    expected += "line\n";
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), expected);
  ASSERT_EQ(::fstat(STDERR_FILENO, &after), 0);
  EXPECT_TRUE(before.st_dev == after.st_dev && before.st_ino == after.st_ino);
  EXPECT_EQ(stderr, stream);
}

// The header alone decides, and nothing is allocated for a refused size.
TEST_F(ImageReaderTest, HugeImagesAreRefusedBeforeDecoding) {
  write_png8_grey(std::vector<std::uint8_t>(4), 2, 2, folder / "huge.png");
  std::string bytes = testing::read_text(folder / "huge.png");
  bytes.replace(16, 8, std::string("\0\0\x4e\x20\0\0\x4e\x20", 8));
  const auto sum =
      static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + 12, 17));
  for (std::size_t k = 0; k < 4; ++k) bytes[29 + k] = static_cast<char>(sum >> (24 - 8 * k));
  const std::string error = error_message(folder.write("huge.png", bytes));
  EXPECT_NE(error.find("20000 x 20000"), std::string::npos) << error;
  EXPECT_NE(error.find("GB"), std::string::npos);
}

TEST_F(ImageReaderTest, ValuesThatAreNotFiniteAreMissing) {
  std::vector<float> values(40 * 40, 1.0f);
  values[3 * 40 + 7] = std::numeric_limits<float>::quiet_NaN();
  values[3 * 40 + 8] = std::numeric_limits<float>::infinity();
  write_tiff_float(values, 40, 40, folder / "nan.tif");
  const GreyImage image = read_image(folder / "nan.tif", false).planes[0];
  EXPECT_EQ(std::count(image.missing.begin(), image.missing.end(), true), 2);
  EXPECT_TRUE(image.missing[3 * 40 + 7]);
  EXPECT_EQ(image.values[3 * 40 + 7], 1.0);
}

TEST_F(ImageReaderTest, WebPIsRead) {
  std::vector<double> values;
  for (const double color : {204.0, 102.0, 51.0}) values.insert(values.end(), 50 * 40, color);
  for (const char* options : {"LOSSLESS=YES", "QUALITY=90"}) {
    const fs::path file =
        testing::write_raster(folder / "p.webp", {"WEBP", GDT_Byte, 50, 40, 3, {options}}, values);
    const ImageSize size = read_image_size(file);
    EXPECT_EQ(size.width, 50);
    EXPECT_EQ(size.height, 40);
    EXPECT_NEAR(read_image(file, true).planes[0].values[77], 0.8, 0.02);
  }
  std::string bytes = testing::read_text(folder / "p.webp");
  bytes.replace(12, 9, std::string("VP8X\x0a\0\0\0\x02", 9));
  EXPECT_NE(error_message(folder.write("moving.webp", bytes)), "no error");
}

class JpegTest : public ImageReaderTest {
 protected:
  // A ramp from black at the left.
  fs::path write(int bands, const std::function<void(GDALDataset&)>& describe = {}) {
    constexpr int kWidth = 480, kHeight = 320;
    std::vector<double> values;
    for (int i = 0; i < kWidth * kHeight * bands; ++i) values.push_back(0.5 * (i % kWidth));
    return testing::write_raster(folder / "p.jpg", {"JPEG", GDT_Byte, kWidth, kHeight, bands, {"QUALITY=95"}},
                                 values, describe);
  }
};

TEST_F(JpegTest, IsTurnedUpright) {
  const auto turn = [](GDALDataset& d) { d.SetMetadataItem("EXIF_Orientation", "6"); };
  const GreyImage image = read_image(write(1, turn), false).planes[0];
  ASSERT_EQ(image.width, 320);
  ASSERT_EQ(image.height, 480);
  EXPECT_NEAR(image.values.front(), 0.0, 0.05);
  EXPECT_NEAR(image.values.back(), 239.5 / 255.0, 0.05);
}

// Decoders fill the missing part with grey.
TEST_F(JpegTest, ThatIsCutIsAnError) {
  const std::string bytes = testing::read_text(write(3));
  EXPECT_EQ(error_message(folder.write("whole.jpg", bytes)), "no error");
  for (const std::size_t left : {bytes.size() - 2, bytes.size() - 60, bytes.size() / 2})
    EXPECT_NE(error_message(folder.write("cut.jpg", bytes.substr(0, left))), "no error") << left;
}

// The chunk tRNS.
TEST_F(ImageReaderTest, TransparentValuesHaveTheirColour) {
  const fs::path file =
      testing::write_raster(folder / "t.png", {"PNG", GDT_Byte, 2, 2, 1}, {51.0, 255.0, 102.0, 51.0},
                            [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(51.0); });
  const ImageFile read = read_image(file, false);
  EXPECT_DOUBLE_EQ(read.planes[0].values[0], 0.2);
  ASSERT_EQ(read.remarks.size(), 1u);
  EXPECT_NE(read.remarks[0].find("50.0 %"), std::string::npos) << read.remarks[0];
}

TEST_F(ImageReaderTest, ReadsARealPalette) {
  const fs::path file = testing::shared_texture("sand_height_cc0textures_1024.png");
  ASTROLITH_SKIP_WITHOUT(file);
  const GreyImage image = read_image(file, false).planes[0];
  EXPECT_EQ(image.values.size(),
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
}

}  // namespace
}  // namespace astrolith
