// JSON text to a tree of values, with what a hostile file may cost kept within bounds.
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

// The whole file. Throws InputError when it is missing, a folder, unreadable or larger than kMaxJsonBytes.
std::string read_json_text(const std::filesystem::path& file);

// Throws InputError "name: line L, column C: ..." for text that is not one JSON value in UTF-8, for a key
// that stands twice in one object, and beyond the limits above. Columns count bytes from 1.
nlohmann::json parse_json(std::string_view text, const std::string& name);

// The text as a JSON string: in quotes, on one line, and with U+FFFD for bytes that are not UTF-8.
std::string json_string(std::string_view text);

}  // namespace astrolith
