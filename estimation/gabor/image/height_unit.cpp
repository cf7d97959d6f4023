#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>

#include "estimation/gabor/image/raster_file_internal.h"

namespace astrolith {
namespace {

double named_unit_metres(std::string_view unit) {
  struct Unit {
    const char* name;
    double metres;
  };
  constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
  constexpr Unit kUnits[] = {{"m", 1.0},
                             {"metre", 1.0},
                             {"metres", 1.0},
                             {"meter", 1.0},
                             {"meters", 1.0},
                             {"km", 1000.0},
                             {"kilometre", 1e3},
                             {"kilometres", 1e3},
                             {"kilometer", 1e3},
                             {"kilometers", 1e3},
                             {"cm", 0.01},
                             {"centimetre", 0.01},
                             {"centimetres", 0.01},
                             {"centimeter", 0.01},
                             {"centimeters", 0.01},
                             {"mm", 0.001},
                             {"millimetre", 0.001},
                             {"millimetres", 0.001},
                             {"millimeter", 0.001},
                             {"millimeters", 0.001},
                             {"ft", kFoot},
                             {"foot", kFoot},
                             {"feet", kFoot},
                             {"us survey foot", kSurveyFoot},
                             {"ftus", kSurveyFoot},
                             {"us-ft", kSurveyFoot},
                             {"foot_us", kSurveyFoot}};
  for (const Unit& known : kUnits) {
    if (unit == known.name) return known.metres;
  }
  return 0.0;
}

bool is_letter(char c) { return c >= 'a' && c <= 'z'; }

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

double unit_metres(std::string unit) {
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const std::string_view whole = trimmed(unit);
  const double metres = named_unit_metres(whole);
  const std::size_t end = whole.find_first_of(" (,");
  if (metres > 0.0 || end == std::string_view::npos) return metres;
  // "m s-1" is a speed: a word has two letters.
  const std::size_t next = std::min(whole.find_first_not_of(" ,", end), whole.size());
  const std::string_view rest = whole.substr(next);
  const bool words = rest.size() > 1 && (rest[0] == '(' || (is_letter(rest[0]) && is_letter(rest[1])));
  return words && rest.substr(0, 4) != "per " ? named_unit_metres(whole.substr(0, end)) : 0.0;
}

std::string value_in_label(const std::filesystem::path& file, std::string_view keyword) {
  constexpr std::size_t kLargestLabel = std::size_t{1} << 16;
  std::string label(kLargestLabel, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(label.data(), static_cast<std::streamsize>(label.size()));
  label.resize(static_cast<std::size_t>(in.gcount()));
  std::istringstream lines(label);
  for (std::string line; std::getline(lines, line) && trimmed(line) != "END";) {
    const std::size_t equals = std::min(line.find('='), line.size());
    if (trimmed(std::string_view(line).substr(0, equals)) != keyword || equals == line.size()) continue;
    const std::string_view value = trimmed(std::string_view(line).substr(equals + 1));
    if (value.empty()) return "";
    const bool quoted = value[0] == '"' || value[0] == '\'';
    return std::string(quoted ? value.substr(1, value.find(value[0], 1) - 1)
                              : value.substr(0, value.find_first_of(" \t")));
  }
  return "";
}

}  // namespace astrolith
