#include "recipe/json_document_internal.h"

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
#include "recipe/place_internal.h"

namespace astrolith {
namespace {

struct Complaint {
  std::string_view sign;         // part of the library's message
  std::string_view explanation;  // {} is the word at which the library stopped
};

// The first complaint whose sign stands in the library's message explains it.
constexpr Complaint kComplaints[] = {
    {"unexpected end of input", "the text ends in the middle of a value; is the file cut off?"},
    {"missing closing quote", "the text {} has no closing quote; add it"},
    {"control character", "a text holds a line break or a tab; write \\n or \\t, or close its quote"},
    {"ill-formed UTF-8", "a text is not UTF-8; save the file as UTF-8"},
    {"invalid BOM", "the file begins with bytes that no text begins with; save it as UTF-8"},
    {"forbidden character after backslash",
     "{} has a backslash that means nothing; write \\\\ for a backslash"},
    {"'\\u' must be followed", "{} has \\u without four hexadecimal digits; add them"},
    {"surrogate", "{} has \\u codes that are half of a character; write the character itself"},
    {"number overflow", "the number {} is too large; write a smaller one"},
    {"invalid number", "{} is no number; write it like -0.5 or 2e-3"},
    {"invalid comment", "a comment begins and is none; JSON has no comments, remove it"},
    {"expected end of input", "{} stands behind the end of the recipe; remove it"},
    {"parsing object key", "{} stands where a field's name should, in quotes; is there a comma too many?"},
    {"invalid literal", "{} is no value; write a number, true, false or a text in quotes"},
    {"parsing object separator", "{} stands where the colon after a field's name should; add it"},
    {"parsing object", "{} stands where a comma or a closing brace should; add it"},
    {"parsing array", "{} stands where a comma or a closing bracket should; add it"},
};

// The word or the mark at `position`, which counts from 1.
std::string_view word_at(std::string_view text, std::size_t position) {
  constexpr std::string_view kEnds = " \t\r\n,:[]{}";
  const std::size_t at = std::min(position, text.size());
  if (at == 0) return {};
  if (kEnds.find(text[at - 1]) != std::string_view::npos) return text.substr(at - 1, 1);
  const std::size_t before = text.substr(0, at).find_last_of(kEnds);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  return text.substr(begin, text.find_first_of(kEnds, begin) - begin);
}

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

std::string explain_json_problem(std::string_view problem, std::string_view text, std::size_t position) {
  const std::string word = quote_text(word_at(text, position));
  for (const Complaint& complaint : kComplaints) {
    if (problem.find(complaint.sign) != std::string_view::npos) {
      return fmt::format(fmt::runtime(complaint.explanation), word);
    }
  }
  return fmt::format("{} stands where a value should; write one, or remove a comma", word);
}

}  // namespace astrolith
