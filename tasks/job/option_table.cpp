#include "tasks/job/option_table.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <type_traits>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

template <typename T>
constexpr bool kIsVector = false;
template <typename T>
constexpr bool kIsVector<std::vector<T>> = true;

// The number has a point in it whatever the locale, as Python's caller may have set one.
double number_in(const std::string& word) {
  const char *const begin = word.data() + (word.starts_with('+') && !word.starts_with("+-") ? 1 : 0),
                    *const end = word.data() + word.size();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument || rest != end)
    throw InputError("must be a number, is \"" + word + "\"");
  if (error == std::errc::result_out_of_range)
    throw InputError("must be a number that a double holds, is \"" + word + "\"");
  if (!std::isfinite(value)) throw InputError("must be a finite number");
  return value;
}

template <typename Integer>
Integer integer_in(const std::string& word) {
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(word.c_str(), &end, 10);
  const bool fits = errno == 0 && std::in_range<Integer>(value);
  if (word.empty() || *end != '\0' || !fits) throw InputError("must be a whole number, is \"" + word + "\"");
  return static_cast<Integer>(value);
}

// Reads one value from its words.
void read(bool& value, const std::string* word) { value = *word == "true"; }
void read(double& value, const std::string* word) { value = number_in(*word); }
void read(std::string& value, const std::string* word) { value = *word; }
void read(fs::path& value, const std::string* word) { value = *word; }
void read(Triple& value, const std::string* word) {
  value = {number_in(word[0]), number_in(word[1]), number_in(word[2])};
}
template <typename Integer>
requires std::is_integral_v<Integer>
void read(Integer& value, const std::string* word) { value = integer_in<Integer>(*word); }

std::string format_default(bool) { return ""; }
std::string format_default(const std::string& value) { return value; }
std::string format_default(const fs::path& value) { return value.string(); }
std::string format_default(double value) { return fmt::format("{:g}", value); }
std::string format_default(std::int64_t value) { return std::to_string(value); }
std::string format_default(std::uint64_t value) { return std::to_string(value); }
std::string format_default(int value) { return std::to_string(value); }
std::string format_default(const Triple&) { return ""; }
template <typename T>
std::string format_default(const std::vector<T>&) {
  return "";
}

template <typename Number>
ValueRule range_rule(Number least, Number most) {
  const auto complaint = [=](const std::string& word) {
    const double value = number_in(word);
    return value >= static_cast<double>(least) && value <= static_cast<double>(most)
               ? std::string()
               : fmt::format("must be a number between {} and {}, is {}", least, most, word);
  };
  return {complaint,
          fmt::format(std::is_integral_v<Number> ? " in [{} - {}]" : " in [{:g} - {:g}]", least, most)};
}

template <typename Word>
ValueRule choice_rule(std::initializer_list<Word> choices) {
  std::vector<std::string> words;
  for (const Word& choice : choices) words.push_back(fmt::format("{}", choice));
  const auto complaint = [words](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end()
               ? std::string()
               : fmt::format("must be one of {}, is \"{}\"", fmt::join(words, ", "), word);
  };
  return {complaint, fmt::format("{{{}}}", fmt::join(words, ","))};
}

std::vector<fs::path> as_names(const std::vector<std::string>& words) { return {words.begin(), words.end()}; }

// Names of members and of seeds stand for many files.
constexpr std::string_view kMarks[] = {"{member}", "{n}"};

// Whether one of the files that the name with marks stands for is this file.
bool stands_for(const fs::path& name, const fs::path& file) {
  const auto place = [](const fs::path& path) { return fs::absolute(path).lexically_normal().string(); };
  std::string pattern;
  bool marked = false;
  for (std::string_view rest = name.native(); !rest.empty();) {
    const auto mark =
        std::find_if(std::begin(kMarks), std::end(kMarks), [&](auto m) { return rest.starts_with(m); });
    if (mark != std::end(kMarks)) {
      pattern += "+([0-9])", marked = true;
      rest.remove_prefix(mark->size());
      continue;
    }
    if (std::string_view("*?+@![(|)\\").find(rest.front()) != std::string_view::npos) pattern += '\\';
    pattern += rest.front();
    rest.remove_prefix(1);
  }
  return marked && ::fnmatch(place(pattern).c_str(), place(file).c_str(), FNM_PATHNAME | FNM_EXTMATCH) == 0;
}

