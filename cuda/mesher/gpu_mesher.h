// The mesher on a GPU, with the bytes of mesh_field (synthesis/mesh/mesher.h).
#pragma once

#include <string>

#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_field.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

// The most cells from which the impulses of a block may be drawn, over all Gabor layers or over all layers of
// spots. Every point of the block adds all these impulses, where the CPU adds those near the point alone.
inline constexpr double kMostImpulseCells = 1 << 18;

// The reason why a field should not be meshed on a GPU in blocks with sides of `block_side` (length units),
// in a few words ("masks by more than 16 layers at a time"). Empty where it can be.
std::string obstacle_on_gpu(const FieldView& field, double block_side, double most_cells = kMostImpulseCells);

// Expects a field of no patch, for which obstacle_on_gpu() is empty. Throws what mesh_field throws, and
// DeviceError, with CUDA's words, when the device fails or has too little memory for one layer of blocks.
// Call probe_device() (cuda/device.h) first.
MeshStatistics mesh_field_on_gpu(const ImplicitField& field, const Box& bounds, int resolution,
                                 MeshSink& sink, const Progress& progress = {}, MeshTile tile = {});

// Does for mesh_patch what mesh_field_on_gpu() does for mesh_field. Expects a field for whose patch_tables()
// obstacle_on_gpu() is empty.
MeshStatistics mesh_patch_on_gpu(const PatchField& field, double size, int resolution, MeshSink& sink,
                                 const Progress& progress = {});

}  // namespace astrolith
