// The part of synth that makes many bodies of a recipe, each with files of its own, and a manifest of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "synthesis/finish/family_member.h"
#include "tasks/synth/mesh_job.h"

namespace astrolith {

struct MembersRequest {
  std::string range;               // "A:B": members A to B - 1; empty = the recipe itself
  std::filesystem::path manifest;  // of finished members; empty = none
  std::filesystem::path folder;    // of their meshes; empty = as the names of the files say
};

// Where members come from.
struct MemberSource {
  const Recipe& recipe;               // what they have in common
  const std::filesystem::path& file;  // of the recipe, for messages
  // A member, and its figures in the job's summary. Several may be drawn at once.
  std::function<FamilyMember(Job& job, std::uint64_t number)> draw;
};

void declare_members_options(Job& job, MembersRequest& request);

// Throws InputError for a range without members and for a name that would be the same for all members;
// without a range for a name that has the mark of members.
void check_members(const MembersRequest& request, MeshJob mesh);

// Throws InputError for more members than a sheet shows, and for a name with the mark of members.
void check_sheet(const MembersRequest& request, const std::filesystem::path& sheet);

// Makes the members of the range that the manifest does not have yet, each by the mesh job with the member's
// number, in seven digits or more, for "{member}" in the names of its files. A member that fails is reported,
// and the others go on. Throws InputError where no member can be made.
void make_members(Job& job, const MembersRequest& request, const MeshJob& mesh, const MemberSource& source);

// States triangles, bytes of meshes and recipes, memory and seconds of the whole range in the summary and on
// stdout, from a few of its members. Without a name for meshes, .ply is assumed, unless recipes alone are
// asked for.
void predict_members(Job& job, const MembersRequest& request, const MeshJob& mesh,
                     const MemberSource& source);

}  // namespace astrolith
