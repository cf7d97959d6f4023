// Recipes' JSON documents as small binary files. docs/recipe_compact.md states the format.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace astrolith {

// Whether the bytes begin as a compact recipe of any version does.
bool is_compact(std::string_view bytes);

// The document in few bytes. Throws WorkError if it has more than 16 MB of text beside its tables of numbers.
std::string compact_document(const nlohmann::json& document);

// The document that compact_document() was given; integers in tables become doubles. Throws InputError for
// another version, for damaged bytes, and beyond the limits of parse_json().
nlohmann::json parse_compact(std::string_view bytes, const std::string& name);

// Text of a common recipe. It belongs to the format: another text needs another version.
extern const std::string_view kCompactPrimer;

}  // namespace astrolith
