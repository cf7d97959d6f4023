// The options of a program, declared with this thin interface to CLI11. CLI11 takes some
// 7 seconds to compile in every file that includes it. Only command_line.cpp and program.cpp include it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace astrolith {

// A rule for the value of an option. A value that breaks the rule ends the program with status 2 and one
// line.
class ValueCheck {
 public:
  explicit ValueCheck(CLI::Validator validator);
  const CLI::Validator& validator() const { return *validator_; }

 private:
  std::shared_ptr<const CLI::Validator> validator_;
};

// Numbers from `least` to `most`, both included.
ValueCheck in_range(int least, int most);
ValueCheck in_range(std::int64_t least, std::int64_t most);
ValueCheck in_range(double least, double most);
// One of the listed words or numbers.
ValueCheck one_of(std::initializer_list<const char*> words);
ValueCheck one_of(std::initializer_list<int> numbers);
// Messages of these two can be read: CLI11's own checks print the largest double in full.
ValueCheck above_zero();
ValueCheck zero_or_more();

// An option of a command line. The calls that describe it return the option, so that they can be chained.
class Option {
 public:
  Option() = default;  // no option; may be assigned to, not used
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  Option& check(const ValueCheck& check);
  Option& needs(const Option& other);
  Option& excludes(const Option& other);
  // The option takes exactly `count` values.
  Option& expected(int count);
  // The option may be given several times and takes one value each time.
  Option& repeated();
  Option& description(const std::string& text);
  // The words that stand for the value in --help, such as FILE.json.
  Option& placeholder(const std::string& text);
  // The words that stand for the default value in --help; empty text hides the default.
  Option& default_text(const std::string& text);

  // How often the option was given.
  std::size_t count() const;
  // The long name without its dashes.
  std::string name() const;

 private:
  CLI::Option* option_ = nullptr;
};

// What a program, or one of its commands, accepts.
class CommandLine {
 public:
  explicit CommandLine(CLI::App& app) : app_(&app) {}

  // The value given on the command line is stored in `variable`, whose value before that is the default. The
  // types of variables are listed at the end of command_line.cpp.
  template <typename T>
  Option add_option(const std::string& name, T& variable, const std::string& description);
  Option add_flag(const std::string& name, bool& variable, const std::string& description);
  // A command with options of its own. The program's options may stand after the command's name.
  CommandLine add_command(const std::string& name, const std::string& description);
  // The program cannot run without one of its commands.
  void require_command();

  // The option of this name, with its dashes. The option must exist.
  Option option(const std::string& name) const;
  // Whether this command was given.
  bool was_given() const;

 private:
  CLI::App* app_;
};

}  // namespace astrolith
