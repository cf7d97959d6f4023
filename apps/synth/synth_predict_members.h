// What a range of members of a family will take.
#pragma once

#include <filesystem>

#include "apps/program.h"
#include "apps/synth/synth_members.h"

namespace astrolith {

// States triangles, bytes of all files, memory and seconds of the whole range in the summary and in a line,
// from a few of its members: the first, the last and some between. Small ones are made in the temporary
// folder, and removed. Of larger ones the mesh is predicted, and the other files are made of a coarse mesh.
// Without a name for meshes, .ply is assumed, unless recipes alone are asked for. Throws what making them
// throws.
void predict_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                     const MemberFiles& files, const Recipe& recipe, const std::filesystem::path& file);

}  // namespace astrolith
