// What is wrong with a text that is no JSON, and what to do about it, in plain words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace astrolith {

// `problem` is the JSON library's own message about `text`; it stopped at character `position`, from 1.
std::string explain_json_problem(std::string_view problem, std::string_view text, std::size_t position);

}  // namespace astrolith
