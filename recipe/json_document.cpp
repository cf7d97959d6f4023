#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "recipe/json_document_internal.h"
#include "recipe/place_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

// Builds the tree from the parser's events and throws at the first breach of a limit.
class TreeBuilder : public nlohmann::json_sax<json> {
 public:
  TreeBuilder(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // JSON text has no binary values
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    if (open_.back()->contains(value)) {
      throw InputError(fmt::format("{}: the field {} stands twice in one object; remove one of them", name_,
                                   quote_text(value)));
    }
    key_ = std::move(value);
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const json::exception& error) override {
    const std::string_view before = text_.substr(0, position > 0 ? position - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    throw InputError(fmt::format("{}: line {}, column {}: not valid JSON: {}", name_, line,
                                 before.size() - line_start + 1,
                                 explain_json_problem(error.what(), text_, position)));
  }

  json take() { return std::move(root_); }

 private:
  bool add(json value) {
    place(std::move(value));
    return true;
  }
  bool open(json container) {
    if (open_.size() >= kMaxJsonDepth) {
      throw InputError(
          fmt::format("{}: nested deeper than {} levels; this is no recipe", name_, kMaxJsonDepth));
    }
    open_.push_back(place(std::move(container)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  // Parents never grow while one of their children is open, so pointers to open containers stay valid.
  json* place(json value) {
    if (++values_ > kMaxJsonValues) {
      throw InputError(fmt::format("{}: more than {} values; use fewer spheres", name_, kMaxJsonValues));
    }
    if (open_.empty()) return &(root_ = std::move(value));
    json& parent = *open_.back();
    if (parent.is_object()) return &(parent[std::exchange(key_, {})] = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }

  std::string_view text_;
  const std::string& name_;
  json root_;
  std::vector<json*> open_;
  std::string key_;
  std::size_t values_ = 0;
};

}  // namespace

std::string read_json_text(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) { throw InputError(file.string() + ": " + why); };
  require_plain_file(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) refuse(fmt::format("cannot be read ({}); check its rights", std::strerror(errno)));
  std::string text;
  std::vector<char> chunk(std::size_t{1} << 16);
  while (const std::size_t count = std::fread(chunk.data(), 1, chunk.size(), stream.get())) {
    text.append(chunk.data(), count);
    if (text.size() > kMaxJsonBytes) {
      refuse(fmt::format("larger than {} MB; this is no recipe", kMaxJsonBytes >> 20));
    }
  }
  if (std::ferror(stream.get()) != 0) refuse("cannot read; check the disk");
  return text;
}

json parse_json(std::string_view text, const std::string& name) {
  if (text.size() > kMaxJsonBytes) {
    throw InputError(fmt::format("{}: larger than {} MB; this is no recipe", name, kMaxJsonBytes >> 20));
  }
  TreeBuilder builder(text, name);
  json::sax_parse(text.begin(), text.end(), &builder);
  return builder.take();
}

std::string json_string(std::string_view text) {
  return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace astrolith
