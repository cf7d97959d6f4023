#include "synthesis/picture/camera.h"

#include <cmath>
#include <numbers>
#include <string>

#include "numerics/errors.h"
#include "synthesis/mesh/mesher.h"
#include "synthesis/picture/picture_maps.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

constexpr double kPerDegree = std::numbers::pi / 180.0;

TriangleMesh ball(double radius, const Vec3d& center) {
  MeshCollector collector;
  mesh_field(testing::AnalyticField([&](const Vec3d& p) { return radius - norm(p); }, 1.0),
             testing::cube_box(1.01 * radius), 32, collector);
  for (Vec3d& p : collector.mesh.vertices) p += center;
  return std::move(collector.mesh);
}

struct Pixel {
  double column, row;
};

// The pinhole equation, from the numbers that a user gives: no roll, +z up, a view of width x height pixels.
Pixel pinhole(const Vec3d& p, const Vec3d& eye, const Vec3d& target, double fov, int width, int height) {
  const Vec3d forward = normalized(target - eye), right = normalized(cross(forward, Vec3d{0, 0, 1}));
  const double depth = dot(p - eye, forward), focal = 0.5 * width / std::tan(0.5 * fov * kPerDegree);
  return {0.5 * width + focal * dot(p - eye, right) / depth,
          0.5 * height - focal * dot(p - eye, cross(right, forward)) / depth};
}

TEST(Camera, PinholeFollowsItsEquationAtEveryPixel) {
  const Vec3d center{10, -20, 5}, target{10.5, -20, 5};
  for (const double distance : {4.0, 40000.0}) {
    const double fov = distance < 10 ? 35.0 : 0.004;
    const Vec3d eye = target + distance * normalized(Vec3d{2, -1, 1});
    PreviewOptions options;
    options.width = 320, options.height = 200;
    const auto number = [](double x) { return std::to_string(x) + " "; };
    options.views = {parse_camera(
        "c", "at " + number(eye.x) + number(eye.y) + number(eye.z) + "target 10.5 -20 5 fov " + number(fov))};
    const PictureMaps maps = render_maps(ball(1.0, center), options);
    double worst = 0.0, off_sphere = 0.0;
    int shown = 0;
    for (int k = 0; k < 2000 && shown < 400; ++k) {
      const int x = k * 197 % 320, y = k * 131 % 200;
      if (!maps.shows_surface(static_cast<std::size_t>(320 * y + x))) continue;
      ++shown;
      const Vec3d p = maps.point(x, y);
      const Pixel seen = pinhole(
          p,
          options.views[0].target.value() + norm(options.views[0].from) * normalized(options.views[0].from),
          target, fov, 320, 200);
      worst = std::max({worst, std::fabs(seen.column - x - 0.5), std::fabs(seen.row - y - 0.5)});
      off_sphere = std::max(off_sphere, std::fabs(norm(p - center) - 1.0));
    }
    EXPECT_EQ(shown, 400);
    EXPECT_LT(worst, 1e-3) << "pixels";
    EXPECT_LT(off_sphere, 0.01) << "lengths, from the mesh's own error and single precision of depths";
  }
}

TEST(Camera, PinholesShowTheWholeMeshAndRollTurnsIt) {
  PreviewOptions options;
  options.width = options.height = 100;
  options.views = {parse_camera("c", "lat 30 lon 200 fov 60")};
  const auto shown = [&] {
    int pixels = 0;
    const PictureMaps maps = render_maps(ball(1.0, {0, 0, 0}), options);
    for (std::size_t i = 0; i < maps.depth.size(); ++i) pixels += maps.shows_surface(i) ? 1 : 0;
    return pixels;
  };
  EXPECT_NEAR(shown(), std::numbers::pi * 46 * 46, 300);
  const Camera turned = parse_camera("c", "from 1 0 0 roll 90");
  options.views = {turned};
  const PictureMaps maps = render_maps(ball(1.0, {0, 0, 0}), options);
  EXPECT_NEAR(maps.right[0].z, 1.0, 1e-12);  // +z, which was up, is to the right: the body turned clockwise
  EXPECT_NEAR(maps.up[0].y, -1.0, 1e-12);
}

TEST(Camera, WordsAreReadAndNonsenseIsRefused) {
  const Camera camera = parse_camera("c", "lat 90 lon 0 radii 3 fov 20");
  EXPECT_NEAR(camera.from.z, 1.0, 1e-12);
  EXPECT_EQ(camera.up.y, 1.0);
  EXPECT_TRUE(camera.in_radii);
  for (const char* words :
       {"lat", "lat x", "lat 91", "fov 0 radii 2", "fov 180", "distance 3", "distance 3 radii 2 fov 20",
        "at 1 0 0", "at 0 0 0 fov 20", "from 0 0 0", "lat 3 from 1 0 0", "zoom 3", "lat 1 lat 2",
        "up 1 0 0 from 2 0 0", "fov 20 distance -1", "lon nan", "lon 1e400"}) {
    EXPECT_THROW(parse_camera("--camera", words), InputError) << words;
  }
}

TEST(Camera, NoPinholeStandsInTheBody) {
  PreviewOptions options;
  options.views = {parse_camera("c", "lat 0 lon 0 fov 40 radii .5")};
  EXPECT_THROW(render_maps(ball(1.0, {0, 0, 0}), options), InputError);
}

}  // namespace
}  // namespace astrolith
