// Help as people and help2man read it: "-t, --threads N in [0 - 1024] (default 0)" rather than CLI11's type
// and validator names. Two spaces or a new line stand before each description.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace astrolith {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    if (const std::size_t comma = name.find(','); comma != std::string::npos) name.insert(comma + 1, " ");
    return name;
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_option_text().empty() ? "" : " " + option->get_option_text();
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const std::size_t first_column =
        2 + (make_option_name(option, option->get_positional()) + make_option_opts(option)).size();
    const std::string description = CLI::Formatter::make_option_desc(option);
    return first_column + 1 == get_column_width() ? " " + description : description;
  }
};

}  // namespace astrolith
