// Reads a text file line by line and, in each line, word by word. Blanks separate words, and so do commas and
// semicolons. A line ends in a line feed, a carriage return or both.
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

// The word with A to Z as a to z.
std::string lower_case(std::string_view word);

//   TextScanner scan(file);
//   while (scan.next_line()) { if (scan.word() == "v") x = scan.number("x"); }
class TextScanner {
 public:
  // Skips a byte order mark at the start of the file. With `joins_lines`, a backslash at the end of a line
  // behind a blank or a digit means that the line goes on below. (The name of a folder may end in one, too.)
  explicit TextScanner(const MeshFile& file, bool joins_lines = false)
      : file_(file), rest_(file.bytes), joins_lines_(joins_lines) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }

  // Goes to the next line. False at the end of the file.
  bool next_line();
  // Goes to the next line that holds a word and is no comment. False at the end of the file.
  bool next_filled_line(char comment = '#');

  // The next word of the line; empty at its end. Throws InputError in a line whose numbers have decimal
  // commas.
  std::string_view word();
  // The next word, on this line or a following one; empty at the end of the file.
  std::string_view word_anywhere();
  // The whole line. Throws InputError where its numbers have decimal commas.
  std::string_view whole_line();
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
  // Goes to the next line of the file, which may go on another.
  bool next_piece();
  void refuse_decimal_commas();

  const MeshFile& file_;
  std::string_view rest_;
  std::string_view line_, whole_line_;
  // Bytes from the next line feed to the file's end; 0 where none follows.
  std::size_t feed_from_end_ = std::string_view::npos;
  std::int64_t line_number_ = 0;
  bool joins_lines_;
  bool goes_on_ = false;           // the line goes on below
  bool ends_in_returns_ = false;   // the first line ends in a carriage return alone
  bool commas_were_seen_ = false;  // in this line: it is looked at once
};

}  // namespace astrolith
