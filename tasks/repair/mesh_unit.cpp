#include "tasks/repair/mesh_unit.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"

namespace astrolith {

MeshUnit resolve_unit(const Job& job, const std::filesystem::path& file, const UnitChoice& choice,
                      std::initializer_list<std::string_view> units) {
  const auto& [stated, label] = stated_unit(file);
  if (stated.empty()) {
    if (!choice.given.empty()) return {choice.given};
    return {choice.otherwise, !choice.otherwise.empty()};
  }
  if (!choice.given.empty() && choice.given != stated) {
    job.say(fmt::format("note: {}: states its unit as {}; taken in {}, as --unit says", file.string(), stated,
                        choice.given));
    return {choice.given};
  }
  if (units.size() == 0 || std::find(units.begin(), units.end(), stated) != units.end()) {
    if (!label.empty())
      job.say(fmt::format("note: {}: in {}, as {} states", file.string(), stated, label.filename().string()));
    return {stated};
  }
  throw InputError(fmt::format(
      "{}: states its unit as {}, which is none of {}; convert its lengths to one of these first, "
      "or add --unit where the statement is wrong",
      file.string(), stated, fmt::join(units, ", ")));
}

}  // namespace astrolith
