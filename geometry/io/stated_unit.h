// The length unit that a mesh file states about itself.
#pragma once

#include <filesystem>
#include <string>

namespace astrolith {

// The unit in the comment "length unit: km" that write_mesh() writes in front of a .ply, .obj or .stl, .zst
// or not. Any word of up to 8 letters is one. Empty where the file states none or cannot be read. Looks at
// the first 4,096 bytes of the content only.
std::string stated_length_unit(const std::filesystem::path& file);

// Whether a file of this name that write_mesh() writes tells its unit: in the comment above, or by its
// format, as a .glb is in metres. False for an extension that is not written.
bool tells_length_unit(const std::filesystem::path& file);

}  // namespace astrolith
