#include "cuda/mesher/mesh_field.h"

#include "cuda/device_machine.h"
#include "cuda/mesher/machine_mesher.h"

namespace astrolith {

MeshStatistics mesh_field_on_gpu(const ImplicitField& field, const Box& bounds, int resolution,
                                 MeshSink& sink, const Progress& progress, MeshTile tile) {
  DeviceMachine machine;
  return mesh_field_on(machine, field, bounds, resolution, sink, progress, tile);
}

}  // namespace astrolith
