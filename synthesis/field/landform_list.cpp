#include "synthesis/field/landform_list.h"

#include <array>
#include <charconv>
#include <optional>
#include <vector>

#include "numerics/files/output_file.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"

namespace astrolith {
namespace {

constexpr std::array kNumbers = {"x",   "y",      "z",      "diameter", "depth", "rim_height",
                                 "age", "axis_b", "axis_c", "heading",  "tilt",  "burial"};

struct Row {
  int layer;
  std::string kind;
  std::vector<std::optional<double>> numbers;  // in the order of kNumbers; absent where the kind has none
};

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void add_craters(const LayerCraters& layer, std::vector<Row>& rows) {
  for (const PlacedCrater& c : layer.craters) {
    rows.push_back({layer.layer,
                    c.complex ? "complex crater" : "simple crater",
                    {c.position.x,
                     c.position.y,
                     c.position.z,
                     c.diameter,
                     c.depth,
                     c.rim_height,
                     c.age,
                     {},
                     {},
                     {},
                     {},
                     {}}});
  }
}

void add_boulders(const LayerBoulders& layer, std::vector<Row>& rows) {
  for (const PlacedBoulder& b : layer.boulders) {
    rows.push_back({layer.layer,
                    "boulder",
                    {b.center.x,
                     b.center.y,
                     b.center.z,
                     b.axes.x,
                     {},
                     {},
                     {},
                     b.axes.y,
                     b.axes.z,
                     b.heading,
                     b.tilt,
                     b.burial}});
  }
}

std::vector<Row> rows_of(const ImplicitField& field) {
  std::vector<Row> rows;
  for (const LayerCraters& layer : field.craters()) add_craters(layer, rows);
  for (const LayerBoulders& layer : field.boulders()) add_boulders(layer, rows);
  return rows;
}

std::string csv_of(const std::vector<Row>& rows) {
  std::string text = "layer,kind";
  for (const char* column : kNumbers) text += std::string(",") + column;
  for (const Row& row : rows) {
    text += '\n' + std::to_string(row.layer) + ',' + row.kind;
    for (const auto& number : row.numbers) text += ',' + (number ? text_of(*number) : "");
  }
  return text + '\n';
}

std::string json_of(const std::vector<Row>& rows, const std::string& length_unit) {
  std::string text = "{\n  \"length_unit\": \"" + length_unit + "\",\n  \"features\": [";
  const char* separator = "\n";
  for (const Row& row : rows) {
    text += std::string(separator) + "    {\"layer\": " + std::to_string(row.layer) + ", \"kind\": \"" +
            row.kind + '"';
    for (std::size_t k = 0; k < kNumbers.size(); ++k) {
      if (row.numbers[k]) text += std::string(", \"") + kNumbers[k] + "\": " + text_of(*row.numbers[k]);
    }
    text += '}';
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace

void write_landform_list(const ImplicitField& field, const std::string& length_unit,
                         const std::filesystem::path& file) {
  const std::vector<Row> rows = rows_of(field);
  const std::string text = file.extension() == ".json" ? json_of(rows, length_unit) : csv_of(rows);
  OutputFile output(file);
  output.write(text.data(), text.size());
  output.commit();
}

}  // namespace astrolith