void require_input_kept(const fs::path& output, const fs::path& input) {
  require_other_file(output, input);
  if (stands_for(output, input))
    throw InputError(output.string() + ": stands for the input " + input.string() +
                     ", too; give the output another name");
}

// The name of the row in messages, as the command line has it.
std::string spoken(const OptionRow& row) { return (row.positional() ? "" : "--") + row.name(); }

}  // namespace

ValueRule in_range(int least, int most) { return range_rule(least, most); }
ValueRule in_range(std::int64_t least, std::int64_t most) { return range_rule(least, most); }
ValueRule in_range(double least, double most) { return range_rule(least, most); }
ValueRule one_of(std::initializer_list<const char*> words) { return choice_rule(words); }
ValueRule one_of(std::initializer_list<int> numbers) { return choice_rule(numbers); }

ValueRule above_zero() {
  const auto complaint = [](const std::string& word) {
    return number_in(word) > 0.0 ? std::string() : "must be a number above 0, is " + word;
  };
  return {complaint, " > 0"};
}

ValueRule zero_or_more() {
  const auto complaint = [](const std::string& word) {
    return number_in(word) >= 0.0 ? std::string() : "must be a number of at least 0, is " + word;
  };
  return {complaint, " >= 0"};
}

std::string OptionRow::name() const {
  const std::size_t dashes = names.find("--");
  return dashes == std::string::npos ? names : names.substr(dashes + 2);
}

std::string OptionRow::value_words() const {
  if (is_flag()) return "";
  std::string text = placeholder;
  if (text.empty()) {
    const bool is_name = std::holds_alternative<std::string*>(value) ||
                         std::holds_alternative<fs::path*>(value) ||
                         std::holds_alternative<std::vector<std::string>*>(value) ||
                         std::holds_alternative<std::vector<fs::path>*>(value);
    text = is_name ? "FILE" : "N";
    for (const ValueRule& rule : rules) text = rule.words.starts_with('{') ? rule.words : text + rule.words;
  }
  if (!implied.empty()) text = "[" + text + "]";
  if (!default_words.empty()) text += " (default " + default_words + ")";
  return text + (required ? " (required)" : "");
}

bool OptionRow::takes(const std::string& word) const {
  return std::all_of(rules.begin(), rules.end(),
                     [&](const ValueRule& rule) { return rule.complaint(word).empty(); });
}

Option& Option::required() {
  row_->required = true;
  return *this;
}

Option& Option::check(ValueRule rule) {
  row_->rules.push_back(std::move(rule));
  return *this;
}

Option& Option::needs(const Option& other) {
  row_->needs.push_back(other.name());
  return *this;
}

Option& Option::excludes(const Option& other) {
  row_->excludes.push_back(other.name());
  return *this;
}

Option& Option::expected(int count) {
  row_->count = count;
  return *this;
}

Option& Option::implied(std::string word) {
  row_->implied = std::move(word);
  return *this;
}

Option& Option::repeated() {
  row_->repeated = true;
  return *this;
}

Option& Option::description(std::string text) {
  row_->meaning = std::move(text);
  return *this;
}

Option& Option::placeholder(std::string text) {
  row_->placeholder = std::move(text);
  return *this;
}

Option& Option::default_text(std::string text) {
  row_->default_words = std::move(text);
  return *this;
}

Option& Option::reads(FilesOf files) {
  row_->reads = files ? std::move(files) : as_names;
  return *this;
}

Option& Option::writes(FilesOf files) {
  row_->writes = files ? std::move(files) : as_names;
  return without_effect();
}

Option& Option::makes_folders() {
  row_->makes_folders = true;
  return *this;
}

Option& Option::without_effect() {
  row_->decides_result = false;
  return *this;
}

OptionTable::OptionTable() = default;
OptionTable::~OptionTable() = default;

Option OptionTable::add_option(const std::string& names, OptionValue variable, const std::string& meaning) {
  auto row = std::make_unique<OptionRow>(OptionRow{names, variable, meaning});
  row->default_words = std::visit([](const auto* value) { return format_default(*value); }, variable);
  rows_.push_back(std::move(row));
  return Option(rows_.back().get());
}

OptionTable& OptionTable::add_command(const std::string& name, const std::string& meaning) {
  commands_.push_back({name, meaning, std::make_unique<OptionTable>()});
  return *commands_.back().options;
}

