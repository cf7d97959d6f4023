#include <fmt/format.h>

#include <charconv>

#include "numerics/errors.h"
#include "recipe/json_document_internal.h"
#include "recipe/place_internal.h"

namespace astrolith {

std::string Place::path() const {
  if (parent_ == nullptr) return {};
  const std::string before = parent_->path();
  if (index_ >= 0) return fmt::format("{}[{}]", before, index_);
  return before.empty() ? std::string(name_) : fmt::format("{}.{}", before, name_);
}

bool Place::is(std::string_view path) const {
  if (parent_ == nullptr) return path.empty();
  if (index_ < 0) {
    if (!path.ends_with(name_)) return false;
    path.remove_suffix(name_.size());
    if (parent_->parent_ == nullptr) return path.empty();
    return path.ends_with('.') && parent_->is(path.substr(0, path.size() - 1));
  }
  const std::size_t bracket = path.ends_with(']') ? path.rfind('[') : std::string_view::npos;
  if (bracket == std::string_view::npos) return false;
  char digits[24];
  const char* const end = std::to_chars(digits, digits + sizeof digits, index_).ptr;
  const std::string_view stated = path.substr(bracket + 1, path.size() - bracket - 2);
  return stated == std::string_view(digits, static_cast<std::size_t>(end - digits)) &&
         parent_->is(path.substr(0, bracket));
}

void Place::fail(std::string_view message) const {
  const std::string where = path();
  throw InputError(where.empty() ? fmt::format("{}: {}", *file_name_, message)
                                 : fmt::format("{}: {}: {}", *file_name_, where, message));
}

std::string quote_text(std::string_view text) {
  constexpr std::size_t kShown = 40;
  if (text.size() <= kShown) return json_string(text);
  // A cut may not halve a character of UTF-8, whose bytes after the first are 10xxxxxx.
  std::size_t end = kShown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return json_string(std::string(text.substr(0, end)) + "...");
}

std::string quote_list(const std::vector<std::string_view>& words, std::string_view last) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) list += i + 1 < words.size() ? ", " : last;
    list += quote_text(words[i]);
  }
  return list;
}

}  // namespace astrolith
