#include "tasks/repair/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"

namespace astrolith {
namespace {

using testing::has;
using testing::icosphere;
using testing::joined;

// A ball with bumps, 1,280 facets.
TriangleMesh bumpy() {
  TriangleMesh mesh = icosphere(3);
  for (Vec3d& p : mesh.vertices) p *= 1.0 + 0.1 * std::sin(4.0 * p.x) * std::sin(3.0 * p.y + 1.0);
  return mesh;
}

// Without the facets whose middle lies above this height of the unit ball.
TriangleMesh without_cap(double height) {
  TriangleMesh mesh = bumpy();
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return normalized(mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).z > height;
  });
  return mesh;
}

MeshRepair repaired(const TriangleMesh& mesh, const RepairOptions& options = {}) {
  return repair_mesh(mesh, "body.obj", options);
}

// A repair gives one closed body of genus 0 whose volume is near that of the clean one.
void expect_body(const MeshRepair& repair, double volume_share = 1e-3) {
  EXPECT_TRUE(repair.changed);
  const MeshTopology topology = analyze_topology(repair.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_NEAR(volume(repair.mesh) / volume(bumpy()), 1.0, volume_share);
  EXPECT_LE(repair.moved, kMostMoved * repair.diagonal);
}

std::string refusal(const TriangleMesh& mesh, const RepairOptions& options = {}) {
  return testing::refusal_text([&] { repaired(mesh, options); });
}

TEST(MeshRepair, LeavesAClosedBodyAsItIs) {
  const TriangleMesh body = bumpy();
  const MeshRepair repair = repaired(body);
  EXPECT_FALSE(repair.changed);
  EXPECT_TRUE(repair.mesh.vertices == body.vertices);
  EXPECT_EQ(repair.mesh.triangles, body.triangles);
  EXPECT_EQ(repair_words(repair, "km"), "");
}

// Every second vertex of the seam is there twice, once moved by a hundredth of an edge.
TEST(MeshRepair, StitchesACrack) {
  TriangleMesh body = bumpy();
  std::set<std::uint32_t> below;
  for (const Triangle& t : body.triangles) {
    const double z = body.vertices[t[0]].z + body.vertices[t[1]].z + body.vertices[t[2]].z;
    if (z < 1.5) below.insert(t.begin(), t.end());
  }
  std::vector<std::uint32_t> twin(body.vertices.size(), 0);
  for (Triangle& t : body.triangles) {
    const double z = body.vertices[t[0]].z + body.vertices[t[1]].z + body.vertices[t[2]].z;
    if (z < 1.5) continue;
    for (std::uint32_t& v : t) {
      if (!below.contains(v)) continue;
      if (twin[v] == 0) {
        twin[v] = static_cast<std::uint32_t>(body.vertices.size());
        const Vec3d p = body.vertices[v];
        body.vertices.push_back(p + Vec3d{0, 0, 0.001});
      }
      v = twin[v];
    }
  }
  const MeshRepair repair = repaired(body);
  expect_body(repair);
  EXPECT_GT(repair.stitched_edges, 20);
  EXPECT_EQ(repair.holes, 0);
  EXPECT_NEAR(repair.moved, 0.001, 1e-9);
  EXPECT_TRUE(has(repair_words(repair, "km"), "stitched"));
}

TEST(MeshRepair, TurnsFacets) {
  TriangleMesh one = bumpy();
  std::swap(one.triangles[7][1], one.triangles[7][2]);
  const MeshRepair repair = repaired(one);
  expect_body(repair, 1e-12);
  EXPECT_EQ(repair.turned_facets, 1);
  const MeshRepair all = repaired(testing::reversed(bumpy()));
  expect_body(all, 1e-12);
  EXPECT_EQ(all.turned_facets, 1280);
}

TEST(MeshRepair, TurnsTheBodyThatIsInsideOutAlone) {
  TriangleMesh scene = testing::joined(bumpy(), testing::reversed(testing::icosphere(2, 0.5, {4, 0, 0})));
  RepairOptions all;
  all.all_parts = true;
  const MeshRepair repair = repaired(scene, all);
  EXPECT_EQ(repair.turned_facets, 320);
  EXPECT_NEAR(volume(repair.mesh), volume(bumpy()) + volume(testing::icosphere(2, 0.5)), 1e-9);
}

TEST(MeshRepair, KeepsCavities) {
  const TriangleMesh hollow =
      testing::joined(testing::icosphere(3), testing::reversed(testing::icosphere(2, 0.5)));
  const double rock = volume(testing::icosphere(3)) - volume(testing::icosphere(2, 0.5));
  EXPECT_FALSE(repaired(hollow).changed);
  EXPECT_EQ(repaired(hollow).cavities, 1);
  EXPECT_NEAR(volume(repaired(testing::reversed(hollow)).mesh), rock, 1e-9);
  TriangleMesh tenth = hollow;
  for (std::size_t f = 0; f < tenth.triangles.size(); f += 10) {
    std::swap(tenth.triangles[f][1], tenth.triangles[f][2]);
  }
  EXPECT_NEAR(volume(repaired(tenth).mesh), rock, 1e-9);
}

// Two balls whose centres are `apart` share a lens; the meshes are fine enough for 1e-3.
TEST(MeshRepair, UnitesPartsThatOverlapOrLieInOneAnother) {
  const TriangleMesh pair = testing::two_spheres(4, 1.0, 1.0);
  EXPECT_EQ(repaired(pair).overlapping_parts, 1);
  EXPECT_TRUE(has(repair_words(repaired(pair), ""), "counts twice"));
  RepairOptions unite;
  unite.unite = true;
  const MeshRepair repair = repaired(pair, unite);
  EXPECT_TRUE(repair.united && is_closed_body(repair.mesh));
  const double d = 1.0, ball = 4.0 / 3.0 * std::numbers::pi;
  const double lens = std::numbers::pi * (4.0 + d) * (2.0 - d) * (2.0 - d) / 12.0;
  EXPECT_NEAR(volume(repair.mesh), 2.0 * ball - lens, 0.02);
  EXPECT_EQ(analyze_topology(repair.mesh).components, 1);

  const TriangleMesh core = testing::joined(testing::icosphere(3), testing::icosphere(2, 0.5));
  EXPECT_EQ(repaired(core).nested_parts, 1);
  EXPECT_NEAR(volume(repaired(core, unite).mesh), volume(testing::icosphere(3)), 1e-12);
}

// A cube reaches half into another: volume and area are known exactly, faces partly coincide.
TEST(MeshRepair, UnitesCubesWithFacesInCommonPlanes) {
  const TriangleMesh cubes = testing::joined(testing::cube(1.0), testing::cube(1.0, {0.5, 0.0, 0.0}));
  RepairOptions unite;
  unite.unite = true;
  const MeshRepair repair = repaired(cubes, unite);
  EXPECT_NEAR(volume(repair.mesh), 1.5, 1e-15);
  EXPECT_NEAR(surface_area(repair.mesh), 8.0, 1e-15);
}

// Two bars cross; neither has a corner inside the other.
TEST(MeshRepair, UnitesBarsThatCross) {
  const auto bar = [](const Vec3d& extent) {
    TriangleMesh mesh = testing::cube(1.0, {-0.5, -0.5, -0.5});
    for (Vec3d& p : mesh.vertices) p = {p.x * extent.x, p.y * extent.y, p.z * extent.z};
    return mesh;
  };
  RepairOptions unite;
  unite.unite = true;
  const MeshRepair repair = repaired(testing::joined(bar({4, 1, 1}), bar({1, 4, 1})), unite);
  EXPECT_NEAR(volume(repair.mesh), 7.0, 1e-14);
  EXPECT_NEAR(surface_area(repair.mesh), 30.0, 1e-14);
}

// A cube reaches into the cavity of another one, and fills a part of it.
TEST(MeshRepair, UnitingKeepsASolidThatReachesIntoACavity) {
  const auto cube = [](double side, double x) {
    TriangleMesh mesh = testing::cube(side, {-0.5 * side, -0.5 * side, -0.5 * side});
    for (Vec3d& p : mesh.vertices) p.x += x;
    return mesh;
  };
  const TriangleMesh hollow = testing::joined(cube(10.0, 0.0), testing::reversed(cube(3.0, 0.0)));
  RepairOptions unite;
  unite.unite = true;
  const MeshRepair repair = repaired(testing::joined(hollow, cube(5.0, 3.0)), unite);
  EXPECT_TRUE(repair.united);
  // The cavity of 27 is filled from x = 0.5 to 1.5; the cube of 125 reaches half a unit out of the large one.
  EXPECT_NEAR(volume(repair.mesh), 1000.0 - 27.0 + 9.0 + 12.5, 1e-9);
}

TEST(MeshRepair, ARockInACavityCountsOnce) {
  const TriangleMesh geode =
      testing::joined(testing::joined(testing::icosphere(3), testing::reversed(testing::icosphere(3, 0.6))),
                      testing::icosphere(2, 0.2));
  RepairOptions unite;
  unite.unite = true;
  const MeshRepair repair = repaired(geode, unite);
  EXPECT_EQ(repair.nested_parts + repair.overlapping_parts, 0);
  EXPECT_FALSE(repair.united);
}

TEST(MeshRepair, SurfacesThatStayOpenAreWoundAlike) {
  TriangleMesh patch = without_cap(0.2);
  const MeshRepair good = mend_surface(patch, "patch.obj", {});
  EXPECT_FALSE(good.changed);
  TriangleMesh turned = patch;
  for (std::size_t f = 0; f < turned.triangles.size(); f += 7) {
    std::swap(turned.triangles[f][1], turned.triangles[f][2]);
  }
  const MeshRepair repair = mend_surface(turned, "patch.obj", {});
  EXPECT_TRUE(repair.mesh.triangles == patch.triangles);
}

TEST(MeshRepair, DropsDoubledFacets) {
  TriangleMesh doubled = bumpy();
  for (std::size_t f = 0; f < 100; ++f) doubled.triangles.push_back(doubled.triangles[f]);
  const MeshRepair repair = repaired(doubled);
  expect_body(repair, 1e-12);
  EXPECT_EQ(repair.dropped_facets, 100);
}

TEST(MeshRepair, DropsAFin) {
  TriangleMesh body = bumpy();
  const Triangle t = body.triangles[11];
  const auto tip = static_cast<std::uint32_t>(body.vertices.size());
  body.vertices.push_back(1.3 * body.vertices[t[0]]);
  body.vertices.push_back(1.3 * body.vertices[t[1]]);
  body.triangles.insert(body.triangles.end(), {{t[0], t[1], tip}, {t[1], tip + 1, tip}});
  const MeshRepair repair = repaired(body);
  expect_body(repair, 1e-12);
  EXPECT_EQ(repair.dropped_facets, 2);
  EXPECT_GT(repair.dropped_share, 0.0);
}

TEST(MeshRepair, SplitsFacetsAtTJunctions) {
  TriangleMesh body = bumpy();
  for (std::size_t f = 0; f < 1280; f += 100) {
    const auto [a, b, c] = body.triangles[f];
    const auto middle = static_cast<std::uint32_t>(body.vertices.size());
    body.vertices.push_back(0.5 * (body.vertices[a] + body.vertices[b]));
    body.triangles[f] = {a, middle, c};
    body.triangles.push_back({middle, b, c});
  }
  const MeshRepair repair = repaired(body);
  expect_body(repair, 1e-9);
  EXPECT_EQ(repair.split_facets, 13);
  EXPECT_EQ(repair.mesh.triangles.size(), 1280u + 26u);
  EXPECT_LT(repair.moved, 1e-12);
}

#ifndef ASTROLITH_NO_CGAL

// A cap of the height h has the share (1 - h) / 2 of the ball's surface.
TEST(MeshRepair, FillsHolesOfOneAndFourPercent) {
  for (const double share : {0.01, 0.04}) {
    const MeshRepair repair = repaired(without_cap(1.0 - 2.0 * share));
    expect_body(repair, 3e-3);
    EXPECT_EQ(repair.holes, 1);
    EXPECT_NEAR(repair.largest_hole, share, 0.4 * share);
    EXPECT_EQ(repair.moved, 0.0);
    EXPECT_TRUE(has(repair_words(repair, "km"), "filled 1 hole (largest"));
  }
}

TEST(MeshRepair, RefusesLargeHolesUnlessAWrapIsAllowed) {
  const TriangleMesh open = without_cap(0.8);
  EXPECT_TRUE(has(refusal(open), "body.obj: its holes are"));
  EXPECT_TRUE(has(refusal(open), "; repair it, or add --wrap"));
  RepairOptions options;
  options.wrap = true;
  const MeshRepair repair = repaired(open, options);
  EXPECT_FALSE(repair.wrapped);  // the hole can be filled
  EXPECT_TRUE(is_closed_body(repair.mesh));
  EXPECT_GT(repair.filled_share, kMostFilled);
}

// Three walls meet along a circle: a ball with a disk inside, whose facets share its edges.
TEST(MeshRepair, WrapsWhatCannotBeClosedLong) {
  TriangleMesh body = testing::cube();
  body = testing::subdivided(testing::subdivided(body));
  const auto center = static_cast<std::uint32_t>(body.vertices.size());
  body.vertices.push_back({0.5, 0.5, 0.5});
  // A wall from the middle to every edge of one face.
  for (std::size_t f = 0; f < 32; ++f) {
    const Triangle t = body.triangles[f];
    body.triangles.push_back({t[0], t[1], center});
    body.triangles.push_back({t[1], t[2], center});
  }
  const std::string said = refusal(body);
  EXPECT_TRUE(has(said, "body.obj: "));
  EXPECT_TRUE(has(said, "; repair it, or add --wrap"));
  RepairOptions options;
  options.wrap = true;
  const MeshRepair repair = repaired(body, options);
  EXPECT_TRUE(is_closed_body(repair.mesh));
  EXPECT_NEAR(volume(repair.mesh), 1.0, 0.02) << said << repair_words(repair, "");
  EXPECT_LE(repair.moved, kMostMoved * repair.diagonal);
}

// Points of an ellipsoid that are spread evenly, with noise along x, y and z.
TriangleMesh cloud_of(int count, double noise, double least_x = -2.0) {
  TriangleMesh cloud;
  const auto deviate = [](int i, int axis) {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(unit_float(hash_cell(7U, i, axis, k)));
    return sum;
  };
  for (int i = 0; i < count; ++i) {
    const double z = (2.0 * i + 1.0) / count - 1.0, angle = 2.399963229728653 * i;
    const double across = std::sqrt(1.0 - z * z);
    const Vec3d p{1.5 * across * std::cos(angle), 1.2 * across * std::sin(angle), z};
    if (p.x > least_x)
      cloud.vertices.push_back(p + noise * Vec3d{deviate(i, 0), deviate(i, 1), deviate(i, 2)});
  }
  return cloud;
}
const double kEllipsoid = 4.0 / 3.0 * std::numbers::pi * 1.5 * 1.2;

TEST(MeshRepair, LaysASurfaceThroughPoints) {
  const TriangleMesh cloud = cloud_of(3000, 0.0);
  EXPECT_TRUE(has(refusal(cloud), "body.obj: holds points without faces; "));
  RepairOptions options;
  options.wrap = true;
  const MeshRepair repair = repaired(cloud, options);
  EXPECT_TRUE(!repair.wrapped && repair.points == 3000 && is_closed_body(repair.mesh));
  EXPECT_NEAR(volume(repair.mesh) / kEllipsoid, 1.0, 0.004);
  EXPECT_EQ(repair.stray_points, 0);
  EXPECT_LT(repair.unseen_share, 1e-9);
  EXPECT_EQ(repaired(cloud, options).mesh.vertices, repair.mesh.vertices);
}

TEST(MeshRepair, AveragesTheNoiseOfPointsAndStatesIt) {
  RepairOptions options;
  options.wrap = true;
  TriangleMesh cloud = cloud_of(6000, 0.015);  // .5 % of the length
  cloud.vertices.push_back({9.0, 9.0, 9.0});
  cloud.vertices.push_back({0.0, 0.0, 2.0});
  const MeshRepair repair = repaired(cloud, options);
  EXPECT_NEAR(volume(repair.mesh) / kEllipsoid, 1.0, 0.004);
  EXPECT_NEAR(repair.noise, 0.015, 0.002);
  EXPECT_EQ(repair.stray_points, 2);
  EXPECT_TRUE(has(repair_words(repair, "m"), "2 stray points left out, such as that at 9 9 9"));
  double off = 0.0;
  for (const Vec3d& p : repair.mesh.vertices) {
    const double level = std::sqrt(squared_norm(Vec3d{p.x / 1.5, p.y / 1.2, p.z}));
    const double slope = norm(Vec3d{p.x / 2.25, p.y / 1.44, p.z}) / level;
    off += std::pow((level - 1.0) / slope, 2.0);
  }
  EXPECT_LT(std::sqrt(off / static_cast<double>(repair.mesh.vertices.size())), 0.5 * 0.015);
}

TEST(MeshRepair, RefusesWhatPointsHaveNotSeen) {
  RepairOptions options;
  options.wrap = true;
  const TriangleMesh half = cloud_of(4000, 0.0, 0.0);
  EXPECT_TRUE(has(refusal(half, options), "--fill-unseen"));
  options.fill_unseen = true;
  EXPECT_NEAR(repaired(half, options).unseen_share, 0.5, 0.1);
  options.fill_unseen = false;
  const MeshRepair most = repaired(cloud_of(4000, 0.0, -1.2), options);
  EXPECT_NEAR(most.unseen_share, 0.08, 0.03);
  EXPECT_TRUE(has(repair_words(most, "m"), "of the ground, which is a guess"));
}

TEST(MeshRepair, RemovesACrossingTheCallerFound) {
  TriangleMesh body = bumpy();
  const Triangle t = body.triangles[100];
  const Vec3d along = body.vertices[t[1]] - body.vertices[t[0]];
  body.vertices[t[0]] += 3.0 * along;
  RepairOptions options;
  options.crossings = true;
  const MeshRepair repair = repaired(body, options);
  expect_body(repair, 0.01);
  EXPECT_GT(repair.crossing_facets, 0);
}

TEST(MeshRepair, GivesTheSameBytesForAnyNumberOfThreads) {
  RepairOptions options;
  options.wrap = true;
  TriangleMesh cloud;
  cloud.vertices = icosphere(3).vertices;
  for (const TriangleMesh& mesh : {without_cap(0.93), cloud}) {
    const MeshRepair many = repaired(mesh, options);
    const ThreadLimit limit(1);
    const MeshRepair one = repaired(mesh, options);
    EXPECT_TRUE(one.mesh.vertices == many.mesh.vertices);
    EXPECT_EQ(one.mesh.triangles, many.mesh.triangles);
  }
}

#endif

TEST(MeshRepair, TakesTheLargestBodyOfAScene) {
  const TriangleMesh scene = joined(bumpy(), icosphere(2, 0.3, {3, 0, 0}));
  const MeshRepair largest = repaired(scene);
  expect_body(largest, 1e-12);
  EXPECT_EQ(largest.bodies, 2);
  EXPECT_NEAR(largest.kept_volume, 1.0 / 1.026, 3e-3);
  EXPECT_TRUE(
      has(repair_words(largest, "km"), "holds 2 bodies apart from one another, the largest is taken"));
  RepairOptions options;
  options.all_parts = true;
  const MeshRepair all = repaired(scene, options);
  EXPECT_FALSE(all.changed);
  EXPECT_EQ(all.bodies, 2);
  EXPECT_EQ(all.mesh.triangles, scene.triangles);
}

// A cavity belongs to its body, and lobes that overlap are one body.
TEST(MeshRepair, KnowsCavitiesAndLobes) {
  for (const TriangleMesh& mesh :
       {joined(bumpy(), testing::reversed(icosphere(2, 0.3))), testing::two_spheres(3, 1.0, 1.8)}) {
    const MeshRepair repair = repaired(mesh);
    EXPECT_FALSE(repair.changed);
    EXPECT_EQ(repair.bodies, 1);
    EXPECT_EQ(repair.mesh.triangles, mesh.triangles);
  }
}

TEST(MeshRepair, RefusesWhatIsNoBody) {
  EXPECT_TRUE(has(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}}), "body.obj: "));
  TriangleMesh bad = bumpy();
  bad.triangles[0][0] = 100000;
  EXPECT_TRUE(has(refusal(bad), "names vertex 100000"));
  bad = without_cap(0.9);
  bad.vertices[5].x = std::nan("");
  EXPECT_TRUE(has(refusal(bad), "body.obj: a vertex is not finite"));
  // Corners that become random vertices.
  TriangleMesh rewired = bumpy();
  CounterRandom random(1, 1);
  for (Triangle& t : rewired.triangles) {
    t[1] = static_cast<std::uint32_t>(random.uniform() * static_cast<double>(rewired.vertices.size()));
  }
  EXPECT_TRUE(has(refusal(rewired), "are no damaged body"));
}

TEST(MeshRepair, StopsWhenProgressAsks) {
  EXPECT_THROW(repair_mesh(without_cap(0.95), "body.obj", {}, [](double, std::string_view) { return false; }),
               WorkError);
}

}  // namespace
}  // namespace astrolith
