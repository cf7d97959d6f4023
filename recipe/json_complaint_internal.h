// Errors of JSON syntax in plain words: what is wrong, and what to do about it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace astrolith {

// `problem` is the JSON library's message about `text`, and `position` is the character, counted from 1, at
// which the library stopped.
std::string explain_json_problem(std::string_view problem, std::string_view text, std::size_t position);

}  // namespace astrolith
