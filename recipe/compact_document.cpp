#include "recipe/compact_document_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "numerics/errors.h"
#include "recipe/base64.h"
#include "recipe/compact/number_table.h"
#include "recipe/compact/text_model.h"
#include "recipe/json_document_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

constexpr std::string_view kMagic = "AST";
constexpr unsigned char kCompactVersion = 1;
constexpr std::size_t kHeaderBytes = 6;  // magic, version, check of the rest
constexpr std::size_t kMaxCompactText = std::size_t{16} << 20;

constexpr std::uint64_t kMostHeightBytes = std::uint64_t{1} << 26;  // of one relief

// Shorter lists stay in the text.
constexpr std::size_t kFewestRows = 4;
constexpr std::size_t kFewestNumbers = 8;

// CRC-16 with the polynomial 0x1021, which finds damaged files.
std::uint16_t checksum(std::string_view bytes) {
  std::uint32_t check = 0xffff;
  for (const char c : bytes) {
    check ^= static_cast<std::uint32_t>(static_cast<unsigned char>(c)) << 8;
    for (int bit = 0; bit < 8; ++bit)
      check = ((check << 1) ^ ((check & 0x8000) != 0 ? 0x1021u : 0u)) & 0xffff;
  }
  return static_cast<std::uint16_t>(check);
}

bool all_numbers(const json& list) {
  return list.is_array() && !list.empty() &&
         std::all_of(list.begin(), list.end(), [](const json& value) { return value.is_number(); });
}

bool too_many_equal(const json& list) {
  return list.size() > kMostEqualRows &&
         std::all_of(list.begin(), list.end(), [&](const json& value) { return value == list.front(); });
}

bool is_number_list(const json& value) {
  return all_numbers(value) && value.size() >= kFewestNumbers && !too_many_equal(value);
}

bool is_row_list(const json& value) {
  if (!value.is_array() || value.size() < kFewestRows || too_many_equal(value)) return false;
  const std::size_t columns = value.front().size();
  return columns <= kMostTableColumns && std::all_of(value.begin(), value.end(), [&](const json& row) {
           return all_numbers(row) && row.size() == columns;
         });
}

NumberTable numbers_to_table(const json& list) { return {1, list.get<std::vector<double>>()}; }

NumberTable rows_to_table(const json& list) {
  NumberTable table{list.front().size(), {}};
  for (const json& row : list) {
    for (const json& number : row) table.values.push_back(number.get<double>());
  }
  return table;
}

json to_rows(const NumberTable& table) {
  json list = json::array();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto first = table.values.begin() + static_cast<std::ptrdiff_t>(row * table.columns);
    list.emplace_back(json::array_t(first, first + static_cast<std::ptrdiff_t>(table.columns)));
  }
  return list;
}

// Moves the coded heights of reliefs out of the value, in the order of its text; [null, null] stands for
// them.
void take_heights(json& value, std::vector<std::string>& all) {
  if (!value.is_structured()) return;
  for (auto& [name, inner] : value.items()) {
    if (value.is_object() && name == "heights" && inner.is_string()) {
      if (std::optional<std::string> bytes = base64_bytes(inner.get_ref<const std::string&>())) {
        all.push_back(std::move(*bytes));
        inner = json::array({nullptr, nullptr});
      }
    } else {
      take_heights(inner, all);
    }
  }
}

bool stands_for_heights(const json& value) {
  return value.is_array() && value.size() == 2 && value[0].is_null() && value[1].is_null();
}

void return_heights(json& value, RangeDecoder& decoder) {
  if (stands_for_heights(value)) {
    std::string bytes;  // grows with what is read, since a damaged file may state any size
    for (std::uint64_t left = decoder.decode_uniform(kMostHeightBytes); left > 0; --left) {
      bytes += static_cast<char>(decoder.decode_uniform(256));
    }
    value = base64_text(bytes);
  } else if (value.is_structured()) {
    for (json& inner : value) return_heights(inner, decoder);
  }
}

