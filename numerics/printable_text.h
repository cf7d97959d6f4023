// Text of files and file names as one line that a terminal can show.
#pragma once

#include <string>
#include <string_view>

namespace astrolith {

// The text on one line, with an escape in place of everything that could hide, reorder or break the line:
//   \n \r \t          line break, carriage return, tab
//   \x1b \xff         other ASCII controls, and bytes that are not UTF-8
//   \u202e \U000e0041 C1 controls, format characters (bidirectional marks, zero-width and tag characters),
//                     line and paragraph separators, and noncharacters of Unicode
// All other characters stay as they are, backslashes included.
std::string printable(std::string_view text);

}  // namespace astrolith
