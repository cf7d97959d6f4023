// Reads a text file line by line and, in each line, word by word. Blanks separate words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/io/format_internal.h"

namespace astrolith {

// The number that the whole word spells, Fortran's 1.5D+03 included. A number too large for a double gives
// infinity, and a word that is no number gives nothing. The words nan and inf count as numbers here.
std::optional<double> parse_number(std::string_view word);

//   TextScanner scan(file);
//   while (scan.next_line()) { if (scan.word() == "v") x = scan.number("x"); }
class TextScanner {
 public:
  // Skips a byte order mark at the start of the file.
  explicit TextScanner(const MeshFile& file) : file_(file), rest_(file.bytes) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }

  // Goes to the next line and drops the carriage return before its line feed. False at the end of the file.
  bool next_line();
  // Goes to the next line that holds a word and is no comment. False at the end of the file.
  bool next_filled_line(char comment = '#');

  // The next word of the line; empty at its end.
  std::string_view word();
  // The next word, on this line or a following one; empty at the end of the file.
  std::string_view word_anywhere();
  // The number of words from here to the end of the line.
  std::size_t words_left() const;
  // True when the line has no more words.
  bool line_done();
  // True when the rest of the line is a comment.
  bool at_comment(char comment = '#') { return !line_done() && line_.front() == comment; }

  // The next word of the line as a finite number. `what` names it in error messages.
  double number(std::string_view what) { return to_number(word(), what); }
  std::int64_t integer(std::string_view what) { return to_integer(word(), what); }
  Vec3d point();
  double to_number(std::string_view word, std::string_view what) const;
  std::int64_t to_integer(std::string_view word, std::string_view what) const;

  // The number of bytes behind the current line.
  std::size_t bytes_left() const { return rest_.size(); }
  std::size_t bytes_in_file() const { return file_.bytes.size(); }
  std::string place() const { return "line " + std::to_string(line_number_); }
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const {
    file_.fail(place(), what, remedy);
  }
  // Throws InputError: the file ends where `wanted` should stand.
  [[noreturn]] void fail_truncated(std::string_view wanted) const;

 private:
  const MeshFile& file_;
  std::string_view rest_;
  std::string_view line_;
  std::int64_t line_number_ = 0;
};

}  // namespace astrolith
