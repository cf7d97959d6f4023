#include "synthesis/feature_list.h"

#include <array>
#include <charconv>
#include <vector>

#include "numerics/output_file.h"
#include "synthesis/crater_relief.h"

namespace astrolith {
namespace {

constexpr std::array kColumns = {"layer", "kind", "x", "y", "z", "diameter", "depth", "rim_height", "age"};

struct Row {
  int layer;
  std::string kind;
  std::vector<double> numbers;  // of the columns after the kind
};

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::vector<Row> rows_of(const ImplicitField& field) {
  std::vector<Row> rows;
  for (const LayerCraters& layer : field.craters()) {
    for (const PlacedCrater& c : layer.craters) {
      rows.push_back({layer.layer,
                      c.complex ? "complex crater" : "simple crater",
                      {c.position.x, c.position.y, c.position.z, c.diameter, c.depth, c.rim_height, c.age}});
    }
  }
  return rows;
}

std::string csv_of(const std::vector<Row>& rows) {
  std::string text;
  for (const char* column : kColumns) text += (text.empty() ? "" : ",") + std::string(column);
  for (const Row& row : rows) {
    text += '\n' + std::to_string(row.layer) + ',' + row.kind;
    for (const double number : row.numbers) text += ',' + text_of(number);
  }
  return text + '\n';
}

std::string json_of(const std::vector<Row>& rows, const std::string& length_unit) {
  std::string text = "{\n  \"length_unit\": \"" + length_unit + "\",\n  \"features\": [";
  const char* separator = "\n";
  for (const Row& row : rows) {
    text += std::string(separator) + "    {\"layer\": " + std::to_string(row.layer) + ", \"kind\": \"" +
            row.kind + '"';
    for (std::size_t k = 0; k < row.numbers.size(); ++k) {
      text += std::string(", \"") + kColumns[k + 2] + "\": " + text_of(row.numbers[k]);
    }
    text += '}';
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace

void write_feature_list(const ImplicitField& field, const std::string& length_unit,
                        const std::filesystem::path& file) {
  const std::vector<Row> rows = rows_of(field);
  const std::string text = file.extension() == ".json" ? json_of(rows, length_unit) : csv_of(rows);
  OutputFile output(file);
  output.write(text.data(), text.size());
  output.commit();
}

}  // namespace astrolith
