#include "tasks/gravity/gravity_lines.h"

#include <fmt/format.h>

#include <string_view>
namespace astrolith {
namespace {

using Figures = nlohmann::ordered_json;

std::string numbers(const Figures& list, const char* format) {
  std::string text;
  for (const Figures& number : list) {
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(format), number.get<double>());
  }
  return text;
}

std::string body_lines(const Figures& figures) {
  const Figures& body = figures["body"];
  const double period = figures["period_h"].get<double>(), density = figures["density_kg_m3"].get<double>();
  const std::string turns = period > 0.0 ? fmt::format("turns once in {:.6g} h", period) : "at rest";
  return fmt::format("mass {:.5g} kg at {:.6g} kg/m3, volume {:.5g} m3, area {:.5g} m2; {}\n",
                     body["mass_kg"].get<double>(), density, body["volume_m3"].get<double>(),
                     body["area_m2"].get<double>(), turns) +
         "centre of mass " + numbers(body["center_of_mass_m"], "{:.4g}") + " m; principal moments " +
         numbers(body["principal_moments_kg_m2"], "{:.4g}") + " kg m2\n";
}

std::string range_line(const Figures& values, const char* column, const char* words, const char* unit) {
  if (!values.contains(column)) return "";
  const Figures& range = values[column];
  const double least = range["min"].get<double>(), most = range["max"].get<double>();
  const std::string text = fmt::format("{:<18} {:11.5g} to {:11.5g}", words, least, most);
  if (std::string_view(column) == "elevation_m") return text + " m above the mean geopotential\n";
  return text + fmt::format(", mean {:11.5g} {}\n", range["mean"].get<double>(), unit);
}

}  // namespace

std::string gravity_lines(const Figures& figures) {
  const Figures& values = figures["values"];
  std::string text = body_lines(figures);
  text +=
      fmt::format("{} ({}):\n", figures["places"].get<std::string>(), figures["count"].get<std::size_t>());
  text += range_line(values, "potential_J_kg", "potential", "J/kg");
  text += range_line(values, "effective_gravity_m_s2", "effective gravity", "m/s2");
  text += range_line(values, "escape_speed_m_s", "escape speed", "m/s");
  text += range_line(values, "slope_deg", "slope", "degrees");
  text += range_line(values, "elevation_m", "elevation", "m");
  if (figures.contains("achieved_error")) {
    text += fmt::format("largest error of an acceleration at {} places {:.2g}\n",
                        figures["achieved_error"]["sample"].get<std::size_t>(),
                        figures["achieved_error"]["largest"].get<double>());
  }
  return text + "--json prints all figures\n";
}

}  // namespace astrolith
