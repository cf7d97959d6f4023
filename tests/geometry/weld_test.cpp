#include "geometry/wound_surface.h"

#include <bit>
#include <stdexcept>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/hash_random.h"
#include "tests/support/data.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using namespace testing;

// Gives every triangle corners of its own, each moved by up to `noise`.
TriangleMesh soup(const TriangleMesh& mesh, double noise = 0.0) {
  TriangleMesh result;
  CounterRandom random(1);
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t index : t) {
      const Vec3d shift{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      result.vertices.push_back(mesh.vertices[index] + noise / std::sqrt(3.0) * shift);
    }
    result.triangles.push_back({n, n + 1, n + 2});
  }
  return result;
}

TEST(Weld, ExactUndoesASoup) {
  const TriangleMesh mesh = icosphere(3, 2, {5, 6, 7});
  const TriangleMesh welded = weld_vertices(soup(mesh), 0);
  EXPECT_EQ(welded.vertices.size(), mesh.vertices.size());
  EXPECT_TRUE(analyze_topology(welded).closed);
  EXPECT_DOUBLE_EQ(volume(welded), volume(mesh));
}

TEST(Weld, ToleranceIsAFractionOfTheDiagonal) {
  const TriangleMesh mesh = icosphere(3, 1000);
  const TriangleMesh noisy = soup(mesh, 1e-5 * mesh.bounds().diagonal());
  EXPECT_GT(weld_vertices(noisy, 0).vertices.size(), mesh.vertices.size());
  EXPECT_GT(weld_vertices(noisy, 1e-6).vertices.size(), mesh.vertices.size());
  // Two copies of a vertex lie at most twice the noise apart.
  EXPECT_EQ(weld_vertices(noisy, 2.1e-5).vertices.size(), mesh.vertices.size());
  EXPECT_TRUE(analyze_topology(weld_vertices(noisy, 2.1e-5)).closed);
}

// Pairs lie across cell borders wherever they fall. The expected answer follows the same rule without a grid.
TEST(Weld, AgreesWithBruteForce) {
  CounterRandom random(7);
  TriangleMesh mesh;
  for (int i = 0; i < 600; ++i)
    mesh.vertices.push_back({random.uniform(), random.uniform(), random.uniform()});
  const double tolerance = 0.04, reach = tolerance * mesh.bounds().diagonal();
  std::vector<Vec3d> kept;
  for (const Vec3d& p : mesh.vertices) {
    bool has_kept_neighbour = false;
    for (const Vec3d& q : kept) has_kept_neighbour = has_kept_neighbour || norm(p - q) <= reach;
    if (!has_kept_neighbour) kept.push_back(p);
  }
  EXPECT_LT(kept.size(), 500u);
  EXPECT_TRUE(weld_vertices(mesh, tolerance).vertices == kept);
}

TEST(Weld, FirstOccurrenceStaysWithItsNormal) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {-0.0, 0, 0}, {0, 1, 0}}, {{0, 1, 3}, {2, 3, 1}}, {}};
  mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  const TriangleMesh welded = weld_vertices(mesh, 0);
  EXPECT_EQ(welded.vertices.size(), 3u);  // zero and minus zero are one place
  EXPECT_TRUE((welded.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 1}}));
  EXPECT_TRUE((welded.normals == std::vector<Vec3d>{{0, 0, 1}, {0, 1, 0}, {0, 0, -1}}));
}

// The finaliser of splitmix64 (Steele, Lea and Flood 2014), and its inverse.
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
std::uint64_t unmixed(std::uint64_t z) {
  z = (z ^ (z >> 31) ^ (z >> 62)) * 0x319642b2d24d8ec3u;
  z = (z ^ (z >> 27) ^ (z >> 54)) * 0x96de1b173f119089u;
  return (z ^ (z >> 30) ^ (z >> 60)) - 0x9e3779b97f4a7c15u;
}

// Places that a table of hashes puts into one slot if the hash is splitmix64 over the coordinates, as it once
// was here: all end in 40 zeros.
TriangleMesh one_slot_places(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint64_t k = 1; mesh.vertices.size() < count; ++k) {
    const double x = static_cast<double>(mesh.vertices.size()), y = 1.0;
    const std::uint64_t before =
        mixed(mixed(std::bit_cast<std::uint64_t>(x)) ^ std::bit_cast<std::uint64_t>(y));
    const auto z = std::bit_cast<double>(unmixed(k << 40) ^ before);
    if (std::abs(z) < 1e15 && std::abs(z) > 1e-15) mesh.vertices.push_back({x, y, z});
  }
  return mesh;
}

// By hash, this took a minute.
TEST(Weld, NoChoiceOfPlacesIsSlow) {
  TriangleMesh mesh = one_slot_places(400000);
  const std::vector<Vec3d> once = mesh.vertices;
  mesh.vertices.insert(mesh.vertices.end(), once.rbegin(), once.rend());
  EXPECT_TRUE(weld_vertices(std::move(mesh), 0).vertices == once);
}

// A published model whose poles and date line are stored twice, with rounding between the copies.
TEST(Weld, ClosesIdasPoles) {
  const auto file = shared_shape("ida_thomas_32k_DEFECT_open_poles.ply");
  ASTROLITH_SKIP_WITHOUT(file);
  const TriangleMesh open = read_mesh(file);
  EXPECT_EQ(analyze_topology(open).boundary_edges, 720);
  const MeshTopology welded = analyze_topology(weld_vertices(open, 1e-6));
  EXPECT_TRUE(welded.closed && welded.manifold && welded.oriented);
  EXPECT_EQ(welded.genus, 0);
}

TEST(Weld, HardInputs) {
  EXPECT_TRUE(weld_vertices({}, 0).vertices.empty());
  EXPECT_TRUE(weld_vertices({}, 1e-3).vertices.empty());
  const TriangleMesh point{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}, {}};
  EXPECT_EQ(weld_vertices(point, 1e-3).vertices.size(), 1u);
  EXPECT_EQ(weld_vertices(icosphere(2), 1e-300).vertices.size(), icosphere(2).vertices.size());
  EXPECT_THROW(weld_vertices(point, -1), std::invalid_argument);
  EXPECT_THROW(weld_vertices(point, std::nan("")), std::invalid_argument);
}

TEST(DropFaces, DegenerateRepeatedAndReversed) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 1, 2}, {1, 1, 3}, {1, 2, 0}, {0, 2, 1}, {0, 3, 1}, {3, 2, 3}},
                          {}};
  const TriangleMesh clean = drop_degenerate_and_repeated_faces(mesh);
  EXPECT_TRUE((clean.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}}));
  EXPECT_EQ(clean.vertices.size(), 4u);
}

}  // namespace
}  // namespace astrolith
