// The path of a value in a recipe, for error messages: "rock.json: layers[0].lobes[3].bandwidth".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace astrolith {

// A step of a path. Steps form a chain on the stack, so that walking a recipe allocates nothing. A step
// points to its parent, which must outlive it.
class Place {
 public:
  // The recipe as a whole. `file_name` must outlive the step.
  explicit Place(const std::string& file_name) : file_name_(&file_name) {}

  Place field(std::string_view name) const { return {*file_name_, this, name, -1}; }
  Place element(std::size_t index) const { return {*file_name_, this, {}, static_cast<std::int64_t>(index)}; }

  // The path "layers[0].lobes[3].bandwidth", which is empty for the recipe as a whole.
  std::string path() const;
  // Whether path() is this text, without making the text.
  bool is(std::string_view path) const;
  // Throws InputError "file: path: message" on one line.
  [[noreturn]] void fail(std::string_view message) const;

 private:
  Place(const std::string& file_name, const Place* parent, std::string_view name, std::int64_t index)
      : file_name_(&file_name), parent_(parent), name_(name), index_(index) {}

  const std::string* file_name_;
  const Place* parent_ = nullptr;
  std::string_view name_;
  std::int64_t index_ = -1;
};

// A file's text for a one-line message: quoted, escaped and cut after 40 characters.
std::string quote_text(std::string_view text);
// The list `"a", "b" or "c"` if `last` is " or ".
std::string quote_list(const std::vector<std::string_view>& words, std::string_view last);

}  // namespace astrolith
