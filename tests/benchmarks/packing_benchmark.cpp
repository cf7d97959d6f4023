// Measures the sphere packing of bodies: the share of the volume that is filled, and seconds, against the
// number of spheres.
//
//   packing_benchmark MESH...
#include <fmt/format.h>

#include <chrono>

#include "estimation/shape/packing/sphere_packing.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/io/mesh_io.h"

int main(int argc, char** argv) {
  using namespace astrolith;
  fmt::print("{:40}{:>8}{:>9}{:>9}{:>10}\n", "body", "spheres", "filled", "seconds", "smallest");
  for (int i = 1; i < argc; ++i) {
    const TargetBody body = prepare_target(read_mesh(argv[i]), argv[i]);
    for (const int spheres : {100, 1000, 10000}) {
      PackingOptions options;
      options.max_spheres = spheres;
      const auto start = std::chrono::steady_clock::now();
      const Packing packing = pack_spheres(body.mesh, body.tree, options);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
      const std::string name(argv[i]);
      fmt::print("{:40}{:8}{:9.4f}{:9.2f}{:10.5f}\n", name.substr(name.rfind('/') + 1),
                 packing.spheres.size(), packing.filling_rate, spent.count(), packing.spheres.back().radius);
    }
  }
}
