// The part of synth that makes many members of a family, each with files of its own, and a manifest of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/synth/synth_mesh.h"

namespace astrolith {

struct MembersRequest {
  std::string range;               // "A:B": members A to B - 1; empty = the recipe itself
  std::filesystem::path manifest;  // of finished members
  std::filesystem::path folder;    // of their meshes; empty = as the names of the files say
};

// What each member writes. "{member}" in a name stands for the member's number in seven digits or more.
struct MemberFiles {
  std::filesystem::path mesh;    // empty = none
  std::filesystem::path recipe;  // empty = none
};

void declare_members_options(Program& program, MembersRequest& request);

// Throws InputError for a range without members, for a missing manifest unless members are only predicted,
// and for a name that would be the same for all members.
void check_members(const MembersRequest& request, const MeshRequest& mesh, const MemberFiles& files);

// Makes the members of the range that the manifest does not have yet. A member that fails is reported, and
// the others go on. `file` is the recipe's, for messages. Throws InputError where no member can be made.
void make_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                  const MemberFiles& files, const Recipe& recipe, const std::filesystem::path& file);

// States triangles, bytes of meshes and recipes, memory and seconds of the whole range in the summary and on
// stdout, from a few of its members. Without a name for meshes, .ply is assumed, unless recipes alone are
// asked for.
void predict_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                     const MemberFiles& files, const Recipe& recipe, const std::filesystem::path& file);

}  // namespace astrolith
