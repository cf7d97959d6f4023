#include <algorithm>
#include <charconv>
#include <cmath>

#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == ';' || c == '\r' || c == '\v' || c == '\f'; }

// True for blanks inside a line. Commas count as blanks, because they separate columns in some archived
// tables.
bool is_blank(char c) { return is_space(c) || c == ','; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether a word between spaces is a number with a decimal comma: -1,5 or 1,5e3.
bool has_decimal_comma(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == word.npos || comma == 0 || !is_digit(word[comma - 1]) || word.find('.') != word.npos)
    return false;
  std::string pointed(word);
  pointed[comma] = '.';
  return is_digit(pointed[comma + 1]) && parse_number(pointed).has_value();
}

// A word of a line and the line behind it; the word is empty at the line's end.
template <typename Blank>
std::string_view take_word(std::string_view& line, Blank is_separator) {
  std::size_t start = 0, end = 0;
  while (start < line.size() && is_separator(line[start])) ++start;
  end = start;
  while (end < line.size() && !is_separator(line[end])) ++end;
  const std::string_view word = line.substr(start, end - start);
  line.remove_prefix(end);
  return word;
}

// The first number with a decimal comma in a line where spaces separate numbers; empty where commas separate
// them.
std::string_view decimal_comma_in(std::string_view line) {
  std::string_view found;
  int numbers = 0;
  while (true) {
    const std::string_view word = take_word(line, is_space);
    if (word.empty() || word.front() == '#') return numbers > 1 ? found : std::string_view();
    if (word.front() == ',' || word.back() == ',') return {};
    if (!is_digit(word.back())) continue;
    ++numbers;
    if (found.empty() && has_decimal_comma(word)) found = word;
  }
}

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

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

bool TextScanner::next_piece() {
  goes_on_ = false;
  if (rest_.empty()) return false;
  if (feed_from_end_ > rest_.size()) {
    const std::size_t feed = rest_.find('\n');
    feed_from_end_ = feed == rest_.npos ? 0 : rest_.size() - feed;
  }
  const std::string_view to_feed = rest_.substr(0, rest_.size() - feed_from_end_);
  const std::size_t end = std::min(to_feed.find('\r'), to_feed.size());
  line_ = whole_line_ = rest_.substr(0, end);
  rest_.remove_prefix(end);
  const bool in_return_and_feed = rest_.starts_with("\r\n");
  if (line_number_ == 0) ends_in_returns_ = rest_.starts_with('\r') && !in_return_and_feed;
  rest_.remove_prefix(std::min(rest_.size(), in_return_and_feed && !ends_in_returns_ ? 2ul : 1ul));
  ++line_number_;
  commas_were_seen_ = false;
  if (!joins_lines_) return true;
  std::size_t last = line_.size();
  while (last > 0 && is_space(line_[last - 1])) --last;
  goes_on_ = last > 1 && line_[last - 1] == '\\' && (is_blank(line_[last - 2]) || is_digit(line_[last - 2]));
  if (goes_on_) line_ = line_.substr(0, last - 1);
  return true;
}

bool TextScanner::next_line() {
  while (goes_on_) next_piece();
  return next_piece();
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
  do {
    std::size_t start = 0;
    while (start < line_.size() && is_blank(line_[start])) ++start;
    line_.remove_prefix(start);
  } while (line_.empty() && goes_on_ && next_piece());
  return line_.empty();
}

std::string_view TextScanner::word() {
  if (line_done()) return {};
  const std::string_view result = take_word(line_, is_blank);
  if (!commas_were_seen_ && line_.starts_with(',') && is_digit(result.back())) refuse_decimal_commas();
  return result;
}

std::string_view TextScanner::whole_line() {
  if (!commas_were_seen_ && whole_line_.find(',') != whole_line_.npos) refuse_decimal_commas();
  return whole_line_;
}

void TextScanner::refuse_decimal_commas() {
  commas_were_seen_ = true;
  const std::string_view number = decimal_comma_in(whole_line_);
  if (number.empty()) return;
  fail("the number " + quoted(number) + " has a decimal comma",
       "write decimal points, and blanks or commas between numbers");
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
  if (!value) {
    fail(std::string(what) + " is " + quoted(word) + ", not a number",
         word.find(',') == word.npos ? "correct the line" : "write a decimal point");
  }
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
