#include "tasks/repair/mesh_unit.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"

namespace astrolith {

std::string unit_of_mesh(const Job& job, const std::filesystem::path& file, const UnitChoice& choice,
                         std::initializer_list<std::string_view> units) {
  const std::string stated = stated_length_unit(file);
  if (stated.empty()) return choice.given.empty() ? choice.otherwise : choice.given;
  if (!choice.given.empty() && choice.given != stated) {
    job.say(fmt::format("note: {}: states its unit as {}; taken in {}, as --unit says", file.string(), stated,
                        choice.given));
    return choice.given;
  }
  if (units.size() == 0 || std::find(units.begin(), units.end(), stated) != units.end()) return stated;
  throw InputError(fmt::format(
      "{}: states its unit as {}, which is none of {}; convert its lengths to one of these first, "
      "or add --unit where the statement is wrong",
      file.string(), stated, fmt::join(units, ", ")));
}

}  // namespace astrolith
