#include <string>
#include <utility>
#include <vector>

#include "estimation/shape/report/fit_plots.h"
#include "numerics/errors.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

// Bytes 16 to 23 of a PNG hold its width and its height, big-endian.
std::pair<int, int> png_size(const std::filesystem::path& file) {
  const std::string png = testing::read_text(file);
  int size[2] = {};
  for (std::size_t i = 0; i < 8; ++i) {
    size[i / 4] = size[i / 4] << 8 | static_cast<unsigned char>(png.at(16 + i));
  }
  return {size[0], size[1]};
}

RgbImage dark_image(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), 10)};
}

TEST(CaptionedPictures, KeepEveryPixelBelowTheirCaptions) {
  const testing::ScratchFolder folder;
  write_captioned_pictures({{dark_image(300, 200), "left"}, {dark_image(250, 200), "right"}},
                           folder / "two.png");
  EXPECT_EQ(png_size(folder / "two.png").first, 550);
  EXPECT_GT(png_size(folder / "two.png").second, 200);
}

TEST(CaptionedPictures, RefuseFilesThatCannotBeWritten) {
  const testing::ScratchFolder folder;
  EXPECT_THROW(
      write_picture_with_scale({dark_image(400, 100), "map"}, {"0", "1 %"}, folder / "no" / "map.png"),
      InputError);
}

TEST(ConvergencePlot, DrawsOnePoint) {
  const testing::ScratchFolder folder;
  ConvergencePoint only;
  only.spheres = 5;
  write_convergence_plot({&only, 1}, folder / "convergence.png");
  EXPECT_EQ(png_size(folder / "convergence.png"), std::pair(1600, 1000));
}

TEST(ErrorHistogram, DrawsDistancesBeyondItsLimits) {
  const testing::ScratchFolder folder;
  const std::vector<double> distances{-1.0, -1e-3, 0.0, 1e-3, 1.0};
  write_error_histogram(distances, 1e-3, folder / "histogram.png");
  write_error_histogram(distances, 1e-9, folder / "narrow.png");
  EXPECT_EQ(png_size(folder / "histogram.png"), std::pair(1600, 1000));
  EXPECT_EQ(png_size(folder / "narrow.png"), std::pair(1600, 1000));
}

}  // namespace
}  // namespace astrolith
