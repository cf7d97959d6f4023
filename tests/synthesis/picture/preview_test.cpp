#include "synthesis/picture/preview.h"

#include <array>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/srgb.h"
#include "synthesis/mesh/mesher.h"
#include "synthesis/picture/colormap.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

using testing::AnalyticField;
using testing::cube;

TriangleMesh sphere_mesh() {
  MeshCollector collector;
  mesh_field(AnalyticField([](const Vec3d& p) { return 1.0 - norm(p); }, 1.0), cube(1.0), 40, collector);
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
  mesh_field(AnalyticField(two, 1.0), cube(1.01), 64, collector);
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
  const auto middle = [&](double lunar_share) {
    options.lunar_share = lunar_share;
    return linear_of_srgb(render_picture(sphere_mesh(), options).image.pixels[4 * (64 * 32 + 32)] / 65535.0);
  };
  EXPECT_NEAR(middle(kLambert), 0.5 * 0.5, 0.01);
  EXPECT_NEAR(middle(kLommelSeeliger), 0.5 * 2 * 0.5 / 1.5, 0.01);
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

}  // namespace
}  // namespace astrolith
