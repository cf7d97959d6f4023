#include "synthesis/picture/picture_marks.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "synthesis/picture/preview.h"

namespace astrolith {
namespace {

TriangleMesh diamond() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
          {}};
}

TEST(PictureMarks, TitlesHaveQuantityAndUnit) {
  EXPECT_EQ(title_of_column("slope_deg"), "slope [deg]");
  EXPECT_EQ(title_of_column("effective_gravity_m_s2"), "effective gravity [m/s2]");
  EXPECT_EQ(title_of_column("geopotential_J_kg"), "geopotential [J/kg]");
  EXPECT_EQ(title_of_column("crater_age"), "crater age");
}

TEST(PictureMarks, RangesAreThePercentilesOfFiniteValues) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(i);
  values.push_back(std::numeric_limits<double>::quiet_NaN());
  const ValueRange range = value_range(values);
  EXPECT_NEAR(range.low, 10, 1);
  EXPECT_NEAR(range.high, 990, 1);
  EXPECT_EQ(range.most, 1000);
  EXPECT_LT(value_range(std::vector<double>{3, 3}).low, value_range(std::vector<double>{3, 3}).high);
  EXPECT_LT(value_range({}).low, value_range({}).high);
}

// The middle of the pixels in which two pictures of one size differ, from the upper left corner.
Vec3d middle_of_changes(const RgbaImage16& a, const RgbaImage16& b) {
  Vec3d sum;
  double count = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
    if (a.pixels[i] == b.pixels[i]) continue;
    const auto pixel = static_cast<int>(i / 4);
    sum += Vec3d{double(pixel % a.width), double(pixel / a.width), 0.0};
    count += 1.0;
  }
  return (1.0 / count) * sum;
}

// A label stands to the upper right of its place, which moves against the target of the camera.
TEST(PictureMarks, LabelsFollowTheirPlaces) {
  const TriangleMesh mesh = diamond();
  PreviewOptions options;
  options.width = 200, options.height = 200;
  const auto middle = [&](const char* camera) {
    options.views = {parse_camera("--camera", camera)};
    options.marks.labels.clear();
    const RgbaImage16 without = render_picture(mesh, options).image;
    options.marks.labels = {{mesh.vertices[4], "9"}};
    return middle_of_changes(render_picture(mesh, options).image, without);
  };
  for (const std::string kind : {"", " fov 20"}) {
    const std::string above = "from 0 0 1 up 0 1 0" + kind;
    const Vec3d here = middle(above.c_str()), left = middle((above + " target .3 0 0").c_str()),
                below = middle((above + " target 0 .3 0").c_str());
    EXPECT_NEAR(here.x, 107.0, 6.0) << kind;
    EXPECT_NEAR(here.y, 92.0, 6.0) << kind;
    EXPECT_LT(left.x, here.x - 10.0) << kind;
    EXPECT_NEAR(left.y, here.y, 2.0) << kind;
    EXPECT_GT(below.y, here.y + 10.0) << kind;
    EXPECT_NEAR(below.x, here.x, 2.0) << kind;
  }
}

// The tops of the diamond from above: the upper one is seen, the lower one is hidden by the body.
TEST(PictureMarks, LabelsStandBesidePlacesThatAreSeen) {
  const TriangleMesh mesh = diamond();
  PreviewOptions options;
  options.width = 200, options.height = 200;
  for (const char* camera :
       {"from 0 0 1 up 0 1 0", "lat 90 fov 30", "from 0 0 1 up 0 1 0 fov 20 target 1 0 0"}) {
    options.views = {parse_camera("--camera", camera)};
    const std::vector<std::uint16_t> without = render_picture(mesh, options).image.pixels;
    options.marks.labels = {{mesh.vertices[5], "9"}};
    EXPECT_TRUE(render_picture(mesh, options).image.pixels == without) << camera;
    options.marks.labels = {{mesh.vertices[4], "9"}};
    EXPECT_FALSE(render_picture(mesh, options).image.pixels == without) << camera;
    options.marks.labels.clear();
  }
}

// The rows above the strip of a picture with marks are the picture of that many rows without.
TEST(PictureMarks, StandBelowTheViewsAndInEmptyCorners) {
  const TriangleMesh mesh = diamond();
  PreviewOptions plain;
  plain.width = 400, plain.height = 300;
  PreviewOptions marked = plain;
  marked.marks.values = {0.0, 1.0, "slope [deg]"};
  marked.marks.length_unit = "m";
  const int strip = marks_height(marked);
  ASSERT_GT(strip, 0);
  plain.height -= strip;
  const RgbaImage16 without = render_picture(mesh, plain).image, with = render_picture(mesh, marked).image;
  ASSERT_GT(with.pixels.size(), without.pixels.size());
  EXPECT_TRUE(std::equal(without.pixels.begin(), without.pixels.end(), with.pixels.begin()));
  const auto bright = [&](const RgbaImage16& image) {
    return std::count_if(image.pixels.begin() + static_cast<std::ptrdiff_t>(without.pixels.size()),
                         image.pixels.end(), [](std::uint16_t v) { return v > 58000 && v < 65535; });
  };
  EXPECT_GT(bright(with), 300) << "bars and letters";

  marked.marks.axes = true;
  const RgbaImage16 axes = render_picture(mesh, marked).image;
  int changed = 0, over_body = 0;
  for (std::size_t i = 0; i < without.pixels.size(); i += 4) {
    if (axes.pixels[i] == with.pixels[i] && axes.pixels[i + 2] == with.pixels[i + 2]) continue;
    ++changed;
    over_body += with.pixels[i] == with.pixels[0] ? 0 : 1;
  }
  EXPECT_GT(changed, 100);
  EXPECT_EQ(over_body, 0);
  marked.marks.values.reset();
  marked.views = {parse_camera("--camera", "lat 10 fov 30")};
  EXPECT_EQ(marks_height(marked), 0) << "a pinhole has no scale";
  marked.marks.values = {0.0, 1.0, "slope [deg]"};
  EXPECT_EQ(marks_height(marked), strip);
  marked.width = marked.height = 100;
  EXPECT_EQ(marks_height(marked), 0);
}

}  // namespace
}  // namespace astrolith
