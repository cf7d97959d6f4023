// Layers of noise in a recipe: reading, checking and writing.
#pragma once

#include <nlohmann/json.hpp>

#include "recipe/object_reader_internal.h"
#include "recipe/place_internal.h"
#include "recipe/recipe.h"

namespace astrolith {

// The fields that every kind of layer has, beside its own.
void read_use(ObjectReader& layer, LayerUse& out);
// Of the recipe's layer of this number.
void check_use(const Recipe& recipe, std::size_t index, const Place& place);
void add_use(const LayerUse& use, nlohmann::ordered_json& layer);

void read_fields(ObjectReader& object, FractalLayer& out);
void check(const FractalLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const FractalLayer& layer);

void read_fields(ObjectReader& object, GaborLayer& out);
void check(const GaborLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const GaborLayer& layer);

void read_fields(ObjectReader& object, SpotLayer& out);
void check(const SpotLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const SpotLayer& layer);

void read_fields(ObjectReader& object, SparseLayer& out);
void check(const SparseLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const SparseLayer& layer);

void read_fields(ObjectReader& object, RandomPhaseLayer& out);
void check(const RandomPhaseLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const RandomPhaseLayer& layer);

void read_fields(ObjectReader& object, PhasorLayer& out);
void check(const PhasorLayer& layer, const Place& place);
nlohmann::ordered_json to_json(const PhasorLayer& layer);

}  // namespace astrolith
