// The options of a job as one table: names, meaning, limits and default of each value, and whether it names
// files that are read or written. A program makes its command line and its --help from the table, the Python
// package its keyword arguments and their documentation; both refuse the same values with the same words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace astrolith {

// A rule for the words of a value, as they stand on a command line.
struct ValueRule {
  std::function<std::string(const std::string&)>
      complaint;      // "must be a number above 0, is -1"; empty if none
  std::string words;  // " in [0 - 10]", " > 0", or "{m,km}", a choice
};

// Numbers from `least` to `most`, both included.
ValueRule in_range(int least, int most);
ValueRule in_range(std::int64_t least, std::int64_t most);
ValueRule in_range(double least, double most);
// One of the listed words or numbers.
ValueRule one_of(std::initializer_list<const char*> words);
ValueRule one_of(std::initializer_list<int> numbers);
ValueRule above_zero();
ValueRule zero_or_more();

using Triple = std::tuple<double, double, double>;
// Where the value of an option is stored. A bool is a flag. A vector takes as many values as are given.
using OptionValue =
    std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::string*, std::filesystem::path*,
                 Triple*, std::vector<double>*, std::vector<std::string>*,
                 std::vector<std::filesystem::path>*, std::vector<Triple>*>;

// The files that an option's words name.
using FilesOf = std::function<std::vector<std::filesystem::path>(const std::vector<std::string>& words)>;

// One row of the table.
struct OptionRow {
  std::string names;  // "-o,--output"; without dashes for an argument that stands without a name
  OptionValue value;
  std::string meaning;
  std::vector<ValueRule> rules{};
  std::string placeholder{};    // the words for its value in help; empty: made from type and rules
  std::string default_words{};  // empty: the help states no default
  std::string implied{};        // the word that the option means without a value; empty: it needs one
  std::vector<std::string> needs{}, excludes{};  // names of other options
  FilesOf reads{}, writes{};
  bool required = false;             // on a command line
  bool repeated = false;             // given again for each value
  bool decides_result = true;        // stated in the provenance of results
  bool makes_folders = false;        // the job then makes missing folders of its outputs
  int count = 0;                     // of values of a vector; 0: any
  std::vector<std::string> words{};  // as they were given; those of a flag that was given are "true"

  // "output" of "-o,--output": the long name, or the argument's.
  std::string name() const;
  bool positional() const { return names.front() != '-'; }
  bool is_flag() const { return std::holds_alternative<bool*>(value); }
  // How many words make one value, and whether the option takes several values.
  int words_per_value() const {
    return std::holds_alternative<Triple*>(value) || std::holds_alternative<std::vector<Triple>*>(value) ? 3
                                                                                                         : 1;
  }
  bool takes_several() const { return value.index() >= 8; }
  // "N in [0 - 1024] (default 0)": what stands behind the names in help; empty for a flag.
  std::string value_words() const;
  // Whether a word may be the option's value.
  bool takes(const std::string& word) const;
};

// A row to be described further; the calls return the option, so that they can be chained.
class Option {
 public:
  Option() = default;  // no option; may be assigned to, not used
  explicit Option(OptionRow* row) : row_(row) {}

  Option& required();
  Option& check(ValueRule rule);
  Option& needs(const Option& other);
  Option& excludes(const Option& other);
  // The option takes exactly `count` values.
  Option& expected(int count);
  // Without a value the option means `word`. A word that follows it is its value where the rules allow that.
  Option& implied(std::string word);
  // The option may be given several times and takes one value each time.
  Option& repeated();
  Option& description(std::string text);
  // The words that stand for the value in help, such as FILE.json.
  Option& placeholder(std::string text);
  // The words that stand for the default value in help; empty text hides the default.
  Option& default_text(std::string text);
  // The words name files that are read. Without a function the words are the names.
  Option& reads(FilesOf files = {});
  // The words name files that are written, or, with a function, names from which others are made.
  Option& writes(FilesOf files = {});
  // Where the option is given, the job makes missing folders of its outputs.
  Option& makes_folders();
  // The option says where or how fast, not what: results do not state it.
  Option& without_effect();

  // How often the option was given.
  std::size_t count() const { return row_->words.size(); }
  // The long name without its dashes.
  std::string name() const { return row_->name(); }

 private:
  OptionRow* row_ = nullptr;
};

class OptionTable {
 public:
  OptionTable();
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;
  OptionTable(OptionTable&&) = default;
  ~OptionTable();

  // The value that is given is stored in `variable`, whose value before that is the default. `names` is
  // "-o,--output", or a name without dashes for an argument that has no name on the command line.
  Option add_option(const std::string& names, OptionValue variable, const std::string& meaning);
  template <typename T>
  requires(!std::is_pointer_v<T>) Option
      add_option(const std::string& names, T& variable, const std::string& meaning) {
    return add_option(names, OptionValue(&variable), meaning);
  }
  Option add_flag(const std::string& names, bool& variable, const std::string& meaning) {
    return add_option(names, OptionValue(&variable), meaning);
  }
  // A command with options of its own. The job's options may stand after the command's name.
  OptionTable& add_command(const std::string& name, const std::string& meaning);
  // The job needs one of its commands.
  void require_command() { needs_command_ = true; }

  // The option of this name, with its dashes, or of the argument. The option must exist.
  Option option(std::string_view name) const;
  // Null where there is none.
  OptionRow* find(std::string_view name) const;
  const std::vector<std::unique_ptr<OptionRow>>& rows() const { return rows_; }

  struct Command {
    std::string name, meaning;
    std::unique_ptr<OptionTable> options;
  };
  const std::vector<Command>& commands() const { return commands_; }
  bool needs_command() const { return needs_command_; }
  void set_given() { was_given_ = true; }
  // Whether this table's command was given.
  bool was_given() const { return was_given_; }

  // Stores the words of an option. Throws InputError that names the option where they break a rule.
  static void set(OptionRow& row, const std::vector<std::string>& words);

  // Throws InputError where options contradict each other or lack one that they need.
  void check_combination() const;
  // Throws InputError where a file that is written has no name, is also read, or is written by another
  // option, too.
  void check_files() const;
  // Whether the job makes missing folders of its outputs.
  bool makes_folders() const;
  // Throws InputError where an option writes this file, of which a job learns while it works.
  void require_not_written(const std::filesystem::path& file) const;

  // The options that were given and decide the result, sorted by name, for provenance.
  std::vector<std::pair<std::string, std::string>> given() const;

 private:
  // The rows that were given, those of a command that was given among them.
  std::vector<const OptionRow*> given_rows() const;

  std::vector<std::unique_ptr<OptionRow>> rows_;
  std::vector<Command> commands_;
  bool needs_command_ = false, was_given_ = false;
};

}  // namespace astrolith
