#include "estimation/shape/packing/packing_table.h"

#include <fmt/format.h>

#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"

namespace astrolith {
namespace {

double cube(double x) { return x * x * x; }

double kilograms(const PackingTable& table) {
  return table.density * table.body_volume * cube(metres_of(table.length_unit));
}

}  // namespace

std::vector<double> sphere_masses(const std::vector<Sphere>& spheres, const PackingTable& table) {
  double cubes = 0.0;
  for (const Sphere& s : spheres) cubes += cube(s.radius);
  std::vector<double> masses;
  for (const Sphere& s : spheres) masses.push_back(kilograms(table) * cube(s.radius) / cubes);
  return masses;
}

void write_packing_table(const std::vector<Sphere>& spheres, const PackingTable& table,
                         const std::filesystem::path& file) {
  const bool with_mass = table.density > 0.0;
  const std::vector<double> masses = sphere_masses(spheres, table);
  std::string text = fmt::format(
      "# {}\n# lengths in {}{}\n", table.title, table.length_unit,
      with_mass ? fmt::format(", masses in kg that add up to the body's at {} kg/m^3", table.density) : "");
  text += with_mass ? "x,y,z,radius,mass\n" : "x,y,z,radius\n";
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", s.center.x, s.center.y, s.center.z, s.radius);
    text += with_mass ? fmt::format(",{:.9g}\n", masses[i]) : "\n";
  }
  write_file(file, text);
}

}  // namespace astrolith
