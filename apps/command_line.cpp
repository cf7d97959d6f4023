#include "apps/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <tuple>
#include <utility>
#include <vector>

namespace astrolith {
namespace {

// CLI11's range, with the limits as a reader writes them.
template <typename Number>
ValueCheck range_check(Number least, Number most) {
  const CLI::Range range(least, most);
  const auto check = [=](std::string& text) {
    return range(text).empty() ? std::string()
                               : fmt::format("must be a number between {} and {}, is {}", least, most, text);
  };
  return ValueCheck(CLI::Validator(check, range.get_description()));
}

}  // namespace

ValueCheck::ValueCheck(CLI::Validator validator)
    : validator_(std::make_shared<const CLI::Validator>(std::move(validator))) {}

ValueCheck in_range(int least, int most) { return range_check(least, most); }
ValueCheck in_range(std::int64_t least, std::int64_t most) { return range_check(least, most); }
ValueCheck in_range(double least, double most) { return range_check(least, most); }
ValueCheck one_of(std::initializer_list<const char*> words) { return ValueCheck(CLI::IsMember(words)); }
ValueCheck one_of(std::initializer_list<int> numbers) { return ValueCheck(CLI::IsMember(numbers)); }

ValueCheck above_zero() {
  const auto check = [](std::string& text) {
    return std::strtod(text.c_str(), nullptr) > 0.0 ? std::string() : "must be a number above 0, is " + text;
  };
  return ValueCheck(CLI::Validator(check, "POSITIVE"));
}

ValueCheck zero_or_more() {
  const auto check = [](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && value >= 0.0 ? std::string() : "must be a number of at least 0, is " + text;
  };
  return ValueCheck(CLI::Validator(check, "NONNEGATIVE"));
}

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::check(const ValueCheck& check) {
  option_->check(check.validator());
  return *this;
}

Option& Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::expected(int count) {
  option_->expected(count);
  return *this;
}

Option& Option::repeated() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::description(const std::string& text) {
  option_->description(text);
  return *this;
}

Option& Option::placeholder(const std::string& text) {
  option_->option_text(text);
  return *this;
}

Option& Option::default_text(const std::string& text) {
  option_->default_str(text);
  return *this;
}

std::size_t Option::count() const { return option_->count(); }

std::string Option::name() const { return option_->get_lnames().front(); }

template <typename T>
Option CommandLine::add_option(const std::string& name, T& variable, const std::string& description) {
  return Option(app_->add_option(name, variable, description));
}

Option CommandLine::add_flag(const std::string& name, bool& variable, const std::string& description) {
  return Option(app_->add_flag(name, variable, description));
}

CommandLine CommandLine::add_command(const std::string& name, const std::string& description) {
  CLI::App* command = app_->add_subcommand(name, description);
  command->fallthrough();
  return CommandLine(*command);
}

void CommandLine::require_command() { app_->require_subcommand(1); }

Option CommandLine::option(const std::string& name) const { return Option(app_->get_option(name)); }

bool CommandLine::was_given() const { return app_->parsed(); }

// The types that an option may have.
using std::filesystem::path;
using Triple = std::tuple<double, double, double>;
template Option CommandLine::add_option(const std::string&, int&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::int64_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::add_option(const std::string&, double&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::string&, const std::string&);
template Option CommandLine::add_option(const std::string&, path&, const std::string&);
template Option CommandLine::add_option(const std::string&, Triple&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<path>&, const std::string&);
template Option CommandLine::add_option(const std::string&, std::vector<Triple>&, const std::string&);

}  // namespace astrolith
