#include "tasks/gravity/gravity_parts.h"

#include <charconv>
#include <sstream>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "tasks/gravity/gravity_input.h"
#include "tasks/job/body_library.h"
#include "tasks/job/density_question.h"

namespace astrolith {
namespace {

struct PartWord {
  std::string file;
  double density;
};

PartWord parse(const std::string& word) {
  const std::size_t sign = word.rfind('=');
  if (sign == std::string::npos || sign == 0) {
    throw InputError("--density-of " + word + ": names no density; write FILE=KG_M3, such as lobe.ply=2400");
  }
  PartWord part{word.substr(0, sign), 0.0};
  const char *begin = word.data() + sign + 1, *end = word.data() + word.size();
  const auto read = std::from_chars(begin, end, part.density);
  if (read.ec != std::errc{} || read.ptr != end || !(part.density >= 0.0 && part.density < 1e6)) {
    throw InputError("--density-of " + word + ": the density must be 0 to 1e6 kg/m3; give another");
  }
  return part;
}

bool holds(const Box& outer, const Box& inner) {
  const Box wide = widened(outer, 1e-3 * outer.diagonal());
  return inner.min.x >= wide.min.x && inner.min.y >= wide.min.y && inner.min.z >= wide.min.z &&
         inner.max.x <= wide.max.x && inner.max.y <= wide.max.y && inner.max.z <= wide.max.z;
}

}  // namespace

std::vector<std::filesystem::path> files_of_parts(const std::vector<std::string>& words) {
  std::vector<std::filesystem::path> files;
  for (const std::string& list : words) {
    std::istringstream all(list);
    for (std::string word; std::getline(all, word, ',');) files.emplace_back(word.substr(0, word.rfind('=')));
  }
  return files;
}

std::vector<BodyPart> read_parts(const Job& job, const std::string& words, const std::string& unit,
                                 const GravityBody& whole, double density, int resolution,
                                 ShapeRepair repair) {
  repair.all_parts = true;
  std::vector<BodyPart> parts;
  std::istringstream all(words);
  for (std::string word; std::getline(all, word, ',');) {
    const PartWord read = parse(word);
    question_density(job, read.density);
    const bool recipe = is_recipe_name(find_body(read.file));
    nlohmann::ordered_json figures;  // the body's are those of the summary
    BodyPart part{
        read.file,
        read_gravity_body(job, read.file, {recipe ? "" : unit, whole.unit}, resolution, repair, figures),
        read.density,
        (read.density - density) / density,
        {}};
    if (part.body.unit != whole.unit) {
      throw InputError("--density-of " + read.file + ": is in " + part.body.unit + ", the body in " +
                       whole.unit + "; give it the same unit");
    }
    if (!holds(whole.mesh.bounds(), part.body.mesh.bounds())) {
      throw InputError("--density-of " + read.file +
                       ": leaves the body; give a part inside, in the body's unit and frame");
    }
    part.mass = body_mass(part.body.mesh);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace astrolith
