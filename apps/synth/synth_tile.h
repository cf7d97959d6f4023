// The certificate of a tile that synth makes.
#pragma once

#include <filesystem>
#include <optional>

#include "apps/program.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/tile_border.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

// Measures a tile while it is made, and certifies it in the summary.
class TileRecord {
 public:
  TileRecord(const ImplicitField& field, int resolution, MeshTile tile);

  MeshSink& sink() { return border_; }
  // Call it when the mesh is complete. Throws WorkError where the tile is open elsewhere than in its sides:
  // it has so many vertices at open edges.
  void finish(std::int64_t open_vertices);
  // Adds the certificate to a summary that has the hash of the mesh.
  void add_to_summary(Program& program, const Recipe& recipe, const std::filesystem::path& output) const;

 private:
  int resolution_;
  MeshTile tile_;
  TileBorder border_;
  TileFigures figures_;
};

}  // namespace astrolith
