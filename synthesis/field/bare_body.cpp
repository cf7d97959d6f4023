#include "synthesis/field/bare_body.h"

#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {

BareBody bare_body(const Recipe& recipe) {
  Recipe bare = recipe;
  bare.layers.clear();
  const ImplicitField field(bare);
  return {field.bounds(), [field](const Vec3d& p) { return field.value(p); },
          [field](const Vec3d& p) { return field.gradient(p); },
          [field](int cells) {
            MeshCollector collector;
            mesh_field(field, field.bounds(), cells, collector);
            return std::move(collector.mesh);
          },
          field.tables().body.lipschitz_bound};
}

}  // namespace astrolith
