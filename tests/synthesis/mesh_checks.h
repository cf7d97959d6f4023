// What every layer must keep, whatever it does to a surface.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "geometry/mesh_sink.h"
#include "geometry/mesh_topology.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith::testing {

// At three resolutions: closed, manifold, and the same mesh for one thread and for three.
inline void expect_closed_manifold_for_any_threads(const Recipe& recipe) {
  for (const int resolution : {20, 33, 50}) {
    std::vector<TriangleMesh> meshes;
    for (const int threads : {1, 3}) {
      const ThreadLimit limit(threads);
      const ImplicitField field(recipe);
      MeshCollector collector;
      mesh_field(field, field.bounds(), resolution, collector);
      meshes.push_back(std::move(collector.mesh));
    }
    const MeshTopology topology = analyze_topology(meshes[0]);
    ASSERT_TRUE(topology.closed && topology.manifold && topology.oriented);
    ASSERT_TRUE(meshes[0].vertices == meshes[1].vertices && meshes[0].triangles == meshes[1].triangles);
  }
}

}  // namespace astrolith::testing
