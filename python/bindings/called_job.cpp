#include "python/bindings/called_job.h"

#include <filesystem>
#include <type_traits>

namespace astrolith::python {
namespace {

template <typename T>
const char* type_name() {
  if constexpr (std::is_same_v<T, bool>) return "bool";
  if constexpr (std::is_integral_v<T>) return "int";
  if constexpr (std::is_floating_point_v<T>) return "float";
  if constexpr (std::is_same_v<T, std::string>) return "str";
  if constexpr (std::is_same_v<T, std::filesystem::path>) return "PathLike";
  if constexpr (std::is_same_v<T, Triple> || std::is_same_v<T, std::vector<double>>) return "Sequence[float]";
  if constexpr (std::is_same_v<T, std::vector<std::string>>) return "Sequence[str]";
  if constexpr (std::is_same_v<T, std::vector<std::filesystem::path>>) return "Sequence[PathLike]";
  return "Sequence[Sequence[float]]";
}

std::string type_of(const OptionRow& row) {
  const char* const name = std::visit(
      [](const auto* value) { return type_name<std::remove_cvref_t<decltype(*value)>>(); }, row.value);
  const bool names_file = row.reads || row.writes;
  return names_file && std::string(name) == "str" ? "PathLike" : name;
}

}  // namespace

std::vector<OptionDescription> descriptions_of(const OptionTable& options) {
  std::vector<OptionDescription> rows;
  for (const auto& row : options.rows()) {
    if (!row->positional()) rows.emplace_back(row->name(), type_of(*row), row->meaning, row->value_words());
  }
  return rows;
}

}  // namespace astrolith::python
