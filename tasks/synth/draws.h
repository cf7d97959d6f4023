// Bodies drawn from a population of measured ones: the options of the draw, and what it says.
#pragma once

#include <filesystem>
#include <string>

#include "recipe/recipe.h"
#include "synthesis/finish/family_member.h"
#include "tasks/job/job.h"

namespace astrolith {

struct DrawOptions {
  std::string diameter, axes, kind, source, near;  // empty: as the population says
};

void declare_draw_options(Job& job, DrawOptions& options);

// Puts the conditions of the command line into the recipe's population. Throws InputError where the recipe
// has none, and for numbers that break its rules. `file` is that of the recipe.
void apply_conditions(const Job& job, const DrawOptions& options, const std::filesystem::path& file,
                      Recipe& recipe);

// States a drawn body, its donors, class and diameter, in the summary and in words; nothing for other
// members.
void report_draw(Job& job, const FamilyMember& member);

}  // namespace astrolith