// Moves the tables out of the value, in the order of its text. null stands for a list of rows, and [null] for
// a list of numbers: recipes have no null of their own.
void take_tables(json& value, std::vector<NumberTable>& tables) {
  if (is_row_list(value)) {
    tables.push_back(rows_to_table(value));
    value = nullptr;
  } else if (is_number_list(value)) {
    tables.push_back(numbers_to_table(value));
    value = json::array({nullptr});
  } else if (value.is_structured()) {
    for (json& inner : value) take_tables(inner, tables);
  }
}

class TableReturner {
 public:
  explicit TableReturner(RangeDecoder& decoder) : decoder_(decoder) {}

  void fill(json& value) {
    if (stands_for_heights(value)) return;
    if (value.is_null()) {
      value = to_rows(next());
    } else if (value.is_array() && value.size() == 1 && value.front().is_null()) {
      value = next().values;
    } else if (value.is_structured()) {
      for (json& inner : value) fill(inner);
    }
  }

 private:
  NumberTable next() {
    NumberTable table = decoder_.decode(values_left_);
    values_left_ -= table.values.size();
    return table;
  }

  TableDecoder decoder_;
  std::size_t values_left_ = kMaxJsonValues;
};

// The model after the primer, which it reads once: that takes longer than a short recipe.
TextModel primed_model() {
  static const TextModel primed(kCompactPrimer);
  return primed;
}

std::string encoded(const json& document, const std::vector<NumberTable>& tables,
                    const std::vector<std::string>& heights) {
  const std::string text = document.dump();
  if (text.size() > kMaxCompactText) {
    throw WorkError("the recipe is too large for a compact file; write it as .json");
  }
  RangeEncoder encoder;
  encoder.encode_number(text.size());
  primed_model().encode(text, encoder);
  TableEncoder table_encoder(encoder);
  for (const NumberTable& table : tables) table_encoder.encode(table);
  for (const std::string& bytes : heights) {
    if (bytes.size() >= kMostHeightBytes) {
      throw WorkError("the recipe is too large for a compact file; write it as .json");
    }
    encoder.encode_uniform(bytes.size(), kMostHeightBytes);
    for (const char byte : bytes) encoder.encode_uniform(static_cast<unsigned char>(byte), 256);
  }
  return encoder.finish();
}

json decoded(std::string_view bytes, const std::string& name) {
  RangeDecoder decoder(bytes);
  const std::uint64_t size = decoder.decode_number();
  if (size > kMaxCompactText) throw DamagedStream();
  json document = parse_json(primed_model().decode(static_cast<std::size_t>(size), decoder), name);
  TableReturner(decoder).fill(document);
  return_heights(document, decoder);
  return document;
}

}  // namespace

bool is_compact(std::string_view bytes) { return bytes.substr(0, kMagic.size()) == kMagic; }

std::string compact_document(const json& document) {
  json rest = document;
  std::vector<NumberTable> tables;
  std::vector<std::string> heights;
  take_heights(rest, heights);
  take_tables(rest, tables);
  const std::string stream = encoded(rest, tables, heights);
  const std::uint16_t check = checksum(stream);
  std::string bytes(kMagic);
  for (const unsigned char byte :
       {kCompactVersion, static_cast<unsigned char>(check >> 8), static_cast<unsigned char>(check & 0xff)}) {
    bytes += static_cast<char>(byte);
  }
  return bytes + stream;
}

json parse_compact(std::string_view bytes, const std::string& name) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  if (bytes.size() > kMagic.size() && byte(kMagic.size()) != kCompactVersion) {
    throw InputError(fmt::format(
        "{}: is a compact recipe of version {}, this program reads {}; use the program version that "
        "wrote the file",
        name, byte(kMagic.size()), kCompactVersion));
  }
  const InputError damaged(name + ": is a damaged compact recipe; copy it or write it again");
  if (bytes.size() < kHeaderBytes) throw damaged;
  const std::string_view stream = bytes.substr(kHeaderBytes);
  if (checksum(stream) != (byte(4) << 8 | byte(5))) throw damaged;
  try {
    return decoded(stream, name);
  } catch (const DamagedStream&) {
    throw damaged;
  }
}

}  // namespace astrolith
