// The body that a job fits: its mesh is read, repaired where needed, and prepared.
#pragma once

#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "tasks/estimation/fit_shape.h"

namespace astrolith {

// The mesh that the arguments name or hold. Sets the hash that a checkpoint knows it by.
TriangleMesh read_target_mesh(FitArguments& arguments);

// A place near the middle of a mesh that lies many of its lengths from the origin of its frame, or that
// origin: float32 coordinates would have too few digits for such a body.
Vec3d local_origin(const TriangleMesh& mesh);

// Repairs the mesh, unless the job is strict, and prepares it. Where it then passes through itself, it is
// repaired once more. Says what was mended. Throws what repair_mesh and prepare_target throw.
TargetBody repaired_target(Job& job, const FitArguments& arguments, TriangleMesh mesh,
                           const Progress& preparing);

}  // namespace astrolith
