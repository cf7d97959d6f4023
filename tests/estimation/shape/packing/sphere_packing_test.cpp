#include <algorithm>
#include <cmath>
#include <fstream>

#include "estimation/shape/packing/clearance_grid.h"
#include "estimation/shape/packing/sphere_packing.h"
#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using testing::icosphere;

Packing pack(const TriangleMesh& mesh, int spheres) {
  PackingOptions options;
  options.max_spheres = spheres;
  return pack_spheres(mesh, SurfaceTree(mesh), options);
}

void expect_inside_and_apart(const Packing& packing, const TriangleMesh& mesh) {
  const SurfaceTree tree(mesh);
  const double slack = 1e-9 * mesh.bounds().diagonal();
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const Sphere& s = packing.spheres[i];
    EXPECT_GE(tree.signed_distance(s.center), s.radius - slack);
    for (std::size_t j = 0; j < i; ++j) {
      const Sphere& other = packing.spheres[j];
      EXPECT_GE(norm(s.center - other.center), s.radius + other.radius - slack);
      EXPECT_GE(other.radius, s.radius) << "largest first";
    }
  }
}

TEST(SpherePacking, BallIsFilledByOneSphereOfItsRadius) {
  const TriangleMesh mesh = icosphere(4, 2.0, {1, -1, 3});
  const Packing packing = pack(mesh, 1);
  ASSERT_EQ(packing.spheres.size(), 1u);
  EXPECT_NEAR(packing.spheres[0].radius, 2.0, 0.01);
  EXPECT_NEAR(norm(packing.spheres[0].center - Vec3d{1, -1, 3}), 0.0, 0.01);
  EXPECT_NEAR(packing.filling_rate, 1.0, 0.02);
}

TEST(SpherePacking, CubeIsFilledInsideWithoutOverlap) {
  const TriangleMesh mesh = testing::cube(1.0);
  const Packing packing = pack(mesh, 60);
  ASSERT_EQ(packing.spheres.size(), 60u);
  expect_inside_and_apart(packing, mesh);
  EXPECT_NEAR(packing.spheres[0].radius, 0.5, 1e-3);
  // The largest sphere in a cube's corner touches the inscribed one: r = (2 - sqrt 3) / 2 there.
  for (int i = 1; i <= 8; ++i) EXPECT_NEAR(packing.spheres[static_cast<std::size_t>(i)].radius, 0.1340, 4e-3);
  EXPECT_GT(packing.filling_rate, 0.60);
}

TEST(SpherePacking, BothPartsOfAPairGetTheirShare) {
  const TriangleMesh mesh = testing::joined(icosphere(3, 1.0, {0, 0, 0}), icosphere(3, 0.6, {4, 0, 0}));
  const Packing packing = pack(mesh, 2);
  ASSERT_EQ(packing.spheres.size(), 2u);
  EXPECT_NEAR(packing.spheres[0].radius, 1.0, 0.03);
  EXPECT_NEAR(packing.spheres[1].radius, 0.6, 0.02);
}

TEST(SpherePacking, SameBitsForOneAndTwoThreads) {
  const TriangleMesh mesh = testing::torus(1.0, 0.4);
  std::vector<Packing> packings;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    packings.push_back(pack(mesh, 30));
  }
  expect_inside_and_apart(packings[0], mesh);
  ASSERT_EQ(packings[0].spheres.size(), packings[1].spheres.size());
  for (std::size_t i = 0; i < packings[0].spheres.size(); ++i) {
    EXPECT_EQ(packings[0].spheres[i].center, packings[1].spheres[i].center);
    EXPECT_EQ(packings[0].spheres[i].radius, packings[1].spheres[i].radius);
  }
}

// Calls check(centre of the cell, its clearance).
template <typename Check>
void for_each_cell(const ClearanceGrid& grid, const Check& check) {
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) check(grid.center(i), grid.clearance[i]);
}

TEST(ClearanceGrid, CubeIsMeasuredToATenthOfAStep) {
  const TriangleMesh mesh = testing::cube(1.0);
  const ClearanceGrid grid = make_clearance_grid(mesh, SurfaceTree(mesh), 30000);
  std::size_t inside = 0;
  for_each_cell(grid, [&](const Vec3d& p, float clearance) {
    const Vec3d q = p - mesh.bounds().center();
    const double depth = 0.5 - std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    inside += clearance > 0.0f ? 1 : 0;
    EXPECT_GE(clearance, std::max(0.0, depth) - 1e-5);
    EXPECT_LE(clearance, std::max(0.0, depth + 0.1 * grid.step));
    if (depth <= 0.0) {
      EXPECT_LE(clearance, 0.0f);
    }
  });
  EXPECT_NEAR(static_cast<double>(inside), 30000.0, 1500.0);
}

TEST(ClearanceGrid, AgreesWithTheTreeOnACurvedBody) {
  const TriangleMesh mesh = testing::torus(1.0, 0.4);
  const SurfaceTree tree(mesh);
  const ClearanceGrid grid = make_clearance_grid(mesh, tree, 5000);
  for_each_cell(grid, [&](const Vec3d& p, float clearance) {
    const double exact = std::max(0.0, tree.signed_distance(p));
    EXPECT_GE(clearance, exact - 1e-5);
    EXPECT_LE(clearance, exact + 0.15 * grid.step);
  });
}

TEST(ClearanceGrid, APlateKeepsWithinTheLimitOfCells) {
  TriangleMesh plate = testing::cube(1.0);
  for (Vec3d& v : plate.vertices) v.z *= 1e-7;
  const ClearanceGrid grid = make_clearance_grid(plate, SurfaceTree(plate), 1e6, 1e5);
  EXPECT_LE(static_cast<double>(grid.clearance.size()), 1e5);
}

std::vector<std::string> read_lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

const std::vector<Sphere> kSpheres = {{{1, 2, 3}, 0.2}, {{-1, 0.5, 0}, 0.1}};

TEST(PackingTable, HoldsCentresAndRadii) {
  const testing::ScratchFolder folder;
  write_packing_table(kSpheres, {"two spheres", "km"}, folder / "p.csv");
  EXPECT_EQ(read_lines(folder / "p.csv"),
            (std::vector<std::string>{"# two spheres", "# lengths in km", "x,y,z,radius", "1,2,3,0.2",
                                      "-1,0.5,0,0.1"}));
}

TEST(PackingTable, MasconsWeighWhatTheBodyWeighs) {
  const testing::ScratchFolder folder;
  write_packing_table(kSpheres, {"two spheres", "km", 0.09, 2000.0}, folder / "p.csv");
  const std::vector<std::string> lines = read_lines(folder / "p.csv");
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[2], "x,y,z,radius,mass");
  const auto mass = [&](std::size_t line) {
    return std::stod(lines[line].substr(lines[line].rfind(',') + 1));
  };
  EXPECT_NEAR(mass(3) + mass(4), 1.8e11, 1e3);  // 0.09 km^3 of 2000 kg / m^3
  EXPECT_NEAR(mass(3) / mass(4), 8.0, 1e-6);
}

}  // namespace
}  // namespace astrolith
