// Craters and boulders in a recipe: reading, checking and writing.
#pragma once

#include <nlohmann/json.hpp>

#include "recipe/landforms.h"
#include "recipe/object_reader_internal.h"
#include "recipe/place_internal.h"

namespace astrolith {

void read_fields(ObjectReader& object, CraterLayer& out);
void check(const CraterLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const CraterLayer& layer);

void read_fields(ObjectReader& object, BoulderLayer& out);
void check(const BoulderLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const BoulderLayer& layer);

}  // namespace astrolith
