// Labels of the Planetary Data System: text of the form "NAME = VALUE" that ends in a line "END" (PDS3), or
// XML (PDS4). A label stands in front of its table or beside it.
#pragma once

#include <string>
#include <string_view>

#include "geometry/io/format_internal.h"

namespace astrolith {

// A label beside a file, of the same name with .lbl or .xml, whose text has the file's name in it. Both are
// empty where none is.
struct LabelBeside {
  std::filesystem::path path;
  std::string text;  // its first 256 kB
};
LabelBeside label_beside(const std::filesystem::path& file);

// Whether a label says that longitudes increase to the west: by POSITIVE_LONGITUDE_DIRECTION (PDS3) or
// <cart:longitude_direction> (PDS4), else by words on west longitudes and none on east longitudes.
bool says_west(std::string_view label);

bool begins_pds3_label(std::string_view bytes);

// The unit of the first column of lengths that a label of either kind describes: "m" or "km", among others;
// empty where it describes none.
std::string unit_in_label(std::string_view text);

// Moves a PDS3 label in front of the data into file.label and leaves blanks, so that lines keep their
// numbers. Throws InputError for a label without data.
void blank_label(MeshFile& file);

}  // namespace astrolith
