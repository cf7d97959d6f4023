// Walks over a text file line by line and, in a line, from one blank-separated word to the next.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "geometry/io/mesh_file_internal.h"

namespace astrolith {

// The number that the whole word spells, Fortran's 1.5D+03 included; infinite when it is too large for a
// double, nothing when it spells none. The words nan and inf are numbers here.
std::optional<double> parse_number(std::string_view word);

//   TextScanner scan(file);
//   while (scan.next_line()) { if (scan.word() == "v") x = scan.number("x"); }
class TextScanner {
 public:
  // A byte order mark at the start of the file is passed over.
  explicit TextScanner(const MeshFile& file) : file_(file), rest_(file.bytes) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }

  // Goes to the next line; false at the end of the file. A carriage return before the line feed is dropped.
  bool next_line();
  // Goes to the next line that holds a word not starting with comment; false at the end of the file.
  bool next_filled_line(char comment = '#');

  // The next word of the line; empty at its end.
  std::string_view word();
  // The next word, looked for on following lines too; empty at the end of the file.
  std::string_view word_anywhere();
  // True when the line has no more words.
  bool line_done();
  // True when the rest of the line is a comment.
  bool at_comment(char comment = '#') { return !line_done() && line_.front() == comment; }

  // The next word of the line as a finite number; what names it in messages.
  double number(std::string_view what) { return to_number(word(), what); }
  std::int64_t integer(std::string_view what) { return to_integer(word(), what); }
  Vec3d point();
  double to_number(std::string_view word, std::string_view what) const;
  std::int64_t to_integer(std::string_view word, std::string_view what) const;

  // Bytes from the current line's end to the end of the file.
  std::size_t bytes_left() const { return rest_.size(); }
  std::size_t bytes_in_file() const { return file_.bytes.size(); }
  std::string place() const { return "line " + std::to_string(line_number_); }
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const {
    file_.fail(place(), what, remedy);
  }
  // For a line that is wanted and not there.
  [[noreturn]] void fail_truncated(std::string_view wanted) const;

 private:
  const MeshFile& file_;
  std::string_view rest_;
  std::string_view line_;
  std::int64_t line_number_ = 0;
};

}  // namespace astrolith
