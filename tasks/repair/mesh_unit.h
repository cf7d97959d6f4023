// The unit of a mesh's lengths, by --unit or by its file.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "tasks/job/job.h"

namespace astrolith {

struct UnitChoice {
  std::string given;             // by --unit; empty where it is not
  std::string otherwise = "km";  // where neither --unit nor the file says one
};

struct MeshUnit {
  std::string name;
  bool assumed = false;  // neither given nor stated: programs say so (unit_question.h)
};

// The unit of a mesh's lengths: the given one, else what the file or its label states, else `otherwise`. Says
// so where the file states another unit than the given one, and where a label decides. Throws InputError
// where the file's unit decides and is none of `units`; any unit will do where these are none.
MeshUnit unit_of_mesh(const Job& job, const std::filesystem::path& file, const UnitChoice& choice,
                      std::initializer_list<std::string_view> units);

}  // namespace astrolith
