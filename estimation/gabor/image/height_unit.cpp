#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>

#include "estimation/gabor/image/raster_file_internal.h"

namespace astrolith {
namespace {

// The unit in lower case, with blanks for "_", "-" and "." and without brackets around it: "U.S. survey foot"
// and "US_survey_foot" are one.
std::string plain_words(std::string_view unit) {
  std::string plain;
  for (char c : unit) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '[' || c == ']' || c == '.') continue;
    if (c == '_' || c == '-' || c == '\t' || c == '\r') c = ' ';
    if (c != ' ' || (!plain.empty() && plain.back() != ' ')) plain += c;
  }
  while (!plain.empty() && plain.back() == ' ') plain.pop_back();
  return plain;
}

// The metres of a unit in plain words. A long name may be a plural, or end in "er".
double named_unit_metres(std::string_view unit) {
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
  constexpr Unit kUnits[] = {{"m", 1.0},         {"km", 1e3},       {"hm", 100.0},       {"dm", 0.1},
                             {"cm", 0.01},       {"mm", 1e-3},      {"um", 1e-6},        {"ft", kFoot},
                             {"foot", kFoot},    {"feet", kFoot},   {"in", 0.0254},      {"inch", 0.0254},
                             {"inches", 0.0254}, {"yd", 0.9144},    {"yard", 0.9144},    {"yards", 0.9144},
                             {"micron", 1e-6},   {"microns", 1e-6}, {"\xc2\xb5m", 1e-6}, {"\xce\xbcm", 1e-6}};
  constexpr Unit kPrefixes[] = {{"", 1.0},       {"kilo", 1e3},   {"hecto", 100.0}, {"deci", 0.1},
                                {"centi", 0.01}, {"milli", 1e-3}, {"micro", 1e-6}};
  constexpr std::string_view kSurveyFeet[] = {
      "us survey foot", "us survey feet", "us survey ft", "us foot", "us feet",
      "us ft",          "usft",           "ftus",         "ft us",   "foot us",
      "feet us",        "survey foot",    "survey feet",  "sft",     "us survey foot (ftus)"};
  if (std::find(std::begin(kSurveyFeet), std::end(kSurveyFeet), unit) != std::end(kSurveyFeet))
    return kSurveyFoot;
  if (unit.starts_with("international ")) unit.remove_prefix(14);
  for (const Unit& known : kUnits) {
    if (unit == known.name) return known.metres;
  }
  for (const Unit& prefix : kPrefixes) {
    if (!unit.starts_with(prefix.name)) continue;
    const std::string_view stem = unit.substr(prefix.name.size());
    if (stem == "metre" || stem == "metres" || stem == "meter" || stem == "meters") return prefix.metres;
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

double unit_metres(const std::string& unit) {
  const std::string whole = plain_words(unit);
  const double metres = named_unit_metres(whole);
  const std::size_t end = whole.find_first_of(" (,");
  if (metres > 0.0 || end == std::string::npos) return metres;
  // "m s-1" is a speed: a word has two letters.
  const std::size_t next = std::min(whole.find_first_not_of(" ,", end), whole.size());
  const std::string_view rest = std::string_view(whole).substr(next);
  const bool words = rest.size() > 1 && (rest[0] == '(' || (is_letter(rest[0]) && is_letter(rest[1])));
  if (!words || rest.substr(0, 4) == "per ") return 0.0;
  // The longest name counts: "US survey feet above sea level".
  for (std::size_t cut = whole.find_last_of(" (,"); cut != std::string::npos && cut > 0;
       cut = whole.find_last_of(" (,", cut - 1)) {
    if (const double named = named_unit_metres(plain_words(whole.substr(0, cut))); named > 0.0) return named;
  }
  return 0.0;
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
