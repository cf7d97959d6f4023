#include <charconv>
#include <cmath>

#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

// True for blanks inside a line. Commas count as blanks, because they separate columns in some archived
// tables.
bool is_blank(char c) { return c == ' ' || c == '\t' || c == ',' || c == '\r' || c == '\v' || c == '\f'; }

void drop_plus(std::string_view& word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
}

// A number in Fortran's form, 1.5D+03 for 1.5e+03.
std::optional<double> parse_fortran(std::string_view word) {
  char copy[64];
  if (word.size() > sizeof copy) return {};
  for (std::size_t i = 0; i < word.size(); ++i) copy[i] = word[i] == 'D' || word[i] == 'd' ? 'e' : word[i];
  double value = 0.0;
  const auto [end, error] = std::from_chars(copy, copy + word.size(), value);
  if (error != std::errc() || end != copy + word.size()) return {};
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view word) {
  drop_plus(word);
  const char* const word_end = word.data() + word.size();
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word_end, value);
  if (error == std::errc::invalid_argument) return {};
  if (end != word_end) return parse_fortran(word);
  if (error == std::errc::result_out_of_range) {
    const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return tiny ? 0.0 : HUGE_VAL;
  }
  return value;
}

bool TextScanner::next_line() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++line_number_;
  return true;
}

bool TextScanner::next_filled_line(char comment) {
  while (next_line()) {
    if (!line_done() && line_.front() != comment) return true;
  }
  return false;
}

std::size_t TextScanner::words_left() const {
  std::size_t words = 0;
  bool inside = false;
  for (const char c : line_) {
    words += !inside && !is_blank(c) ? 1 : 0;
    inside = !is_blank(c);
  }
  return words;
}

bool TextScanner::line_done() {
  std::size_t start = 0;
  while (start < line_.size() && is_blank(line_[start])) ++start;
  line_.remove_prefix(start);
  return line_.empty();
}

std::string_view TextScanner::word() {
  if (line_done()) return {};
  std::size_t length = 1;
  while (length < line_.size() && !is_blank(line_[length])) ++length;
  const std::string_view result = line_.substr(0, length);
  line_.remove_prefix(length);
  return result;
}

std::string_view TextScanner::word_anywhere() {
  while (line_done()) {
    if (!next_line()) return {};
  }
  return word();
}

double TextScanner::to_number(std::string_view word, std::string_view what) const {
  if (word.empty()) fail(std::string(what) + " is missing", "complete the line");
  const std::optional<double> value = parse_number(word);
  if (!value) fail(std::string(what) + " is " + quoted(word) + ", not a number", "correct the line");
  if (!std::isfinite(*value)) fail(std::string(what) + " is " + quoted(word), "give finite numbers");
  return *value;
}

std::int64_t TextScanner::to_integer(std::string_view word, std::string_view what) const {
  if (word.empty()) fail(std::string(what) + " is missing", "complete the line");
  drop_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(std::string(what) + " is " + quoted(word) + ", not a whole number", "correct the line");
  }
  return value;
}

Vec3d TextScanner::point() {
  const double x = number("x");
  const double y = number("y");
  const double z = number("z");
  return {x, y, z};
}

void TextScanner::fail_truncated(std::string_view wanted) const {
  file_.fail("line " + std::to_string(line_number_ + 1),
             "the file ends where " + std::string(wanted) + " should stand",
             "it may be truncated: fetch it again");
}

}  // namespace astrolith
