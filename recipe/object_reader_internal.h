// Reads the fields of one JSON object into C++ values, and names what is missing, mistyped or unknown.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/vec3.h"
#include "recipe/place_internal.h"

namespace astrolith {

// A JSON value as a C++ value of the right type; ranges are checked by validate_recipe. Each throws
// InputError at `place`.
void read_value(const nlohmann::json& value, const Place& place, double& out);
void read_value(const nlohmann::json& value, const Place& place, int& out);
void read_value(const nlohmann::json& value, const Place& place, std::uint64_t& out);
void read_value(const nlohmann::json& value, const Place& place, bool& out);
void read_value(const nlohmann::json& value, const Place& place, std::string& out);
void read_value(const nlohmann::json& value, const Place& place, Vec3d& out);  // [x, y, z]
void expect_array(const nlohmann::json& value, const Place& place);
// An array of as many elements as there are names.
void expect_row(const nlohmann::json& value, const Place& place, const std::vector<std::string_view>& names);

template <typename T>
using ReadElement = void (*)(const nlohmann::json&, const Place&, T&);

template <typename T>
void read_elements(const nlohmann::json& value, const Place& place, std::vector<T>& out,
                   ReadElement<T> read_element) {
  expect_array(value, place);
  out.resize(value.size());
  for (std::size_t i = 0; i < out.size(); ++i) read_element(value[i], place.element(i), out[i]);
}

//   ObjectReader object(value, place);
//   object.require("spheres", spheres);
//   object.allow("iso_value", body.iso_value);   // keeps the default when absent
//   object.finish();
class ObjectReader {
 public:
  // `value` and `place` must outlive the reader.
  ObjectReader(const nlohmann::json& value, const Place& place);

  // The field's value, or null when it is absent.
  const nlohmann::json* find(std::string_view name);
  Place at(std::string_view name) const { return place_.field(name); }

  template <typename T>
  bool allow(std::string_view name, T& out) {
    const nlohmann::json* value = find(name);
    if (value != nullptr) read_value(*value, at(name), out);
    return value != nullptr;
  }
  template <typename T>
  bool allow(std::string_view name, std::optional<T>& out) {
    T value{};
    const bool there = allow(name, value);
    if (there) out = value;
    return there;
  }
  template <typename T>
  void require(std::string_view name, T& out) {
    if (!allow(name, out)) note_missing(name);
  }
  void note_missing(std::string_view name) { missing_.push_back(name); }

  // Unknown fields first, since a misspelt name is also a missing one.
  void finish() const;

 private:
  void fail_unknown(const std::string& name) const;

  const nlohmann::json& value_;
  const Place& place_;
  std::vector<std::string_view> known_;
  std::vector<std::string_view> missing_;
};

template <typename T>
void require_elements(ObjectReader& object, std::string_view name, std::vector<T>& out,
                      ReadElement<T> read_element) {
  if (const nlohmann::json* value = object.find(name))
    return read_elements(*value, object.at(name), out, read_element);
  object.note_missing(name);
}

}  // namespace astrolith
