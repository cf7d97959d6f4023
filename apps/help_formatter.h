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
    if (option->get_type_size() == 0) return "";  // a flag
    std::string text = " " + argument(*option);
    if (!option->get_default_str().empty() && option->get_default_str() != "[]")
      text += " (default " + option->get_default_str() + ")";
    if (option->get_required()) text += " (required)";
    return text;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const std::size_t first_column =
        2 + (make_option_name(option, option->get_positional()) + make_option_opts(option)).size();
    const std::string description = CLI::Formatter::make_option_desc(option);
    return first_column + 1 == get_column_width() ? " " + description : description;
  }

 private:
  // The words for an option's value, made from CLI11's "TYPE:VALIDATOR". The validator's words may begin with
  // the type again.
  static std::string argument(const CLI::Option& option) {
    if (!option.get_option_text().empty()) return option.get_option_text();
    const std::string full = option.get_type_name();
    const std::string type = full.substr(0, full.find(':'));
    const bool number = type == "INT" || type == "UINT" || type == "FLOAT";
    const std::string name = number ? "N" : type == "TEXT" ? "FILE" : type;
    if (full.find(':') == std::string::npos) return name;
    const std::string words = full.substr(full.find(':') + 1);
    if (words.front() == '{') return words;  // a choice
    if (words.find(" in ") != std::string::npos) return name + words.substr(words.find(" in "));
    return name + (words == "POSITIVE" ? " > 0" : words == "NONNEGATIVE" ? " >= 0" : "");
  }
};

}  // namespace astrolith
