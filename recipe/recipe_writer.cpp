#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "recipe/compact_document_internal.h"
#include "recipe/fields_internal.h"
#include "recipe/json_document_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// The shortest decimal that reads back to equal bits. A reader would take "-0" for the integer 0.
std::string number_text(double value) {
  if (value == 0.0 && std::signbit(value)) return "-0.0";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

// Writes JSON with two spaces per level. An array of numbers stays on one line.
class FieldWriter final : public FieldVisitor {
 public:
  explicit FieldWriter(const Place& place) : FieldVisitor(Task::kWrite, place) {}

  std::string take() { return std::move(text_) + "\n"; }

 private:
  void visit_number(double& number, const NumberLimits&) override { text_ += number_text(number); }
  void visit_integer(int& number, const IntegerLimits&) override { text_ += std::to_string(number); }
  void visit_seed(std::uint64_t& number) override { text_ += std::to_string(number); }
  void visit_flag(bool& flag) override { text_ += flag ? "true" : "false"; }
  void visit_text(std::string& text) override { text_ += json_string(text); }

  bool enter(std::string_view name, bool, bool written) override {
    if (!written) return false;
    next_item();
    text_ += json_string(name) + ": ";
    return true;
  }
  void enter_element(std::size_t) override { next_item(); }
  void begin_object() override { begin('{', false); }
  void end_object() override { end('}'); }
  std::vector<std::string> begin_members() override {
    begin_object();
    return {};
  }
  void end_members() override { end_object(); }
  std::size_t begin_array(std::size_t size, std::span<const std::string_view>, bool one_line) override {
    begin('[', one_line);
    return size;
  }
  void end_array() override { end(']'); }

  void begin(char bracket, bool one_line) {
    text_ += bracket;
    levels_.push_back({one_line, true});
  }
  void end(char bracket) {
    const Level level = levels_.back();
    levels_.pop_back();
    if (!level.empty && !level.one_line) new_line();
    text_ += bracket;
  }
  void next_item() {
    Level& level = levels_.back();
    if (!level.empty) text_ += level.one_line ? ", " : ",";
    if (!level.one_line) new_line();
    level.empty = false;
  }
  void new_line() { text_.append(1, '\n').append(2 * levels_.size(), ' '); }

  struct Level {
    bool one_line, empty;
  };
  std::vector<Level> levels_;  // one for each open bracket
  std::string text_;
};

}  // namespace

std::string recipe_to_json(const Recipe& recipe) {
  try {
    validate_recipe(recipe, "recipe");
  } catch (const InputError& e) {
    throw WorkError(std::string("the recipe to be written is invalid: ") + e.what());
  }
  const std::string name = "recipe";
  const Place place(name);
  FieldWriter writer(place);
  writer.inspect(recipe);
  return writer.take();
}

std::string recipe_to_compact(const Recipe& recipe) {
  return compact_document(nlohmann::json::parse(recipe_to_json(recipe)));
}

bool is_compact_name(const std::filesystem::path& file) { return file.extension() == kCompactExtension; }

bool is_recipe_name(const std::filesystem::path& file) {
  return file.extension() == ".json" || is_compact_name(file);
}

void write_recipe(const Recipe& recipe, const std::filesystem::path& file) {
  write_file(file, is_compact_name(file) ? recipe_to_compact(recipe) : recipe_to_json(recipe));
}

double round_to_seven_digits(double x) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::scientific, 6);
  double rounded = x;
  std::from_chars(text, end.ptr, rounded);
  return rounded;
}

}  // namespace astrolith
