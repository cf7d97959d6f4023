#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/srgb.h"
#include "synthesis/mesh/mesher.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/picture_marks.h"
#include "synthesis/picture/preview.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

using testing::AnalyticField;
using testing::cube_box;

TriangleMesh sphere_mesh() {
  MeshCollector collector;
  mesh_field(AnalyticField([](const Vec3d& p) { return 1.0 - norm(p); }, 1.0), cube_box(1.0), 40, collector);
  return std::move(collector.mesh);
}

PreviewOptions one_view() {
  PreviewOptions options;
  options.width = options.height = 64;
  options.views = {{{1, 0, 0}, {0, 0, 1}}};
  return options;
}

int grey(const RgbImage& image, int x, int y) {
  return image.pixels[3 * static_cast<std::size_t>(y * image.width + x)];
}

TEST(Preview, SphereIsLitFromTheSunAndDarkBehind) {
  PreviewOptions options = one_view();
  options.sun.direction = {-1, 0, 0.2};
  options.ambient = 0.0;
  const RgbImage image = render_preview(sphere_mesh(), options);
  EXPECT_GT(grey(image, 10, 32), 150);  // the side of the sun
  EXPECT_EQ(grey(image, 50, 32), 0);    // night
  EXPECT_EQ(grey(image, 1, 1), grey(image, 62, 62));
  EXPECT_LT(grey(image, 1, 1), 20);  // background
}

TEST(MapProjection, FindsPlacesAgainAndKeepsAreas) {
  for (const MapProjection map : {MapProjection::kEquirectangular, MapProjection::kHemisphere}) {
    for (double y = -0.95; y < 1.0; y += 0.1) {
      for (double x = -map_width(map) + 0.05; x < map_width(map); x += 0.1) {
        const auto direction = map_direction(map, x, y);
        ASSERT_EQ(direction.has_value(), map == MapProjection::kEquirectangular || x * x + y * y <= 1.0);
        if (!direction) continue;
        EXPECT_NEAR(norm(*direction), 1.0, 1e-12);
        const auto place = map_place(map, *direction);
        ASSERT_TRUE(place.has_value());
        EXPECT_NEAR(place->first, x, 1e-9);
        EXPECT_NEAR(place->second, y, 1e-9);
      }
    }
  }
  // Half of the hemisphere's area, the cap within 60 degrees, has half of the map's.
  const auto place = map_place(MapProjection::kHemisphere, {0.5, std::sqrt(0.75), 0.0});
  EXPECT_NEAR(place->first, std::sqrt(0.5), 1e-12);
  EXPECT_FALSE(map_place(MapProjection::kHemisphere, {-0.1, 1.0, 0.0}).has_value());
}

// Longitude runs to the right and latitude up, about the meridian of +x.
TEST(Preview, MapsShowDirectionsFromTheOrigin) {
  const TriangleMesh mesh = sphere_mesh();
  PreviewOptions options;
  options.width = 128, options.height = 64;
  options.views = map_views(MapProjection::kEquirectangular);
  options.colors_are_values = true;
  for (const Vec3d& p : mesh.vertices)
    options.vertex_colors.push_back(
        {p.y > 0.3 ? 1.0f : 0.0f, p.z > 0.3 ? 1.0f : 0.0f, p.x > 0.3 ? 1.0f : 0.0f});
  const RgbImage image = render_preview(mesh, options);
  const auto at = [&](int x, int y) {
    const std::uint8_t* p = &image.pixels[3 * static_cast<std::size_t>(y * image.width + x)];
    return std::array{p[0] > 128, p[1] > 128, p[2] > 128};
  };
  EXPECT_EQ(at(64, 32), (std::array{false, false, true}));   // 0 degrees
  EXPECT_EQ(at(90, 32), (std::array{true, false, false}));   // 90 degrees east
  EXPECT_EQ(at(38, 32), (std::array{false, false, false}));  // 90 degrees west
  EXPECT_EQ(at(64, 8), (std::array{false, true, false}));    // near the north pole
  options.views = map_views(MapProjection::kHemisphere);
  ASSERT_EQ(options.views.size(), 2u);
  TriangleMesh far = mesh;
  for (Vec3d& p : far.vertices) p.x += 5.0;
  options.vertex_colors.clear();
  EXPECT_THROW(render_preview(far, options), InputError);
  // An origin beside the surface, but within the ball about it, is no ground that is seen from behind.
  TriangleMesh near = mesh;
  for (Vec3d& p : near.vertices) p = {p.x + 0.8, 0.2 * p.y + 0.4, 0.2 * p.z};
  options.views = map_views(MapProjection::kEquirectangular);
  const RgbImage partly = render_preview(near, options);
  EXPECT_LT(grey(partly, 40, 40), 20);
}

