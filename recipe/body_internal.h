// The body in a recipe: reading, checking and writing; with what layers say in the same way.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "recipe/body.h"
#include "recipe/object_reader_internal.h"
#include "recipe/place_internal.h"

namespace astrolith {

void read_body(const nlohmann::json& value, const Place& place, MetaballBody& out);
void check(const MetaballBody& body, const Place& place);
nlohmann::ordered_json to_json(const MetaballBody& body);

// The field "warp" of a body or a layer.
void read_warp(ObjectReader& parent, std::optional<Warp>& out);
void check(const Warp& warp, const Place& place);
nlohmann::ordered_json to_json(const Warp& warp);

// Of a fractal sum.
void check_octaves(double frequency, int octaves, double gain, double lacunarity, const Place& place);

nlohmann::ordered_json to_json(const Vec3d& v);

}  // namespace astrolith
