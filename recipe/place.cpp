#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "numerics/errors.h"
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
  std::string shown(text.substr(0, kShown));
  if (text.size() > kShown) shown += "...";
  // JSON's own escapes: no line break or control character survives, nor half a UTF-8 sequence.
  return nlohmann::json(shown).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace astrolith
