// Help as people read it: "--threads N in [0 - 1024] (default 0)" rather than CLI11's type and validator
// names.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace astrolith {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return "";  // a flag
    std::string text = " " + argument(*option);
    if (!option->get_default_str().empty()) text += " (default " + option->get_default_str() + ")";
    if (option->get_required()) text += " (required)";
    return text;
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
