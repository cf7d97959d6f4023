// Balls, boxes and rings as mesh files, no two of a kind alike.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/io/mesh_io.h"
#include "numerics/hash_random.h"
#include "tests/apps/program_runner.h"
#include "tests/support/meshes.h"

namespace astrolith::testing {

// A copy of a mesh, stretched a little and with every vertex moved a little.
inline TriangleMesh varied(TriangleMesh mesh, std::uint64_t seed) {
  CounterRandom random(seed);
  const Vec3d stretch{random.uniform(0.9, 1.1), random.uniform(0.9, 1.1), random.uniform(0.9, 1.1)};
  for (Vec3d& p : mesh.vertices) {
    p = {p.x * stretch.x, p.y * stretch.y, p.z * stretch.z};
    p += 0.01 * Vec3d{random.normal(), random.normal(), random.normal()};
  }
  return mesh;
}

inline TriangleMesh shape_of(const std::string& kind) {
  if (kind == "ball") return icosphere(3);
  if (kind == "ring") return torus(1, 0.4, 24, 12);
  TriangleMesh box = cube(1.0);
  for (int i = 0; i < 3; ++i) box = subdivided(box);
  return box;
}

// A test with six meshes each in shapes/ball, shapes/box and shapes/ring, and one fresh mesh of each class.
class LabelledShapesTest : public ProgramTest {
 protected:
  explicit LabelledShapesTest(std::string program) : ProgramTest(std::move(program)) {
    std::uint64_t seed = 0;
    for (const std::string kind : {"ball", "box", "ring"}) {
      std::filesystem::create_directories(folder_ / ("shapes/" + kind));
      for (int i = 0; i < 6; ++i) {
        write_mesh(varied(shape_of(kind), ++seed),
                   folder_ / ("shapes/" + kind + "/" + std::to_string(i) + ".ply"), {});
      }
      write_mesh(varied(shape_of(kind), ++seed), folder_ / (kind + ".obj"), {});
    }
  }
};

}  // namespace astrolith::testing