// Where colours stand for numbers, the dark side has nearly the colour of the bar.
TEST(Preview, ColoursOfValuesAreNotShaded) {
  PreviewOptions options = one_view();
  options.sun.direction = {-1, 0, 0.2};
  const TriangleMesh mesh = sphere_mesh();
  options.vertex_colors.assign(mesh.vertices.size(), {0.5f, 0.5f, 0.5f});
  options.colors_are_values = true;
  const RgbImage image = render_preview(mesh, options);
  const int shown = srgb_byte(0.5f);
  EXPECT_GT(grey(image, 45, 32), 0.9 * shown);
  EXPECT_LE(grey(image, 20, 32), shown);
}

// A patch of ground that faces +x: it is seen from there, and its shadows fall on ground that faces the
// viewer.
TEST(Preview, PatchesAreSeenFromAboveTheirGround) {
  EXPECT_EQ(usual_views(sphere_mesh()).size(), standard_views().size());
  const TriangleMesh patch{{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0.1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  const std::vector<Camera> views = usual_views(patch);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_GT(normalized(views[0].from).x, 0.99);
  EXPECT_GT(normalized(views[1].from).x, 0.6);
  EXPECT_LT(normalized(views[1].from).z, -0.6);
  EXPECT_GT(dot(views[1].up, views[0].from), 0.99);
}

TEST(Preview, DiskHasTheAreaOfTheSphere) {
  PreviewOptions options = one_view();
  options.sun.direction = {0, 0, 1};
  options.width = options.height = 200;
  const RgbImage image = render_preview(sphere_mesh(), options);
  int lit = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) lit += grey(image, x, y) > 60 ? 1 : 0;
  }
  EXPECT_NEAR(lit, 3.14159 * 92 * 92, 0.01 * 3.14159 * 92 * 92);  // 92 % of the picture's side
}

TEST(Preview, BodiesCastShadows) {
  // A small sphere between the sun (left) and a large one.
  const auto two = [](const Vec3d& p) { return std::max(0.5 - norm(p), 0.2 - norm(p - Vec3d{0, -0.8, 0})); };
  MeshCollector collector;
  mesh_field(AnalyticField(two, 1.0), cube_box(1.01), 64, collector);
  PreviewOptions options = one_view();
  options.width = options.height = 256;
  options.sun.direction = {-1, 0, 0};
  options.ambient = 0.0;
  const RgbImage image = render_preview(collector.mesh, options);
  // The picture spans y = -1 .. 0.5 over 92 % of its side.
  const auto pixel = [](double y, double z) {
    const double scale = 0.92 * 256 / 1.5;
    return std::array{static_cast<int>(128 + (y + 0.25) * scale), static_cast<int>(128 - z * scale)};
  };
  const auto [lit_x, lit_y] = pixel(-0.85, 0.0);
  EXPECT_GT(grey(image, lit_x, lit_y), 100);
  const auto [dark_x, dark_y] = pixel(-0.475, 0.0);
  EXPECT_EQ(grey(image, dark_x, dark_y), 0) << "in the shadow of the small sphere";
  const auto [above_x, above_y] = pixel(-0.3, 0.3);
  EXPECT_GT(grey(image, above_x, above_y), 100) << "above the shadow";
}

TEST(Preview, SamePixelsForAnyThreadsAndOtherPixelsForAnotherSeed) {
  const TriangleMesh mesh = sphere_mesh();
  PreviewOptions options = one_view();
  const RgbImage reference = render_preview(mesh, options);
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(render_preview(mesh, options).pixels, reference.pixels);
  }
  options.seed = 2;
  EXPECT_NE(render_preview(mesh, options).pixels, reference.pixels);
}

TEST(Preview, AnyUnitAndPlaceGivesNearlyTheSamePicture) {
  TriangleMesh mesh = sphere_mesh();
  const RgbImage reference = render_preview(mesh, one_view());
  for (Vec3d& p : mesh.vertices) p = 1e7 * p + Vec3d{1e8, -1e8, 1e8};
  const RgbImage moved = render_preview(mesh, one_view());
  int different = 0;
  for (std::size_t i = 0; i < moved.pixels.size(); ++i) {
    different += std::abs(int(moved.pixels[i]) - int(reference.pixels[i])) > 12 ? 1 : 0;
  }
  EXPECT_LT(different, 30);
}

TEST(Preview, ColoursOfVerticesShow) {
  const TriangleMesh mesh = sphere_mesh();
  PreviewOptions options = one_view();
  options.sun.direction = {0, 0, 1};
  options.vertex_colors.assign(mesh.vertices.size(), {0.8f, 0.1f, 0.0f});
  const RgbImage image = render_preview(mesh, options);
  const std::size_t center = 3 * (32 * 64 + 32);
  EXPECT_GT(image.pixels[center], image.pixels[center + 1] + 60);
  EXPECT_GT(image.pixels[center + 1], image.pixels[center + 2]);
}

