#include "geometry/ear_cutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/hash_random.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using Outline = std::vector<Vec3d>;

std::vector<Triangle> make_fan(std::size_t corners, std::uint32_t first = 0) {
  std::vector<Triangle> fan;
  const auto n = static_cast<std::uint32_t>(corners);
  for (std::uint32_t i = 2; i < n; ++i) fan.push_back({first, (first + i - 1) % n, (first + i) % n});
  return fan;
}

double covered(const std::vector<Triangle>& triangles, const Outline& outline) {
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles)
    sum += norm(cross(outline[b] - outline[a], outline[c] - outline[a])) / 2;
  return sum;
}

// Cuts the polygon from every corner on, and expects that the triangles cover the area.
void expect_covered(const Outline& outline, double area) {
  for (std::uint32_t first = 0; first < outline.size(); ++first) {
    std::vector<Triangle> triangles = make_fan(outline.size(), first);
    if (!fan_covers_polygon(triangles, outline)) cut_ears(triangles, outline);
    EXPECT_NEAR(covered(triangles, outline), area, 1e-9 * area) << first;
  }
}

TEST(EarCutter, LettersAndCombs) {
  expect_covered({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 5);  // an L
  expect_covered({{0, 0, 1}, {0, 0, 0}, {0, 4, 0}, {0, 4, 1}, {0, 2, 0.25}}, 2.5);        // upright, a notch
  Outline comb;
  for (int i = 0; i < 20; ++i) comb.insert(comb.end(), {{i + 0.0, 5, 0}, {i + 0.5, 0.5, 0}});
  comb.insert(comb.end(), {{20, 5, 0}, {20, 0, 0}, {0, 0, 0}});
  expect_covered(comb, 10.0 + 20 * 2.25);
}

TEST(EarCutter, ConvexPolygonsKeepTheirFan) {
  Outline circle;
  for (int i = 0; i < 50; ++i) {
    const double angle = 2 * std::numbers::pi * i / 50;
    circle.push_back({std::cos(angle), std::sin(angle), 0.1 * std::cos(angle)});
  }
  EXPECT_TRUE(fan_covers_polygon(make_fan(50), circle));
  const Outline corners_on_sides{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}};
  EXPECT_TRUE(fan_covers_polygon(make_fan(6, 1), corners_on_sides));
  expect_covered(corners_on_sides, 4);
}

// A square with a square hole, joined by a cut that is walked twice.
TEST(EarCutter, CutToAHole) {
  expect_covered({{0, 0, 0},
                  {4, 0, 0},
                  {4, 4, 0},
                  {0, 4, 0},
                  {0, 0, 0},
                  {1, 1, 0},
                  {1, 3, 0},
                  {3, 3, 0},
                  {3, 1, 0},
                  {1, 1, 0}},
                 12);
}

TEST(EarCutter, ManySpirals) {
  for (const int turns : {1, 3, 10}) {
    Outline spiral;
    const int n = 40 * turns;
    const auto at = [](double radius, int i) {
      const double angle = 2 * std::numbers::pi * i / 40;
      return Vec3d{radius * std::cos(angle), radius * std::sin(angle), 0.3 * radius * std::sin(angle)};
    };
    for (int i = 0; i <= n; ++i) spiral.push_back(at(1 + 0.05 * i, i));
    for (int i = n; i >= 0; --i) spiral.push_back(at(0.5 + 0.05 * i, i));
    Vec3d doubled;
    for (std::size_t i = 0; i < spiral.size(); ++i)
      doubled += cross(spiral[i], spiral[(i + 1) % spiral.size()]);
    std::vector<Triangle> triangles = make_fan(spiral.size());
    cut_ears(triangles, spiral);
    EXPECT_NEAR(covered(triangles, spiral), norm(doubled) / 2, 1e-9 * norm(doubled));
  }
}

