#include "apps/synth/synth_tile.h"

#include <nlohmann/json.hpp>

#include "numerics/errors.h"
#include "tasks/synthesis/tile_certificate.h"

namespace astrolith {
namespace {

TileBorder border_of(const TilePlanes& planes) { return {planes.lower, planes.upper}; }

}  // namespace

TileRecord::TileRecord(const ImplicitField& field, int resolution, MeshTile tile)
    : resolution_(resolution), tile_(tile), border_(border_of(planes_of_tile(field, resolution, tile))) {}

void TileRecord::finish(std::int64_t open_vertices) {
  const std::optional<TileFigures> figures = border_.figures();
  if (!figures || figures->border_vertices() != open_vertices)
    throw WorkError("the tile is open elsewhere than where it was cut; nothing was written");
  figures_ = *figures;
}

void TileRecord::add_to_summary(Program& program, const Recipe& recipe,
                                const std::filesystem::path& output) const {
  program.summary["tile"] = to_json(TileCertificate{.number = tile_.index + 1,
                                                    .count = tile_.count,
                                                    .recipe_sha256 = hash_of_recipe(recipe),
                                                    .resolution = resolution_,
                                                    .length_unit = recipe.length_unit,
                                                    .file = output.filename().string(),
                                                    .file_sha256 = program.summary["sha256"],
                                                    .figures = figures_});
}

}  // namespace astrolith
