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
  std::string details = "auto";                    // what lies on a drawn body: --details
  bool like = false;                               // whether its ground ends as that of --like does
};

void declare_draw_options(Job& job, DrawOptions& options);

// Puts the conditions of the command line into the recipe's population. Throws InputError where the recipe
// has none, and for numbers that break its rules. `file` is that of the recipe.
void apply_conditions(const Job& job, const DrawOptions& options, const std::filesystem::path& file,
                      Recipe& recipe);

// The recipe of a drawn body with the ground that --details asks for: the relief of the measured body that is
// most like it, laid as a likeness, and below its heights the landforms of a known body of this size.
// `population` holds the measured bodies, and `file` is its file, beside which their recipes lie. Throws
// InputError where --details asks for a relief that no body has.
Recipe with_ground(Job& job, const DrawOptions& options, const FamilyMember& member,
                   const BodyPopulation& population, const std::filesystem::path& file);

// States a drawn body, its donors, class and diameter, in the summary and in words; nothing for other
// members.
void report_draw(Job& job, const FamilyMember& member);

}  // namespace astrolith