// What crosses itself gets as many triangles, whose directed areas add up to the polygon's.
TEST(EarCutter, PolygonsThatCrossThemselvesGiveClosedBodies) {
  Outline star;
  for (std::uint32_t i = 0; i < 300; ++i)
    star.push_back({unit_float(hash_cell(1u, static_cast<int>(i), 0, 0)),
                    unit_float(hash_cell(1u, static_cast<int>(i), 1, 0)), 0});
  std::vector<Triangle> triangles = make_fan(star.size());
  cut_ears(triangles, star);
  Vec3d sum, doubled;
  for (const auto& [a, b, c] : triangles) sum += cross(star[b] - star[a], star[c] - star[a]);
  for (std::size_t i = 0; i < star.size(); ++i) doubled += cross(star[i], star[(i + 1) % star.size()]);
  EXPECT_NEAR(sum.z, doubled.z, 1e-9);
  std::vector<Triangle> flat = make_fan(5);
  cut_ears(flat, Outline(5));
  EXPECT_EQ(flat.size(), 3u);
}

// A prism over an L whose caps start at the corner that a fan leaves, in three formats.
class ConcaveCaps : public ::testing::Test {
 protected:
  static constexpr int kCorners[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  static std::string vertices(const std::string& keyword) {
    std::string text;
    for (const int z : {0, 1}) {
      for (const auto& [x, y] : kCorners)
        text += keyword + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
    return text;
  }
  // Each face begins with `keyword`, or with the number of its corners; indices count from `base`.
  static std::string faces(const std::string& keyword, int base) {
    std::string text;
    const auto add = [&](const std::vector<int>& corners) {
      text += keyword.empty() ? std::to_string(corners.size()) : keyword;
      for (const int k : corners) text += " " + std::to_string(k + base);
      text += "\n";
    };
    add({2, 1, 0, 5, 4, 3});
    add({9, 10, 11, 6, 7, 8});
    for (int i = 0; i < 6; ++i) add({i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i});
    return text;
  }
  void expect_prism(const std::string& name, const std::string& content) {
    const TriangleMesh mesh = read_mesh(folder_.write(name, content));
    EXPECT_NEAR(surface_area(mesh), 22, 1e-9) << name;
    EXPECT_NEAR(volume(mesh), 5, 1e-9) << name;
    EXPECT_TRUE(analyze_topology(mesh).closed && analyze_topology(mesh).oriented) << name;
  }
  testing::ScratchFolder folder_;
};

TEST_F(ConcaveCaps, ObjPlyOff) {
  expect_prism("a.obj", vertices("v ") + faces("f", 1));
  expect_prism("before.obj", faces("f", 1) + vertices("v "));
  expect_prism("a.off", "OFF\n12 8 18\n" + vertices("") + faces("", 0));
  expect_prism("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 8\nproperty list uchar int vertex_indices\nend_header\n" +
                   vertices("") + faces("", 0));
}

TEST_F(ConcaveCaps, CornersWithoutNumber) {
  const auto zigzag = [&](int corners) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      text += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " 0\n";
      face += " " + std::to_string(i + 1);
    }
    text += "v " + std::to_string(corners) + " -9 0\nv -1 -9 0\n";
    face += " " + std::to_string(corners + 1) + " " + std::to_string(corners + 2);
    return folder_.write("zigzag.obj", text + face + "\n");
  };
  EXPECT_EQ(read_mesh(zigzag(9998)).triangles.size(), 9998u);
  const std::string message = testing::refusal_text([&] { read_mesh(zigzag(50000)); });
  EXPECT_NE(message.find("a face of 50002 corners is not convex, which takes too long to cut; cut such"),
            message.npos)
      << message;
  std::ifstream in(zigzag(9998));
  std::string text(std::istreambuf_iterator<char>(in), {}), face = text.substr(text.find("f "));
  for (int i = 0; i < 10; ++i) text += face;
  const std::string many = testing::refusal_text([&] { read_mesh(folder_.write("many.obj", text)); });
  EXPECT_NE(many.find("takes too long with those before it; cut such"), many.npos) << many;
}

}  // namespace
}  // namespace astrolith
