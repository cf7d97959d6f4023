#include <fmt/format.h>

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
