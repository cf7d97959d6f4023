// The part of synth that makes many members of a family, each with files of its own, and a manifest of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/synth/synth_mesh.h"
#include "synthesis/finish/family_member.h"

namespace astrolith {

struct MembersRequest {
  std::string range;               // "A:B": members A to B - 1; empty = the recipe itself
  std::filesystem::path manifest;  // of finished members
  std::filesystem::path folder;    // of their meshes; empty = as the names of the files say
};

struct MemberRange {
  std::uint64_t begin = 0, end = 0;
};
// Throws InputError for a range without members.
MemberRange range_of(const MembersRequest& request);

// Sets what the family draws of a picture's light and view.
void set_light_and_view(const Family& family, const FamilyMember& member, PreviewRequest& preview);

// What each member writes. "{member}" in a name stands for the member's number in seven digits or more.
struct MemberFiles {
  std::filesystem::path mesh;    // empty = none
  std::filesystem::path recipe;  // empty = none
};

void declare_members_options(Program& program, MembersRequest& request);

// Throws InputError for a range without members, for a missing manifest unless members are only predicted,
// and for a name that would be the same for all members.
void check_members(const MembersRequest& request, const MeshRequest& mesh, const MemberFiles& files);

// Makes the folder of the summary, and throws InputError where the summary cannot be written.
void prepare_summary(const Program& program);

// Makes the members of the range that the manifest does not have yet. A member that fails is reported, and
// the others go on. `file` is the recipe's, for messages. Throws InputError where no member can be made.
void make_members(Program& program, const MembersRequest& request, const MeshRequest& mesh,
                  const MemberFiles& files, const Recipe& recipe, const std::filesystem::path& file);

}  // namespace astrolith
