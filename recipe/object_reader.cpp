#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "recipe/object_reader_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

// "an array", "the string \"Km\"": what stands in the file.
std::string description(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return fmt::format("an array of {}", value.size());
    case json::value_t::string:
      return "the string " + quote_text(value.get_ref<const std::string&>());
    default:
      return value.dump();
  }
}

[[noreturn]] void fail_type(const json& value, const Place& place, std::string_view wanted) {
  place.fail(fmt::format("must be {}, is {}", wanted, description(value)));
}

// An integer, also when written as 8.0 or 1e3, in [low, high]; both bounds are exact as doubles.
double integral(const json& value, const Place& place, double low, double high) {
  if (!value.is_number()) fail_type(value, place, "an integer");
  const double number = value.get<double>();
  if (number != std::floor(number)) fail_type(value, place, "an integer");
  if (number < low || number > high) {
    fail_type(value, place, fmt::format("an integer from {:.0f} to {:.0f}", low, high));
  }
  return number;
}

// Levenshtein's edit distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

void read_value(const json& value, const Place& place, double& out) {
  if (!value.is_number()) fail_type(value, place, "a number");
  out = value.get<double>();
}

void read_value(const json& value, const Place& place, int& out) {
  constexpr std::numeric_limits<int> kRange;
  out = static_cast<int>(integral(value, place, kRange.min(), kRange.max()));
}

void read_value(const json& value, const Place& place, std::uint64_t& out) {
  out = static_cast<std::uint64_t>(integral(value, place, 0.0, 0x1.0p53 - 1.0));
}

void read_value(const json& value, const Place& place, bool& out) {
  if (!value.is_boolean()) fail_type(value, place, "true or false");
  out = value.get<bool>();
}

void read_value(const json& value, const Place& place, std::string& out) {
  if (!value.is_string()) fail_type(value, place, "a string");
  out = value.get<std::string>();
}

void read_value(const json& value, const Place& place, Vec3d& out) {
  expect_row(value, place, {"x", "y", "z"});
  read_value(value[0], place.field("x"), out.x);
  read_value(value[1], place.field("y"), out.y);
  read_value(value[2], place.field("z"), out.z);
}

void expect_array(const json& value, const Place& place) {
  if (!value.is_array()) fail_type(value, place, "an array");
}

void expect_row(const json& value, const Place& place, const std::vector<std::string_view>& names) {
  if (!value.is_array() || value.size() != names.size()) {
    fail_type(value, place, fmt::format("[{}]", fmt::join(names, ", ")));
  }
}

ObjectReader::ObjectReader(const json& value, const Place& place) : value_(value), place_(place) {
  if (!value.is_object()) fail_type(value, place, "an object");
}

const json* ObjectReader::find(std::string_view name) {
  known_.push_back(name);
  const auto found = value_.find(name);
  return found == value_.end() ? nullptr : &*found;
}

void ObjectReader::finish() const {
  for (const auto& [name, unused] : value_.items()) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) fail_unknown(name);
  }
  if (!missing_.empty()) at(missing_.front()).fail("is missing; add it");
}

void ObjectReader::fail_unknown(const std::string& name) const {
  const std::string_view shown = std::string_view(name).substr(0, 64);  // bounds the comparison below
  const auto nearest = std::min_element(known_.begin(), known_.end(), [&](auto a, auto b) {
    return edit_distance(shown, a) < edit_distance(shown, b);
  });
  const std::string inner = quote_text(name);
  const Place here = at(std::string_view(inner).substr(1, inner.size() - 2));
  if (edit_distance(shown, *nearest) <= std::max<std::size_t>(2, nearest->size() / 3)) {
    here.fail(fmt::format("unknown field; did you mean '{}'?", *nearest));
  }
  here.fail(fmt::format("unknown field; known are {}", fmt::join(known_, ", ")));
}

}  // namespace astrolith
