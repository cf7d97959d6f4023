// The ground that decides where a patch lies and how its map is turned.
#pragma once

#include <filesystem>
#include <optional>

#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "tasks/synth/mesh_region.h"

namespace astrolith {

// The recipe without what is added to its ground, so that the maps of a patch with and without it share their
// pixels. Where the recipe has a relief its ground is the body and the relief without its finer levels and
// its fills. Elsewhere landforms drawn by cells, Gabor layers and exemplars are added, but for those that
// masks ask. None where nothing is added. All layers keep their places in the list and thereby their numbers.
std::optional<Recipe> without_additions(const Recipe& recipe);

// The field of without_additions() in a region; none where nothing is added.
std::optional<ImplicitField> field_of_ground(const Recipe& recipe, const std::filesystem::path& file,
                                             const Region& region);

// Places a patch on the ground of its recipe, by place_on_ground(); where that misses the cube, on the
// surface with all that is added, whose field is given. `file` is the recipe's.
void place_patch(const Recipe& recipe, const std::filesystem::path& file, const ImplicitField& field,
                 Region& region);

}  // namespace astrolith