OptionRow* OptionTable::find(std::string_view name) const {
  name.remove_prefix(std::min(name.find_first_not_of('-'), name.size()));
  for (const auto& row : rows_) {
    if (row->name() == name) return row.get();
  }
  return nullptr;
}

Option OptionTable::option(std::string_view name) const {
  OptionRow* const row = find(name);
  if (row == nullptr) throw WorkError(std::string(name) + ": is no option of this job");
  return Option(row);
}

void OptionTable::set(OptionRow& row, const std::vector<std::string>& words) try {
  // A flag in Python.
  if (!row.implied.empty() && words == std::vector<std::string>{"true"}) return set(row, {row.implied});
  for (const std::string& word : words) {
    for (const ValueRule& rule : row.rules) {
      if (const std::string complaint = rule.complaint(word); !complaint.empty()) throw InputError(complaint);
    }
  }
  const std::size_t step = static_cast<std::size_t>(row.words_per_value());
  const std::size_t wanted = row.takes_several() ? static_cast<std::size_t>(row.count) : step;
  if (words.empty() || words.size() % step != 0 || (wanted != 0 && words.size() != wanted)) {
    throw InputError(fmt::format("takes {} values, not {}", wanted == 0 ? step : wanted, words.size()));
  }
  std::visit(
      [&](auto* value) {
        using Value = std::remove_pointer_t<decltype(value)>;
        if constexpr (kIsVector<Value>) {
          value->clear();
          for (std::size_t i = 0; i < words.size(); i += step) read(value->emplace_back(), &words[i]);
        } else {
          read(*value, words.data());
        }
      },
      row.value);
  row.words = words;
} catch (const InputError& e) {
  throw InputError(spoken(row) + ": " + e.what());
}

std::vector<const OptionRow*> OptionTable::given_rows() const {
  std::vector<const OptionRow*> given;
  for (const auto& row : rows_) {
    if (!row->words.empty()) given.push_back(row.get());
  }
  for (const Command& command : commands_) {
    for (const OptionRow* row : command.options->given_rows()) given.push_back(row);
  }
  return given;
}

void OptionTable::check_combination() const {
  for (const auto& row : rows_) {
    if (row->words.empty()) continue;
    for (const std::string& other : row->needs) {
      if (find(other)->words.empty()) throw InputError(spoken(*row) + " requires " + spoken(*find(other)));
    }
    for (const std::string& other : row->excludes) {
      if (!find(other)->words.empty()) throw InputError(spoken(*row) + " excludes " + spoken(*find(other)));
    }
  }
  for (const Command& command : commands_) {
    if (command.options->was_given()) command.options->check_combination();
  }
}

void OptionTable::check_files() const {
  const std::vector<const OptionRow*> given = given_rows();
  for (const OptionRow* row : given) {
    if (row->writes && row->words.front().empty())
      throw InputError(row->name() + ": is given without a name; give one, or leave it out");
  }
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!given[i]->writes) continue;
    for (const fs::path& output : given[i]->writes(given[i]->words)) {
      for (std::size_t j = 0; j < given.size(); ++j) {
        if (given[j]->reads) {
          for (const fs::path& file : given[j]->reads(given[j]->words)) require_input_kept(output, file);
        }
        if (j > i && given[j]->writes) {
          for (const fs::path& file : given[j]->writes(given[j]->words)) {
            require_two_files(output, file);
            if (stands_for(output, file) || stands_for(file, output)) require_two_files(file, file);
          }
        }
      }
    }
  }
}

bool OptionTable::makes_folders() const {
  const std::vector<const OptionRow*> given = given_rows();
  return std::any_of(given.begin(), given.end(),
                     [](const OptionRow* row) { return row->makes_folders && !row->words.front().empty(); });
}

void OptionTable::require_not_written(const fs::path& file) const {
  for (const OptionRow* row : given_rows()) {
    if (!row->writes) continue;
    for (const fs::path& output : row->writes(row->words)) require_input_kept(output, file);
  }
}

std::vector<std::pair<std::string, std::string>> OptionTable::given() const {
  std::vector<std::pair<std::string, std::string>> given;
  for (const auto& row : rows_) {
    if (row->words.empty() || row->positional() || !row->decides_result) continue;
    given.emplace_back(row->name(), fmt::format("{}", fmt::join(row->words, " ")));
  }
  std::sort(given.begin(), given.end());
  return given;
}

}  // namespace astrolith
