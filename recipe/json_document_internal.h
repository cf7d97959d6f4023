// Parsing of JSON text into a tree of values. Limits bound the time and the memory that a hostile file can
// cost.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace astrolith {

// A recipe of a million spheres has about 60 MB and 5 million values.
inline constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxJsonValues = 8'000'000;
inline constexpr std::size_t kMaxJsonDepth = 32;

// The text of a whole file. Throws InputError when the file is missing, a folder, unreadable or larger than
// kMaxJsonBytes.
std::string read_json_text(const std::filesystem::path& file);

// The tree of one JSON value in UTF-8. Throws InputError "name: line L, column C: ..." for any other text,
// for a key that stands twice in one object, and for text beyond the limits above. Columns count bytes
// from 1.
nlohmann::json parse_json(std::string_view text, const std::string& name);

// The text as a JSON string: in quotes, on one line, and with U+FFFD for bytes that are not UTF-8.
std::string json_string(std::string_view text);

// What is wrong with JSON text in plain words, and what to do about it. `problem` is the JSON library's
// message about `text`, and `position` is the character, counted from 1, at which the library stopped.
std::string explain_json_problem(std::string_view problem, std::string_view text, std::size_t position);

}  // namespace astrolith