TEST(Preview, TransparentPicturesHaveCoverage) {
  PreviewOptions options = one_view();
  options.transparent = true;
  const RgbaImage16 image = render_picture(sphere_mesh(), options).image;
  const auto alpha = [&](std::size_t x, std::size_t y) { return image.pixels[4 * (64 * y + x) + 3]; };
  EXPECT_EQ(alpha(1, 1), 0);
  EXPECT_EQ(alpha(32, 32), 65535);
  double covered = 0.0;
  for (std::size_t y = 0; y < 64; ++y) {
    for (std::size_t x = 0; x < 64; ++x) covered += alpha(x, y) / 65535.0;
  }
  const double radius = 0.46 * 64;
  EXPECT_NEAR(covered, 3.14159 * radius * radius, 0.003 * 64 * 64);
}

TEST(Preview, LambertAndLommelSeeligerFollowTheirFormulas) {
  PreviewOptions options = one_view();
  options.ambient = 0.0;
  options.sun = sun_at_phase(60.0, 90.0);  // from the left
  options.vertex_colors.assign(sphere_mesh().vertices.size(), {0.5f, 0.5f, 0.5f});
  const auto middle = [&](const char* law) {
    options.reflectance = parse_reflectance("law", law);
    return srgb_to_linear(render_picture(sphere_mesh(), options).image.pixels[4 * (64 * 32 + 32)] / 65535.0);
  };
  EXPECT_NEAR(middle("lambert"), 0.5 * 0.5, 0.01);
  EXPECT_NEAR(middle("lommel-seeliger"), 0.5 * 2 * 0.5 / 1.5, 0.01);
}

TEST(Preview, BadMeshesAndOptionsAreInputErrors) {
  const TriangleMesh mesh = sphere_mesh();
  EXPECT_THROW(render_preview(TriangleMesh{}), InputError);
  TriangleMesh broken = mesh;
  broken.triangles[5][1] = 1u << 30;
  EXPECT_THROW(render_preview(broken), InputError);
  broken = mesh;
  broken.vertices[7].y = std::nan("");
  EXPECT_THROW(render_preview(broken), InputError);
  PreviewOptions options = one_view();
  options.width = 0;
  EXPECT_THROW(render_preview(mesh, options), InputError);
  options = one_view();
  options.views = {{{0, 0, 1}, {0, 0, 1}}};
  EXPECT_THROW(render_preview(mesh, options), InputError);
  options = one_view();
  options.vertex_colors.resize(3);
  EXPECT_THROW(render_preview(mesh, options), InputError);
  EXPECT_THROW(render_preview(mesh, one_view(), [](double, std::string_view) { return false; }), WorkError);
}

TEST(Colormap, GetsLighterAllTheWayAndStaysInGamut) {
  double last = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const Vec3<float> c = sequential_color(i / 100.0);
    const double luminance = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    EXPECT_GT(luminance, last);
    last = luminance;
    EXPECT_GE(std::min({c.x, c.y, c.z}), 0.0f);
    EXPECT_LE(std::max({c.x, c.y, c.z}), 1.0f);
  }
  EXPECT_EQ(sequential_colors(std::vector<double>{-5.0, 99.0}, 0.0, 1.0)[1], sequential_color(1.0));
}

TriangleMesh diamond() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
          {}};
}

TEST(PictureMarks, TitlesHaveQuantityAndUnit) {
  EXPECT_EQ(column_title("slope_deg"), "slope [deg]");
  EXPECT_EQ(column_title("effective_gravity_m_s2"), "effective gravity [m/s2]");
  EXPECT_EQ(column_title("geopotential_J_kg"), "geopotential [J/kg]");
  EXPECT_EQ(column_title("crater_age"), "crater age");
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
Vec3d change_middle(const RgbaImage16& a, const RgbaImage16& b) {
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
    const RgbaImage16 without = render_picture(mesh, options).marked();
    options.marks.labels = {{mesh.vertices[4], "9"}};
    return change_middle(render_picture(mesh, options).marked(), without);
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
    const std::vector<std::uint16_t> without = render_picture(mesh, options).marked().pixels;
    options.marks.labels = {{mesh.vertices[5], "9"}};
    EXPECT_TRUE(render_picture(mesh, options).marked().pixels == without) << camera;
    options.marks.labels = {{mesh.vertices[4], "9"}};
    EXPECT_FALSE(render_picture(mesh, options).marked().pixels == without) << camera;
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
  const RgbaImage16 without = render_picture(mesh, plain).marked(),
                    with = render_picture(mesh, marked).marked();
  ASSERT_GT(with.pixels.size(), without.pixels.size());
  EXPECT_TRUE(std::equal(without.pixels.begin(), without.pixels.end(), with.pixels.begin()));
  const auto bright = [&](const RgbaImage16& image) {
    return std::count_if(image.pixels.begin() + static_cast<std::ptrdiff_t>(without.pixels.size()),
                         image.pixels.end(), [](std::uint16_t v) { return v > 58000 && v < 65535; });
  };
  EXPECT_GT(bright(with), 300) << "bars and letters";

  marked.marks.axes = true;
  const RgbaImage16 axes = render_picture(mesh, marked).marked();
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
