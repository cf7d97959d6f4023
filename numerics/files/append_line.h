// Files of lines that several processes extend, such as the manifest of a set of bodies.
#pragma once

#include <filesystem>
#include <string_view>

namespace astrolith {

// Appends the line, which has no line break in it, and one line break. Processes that append to one file take
// turns. A last line that was cut short by a process that died is ended first, so that it stands alone. A
// line that cannot be written whole is taken back. Throws InputError where the file cannot be opened, and
// WorkError when the disk is full.
void append_line(const std::filesystem::path& file, std::string_view line);

}  // namespace astrolith
