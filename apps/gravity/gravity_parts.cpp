#include "apps/gravity/gravity_parts.h"

#include <charconv>
#include <sstream>

#include "numerics/errors.h"

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

// Adds what a body of `weight` times unit density adds to the inertia about a point at -d from its centre.
void add_inertia(const BodyMass& mass, double weight, const Vec3d& d, Matrix3& inertia) {
  const std::array<double, 3> e{d.x, d.y, d.z};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double steiner = (i == k ? squared_norm(d) : 0.0) - e[i] * e[k];
      inertia[i][k] += weight * (mass.inertia[i][k] + mass.volume * steiner);
    }
  }
}

}  // namespace

std::vector<BodyPart> read_parts(const Program& program, const std::string& words, const GravityBody& whole,
                                 double density, int resolution) {
  std::vector<BodyPart> parts;
  std::istringstream all(words);
  for (std::string word; std::getline(all, word, ',');) {
    const PartWord read = parse(word);
    const bool recipe = read.file.ends_with(".json");
    BodyPart part{read.file,
                  read_gravity_body(program, read.file, recipe ? "" : whole.unit, resolution),
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

BodyMass with_parts(const BodyMass& whole, const std::vector<BodyPart>& parts) {
  if (parts.empty()) return whole;
  BodyMass all;
  all.volume = whole.volume;
  all.center = whole.volume * whole.center;
  for (const BodyPart& part : parts) {
    all.volume += part.share * part.mass.volume;
    all.center += part.share * part.mass.volume * part.mass.center;
  }
  if (!(all.volume > 0.0)) throw InputError("--density-of: the parts leave no mass; give higher densities");
  all.center = all.center * (1.0 / all.volume);
  add_inertia(whole, 1.0, whole.center - all.center, all.inertia);
  for (const BodyPart& part : parts) {
    add_inertia(part.mass, part.share, part.mass.center - all.center, all.inertia);
  }
  return all;
}

void add_parts(const std::vector<BodyPart>& parts, const std::vector<Vec3d>& points, double tolerance,
               bool exact, const Progress& progress, std::vector<Attraction>& attractions) {
  for (const BodyPart& part : parts) {
    const PolyhedronGravity gravity(part.body.mesh, {}, progress);
    const std::vector<Attraction> own =
        exact ? gravity.exactly_at(points, progress) : gravity.at(points, tolerance, progress);
    for (std::size_t i = 0; i < own.size(); ++i) {
      attractions[i].potential += part.share * own[i].potential;
      attractions[i].acceleration += part.share * own[i].acceleration;
    }
  }
}

}  // namespace astrolith
