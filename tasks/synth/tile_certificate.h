// The certificate of a tile: what it is a part of, its figures and its border, as JSON in synth's summary.
// A checker that has the certificates of all tiles knows whether the tiles join to one closed mesh.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesher.h"
#include "synthesis/mesh/tile_border.h"

namespace astrolith {

struct TileCertificate {
  int number = 1, count = 1;  // tile `number` of `count`, from 1
  std::string recipe_sha256;  // of the recipe with its seed, without its description
  int resolution = 0;
  std::string length_unit;
  std::string file;         // name of the mesh, without its folder
  std::string file_sha256;  // of the mesh
  TileFigures figures;
};

// The planes where a tile is cut; absent at the ends of the body.
struct TilePlanes {
  std::optional<float> lower, upper;
};

// Throws InputError for a tile that does not exist at this resolution.
TilePlanes tile_planes(const ImplicitField& field, int resolution, MeshTile tile);

std::string hash_recipe(Recipe recipe);

nlohmann::ordered_json to_json(const TileCertificate& certificate);

// Reads the certificate from the field "tile" of a summary. Throws InputError for a file that is no summary
// of a tile, that is larger than 64 kB, and for a certificate that was changed since synth wrote it.
TileCertificate read_tile_certificate(const std::filesystem::path& summary);

}  // namespace astrolith
