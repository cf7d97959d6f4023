// Bodies that nobody has seen, drawn from a population of measured ones.
#pragma once

#include <string>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

struct DonorShare {
  std::size_t body;  // its index in the population
  double share;      // of all donors' shares, which add up to 1
};

struct DrawnBody {
  Recipe recipe;                         // the given one with a morph in place of its population
  double diameter = 0.0;                 // of the sphere of equal volume, length units
  BodyClass kind = BodyClass::kRounded;  // of the donor with the largest share
  std::vector<DonorShare> donors;        // the largest share first
  int attempts = 1;
};

// A body drawn from the recipe's population, a function of the recipe and its seed alone:
//   1. The logarithms of the half axes are those of a random body, or as the conditions say, plus normal
//      numbers; kAxesSpread of the former.
//   2. Two or three donors have the weights exp(-d^2 / (2 kNearAxes^2)), with d the distance of their
//      logarithms of axes from these. None is stretched by more than kMostStretch along any axis.
//   3. Shares are those of a Dirichlet distribution of 1.5, mirrors are random, and bodies of two near axes
//   are
//      turned about the third. The roughness has a lognormal spread of kRoughnessSpread.
//   4. A body of several parts, with a handle or with a cavity on a mesh of kCheckCells is drawn anew.
// Its centre of mass is the origin, its longest axis about x and its shortest about z. Throws InputError,
// "population: draw: ...", where fewer than two bodies fulfil the conditions.
DrawnBody draw_body(const Recipe& recipe);

// The measured body whose ground a drawn one gets, or null where no body of the population has a relief. It
// is the most alike in size, class and, above all, of the roughest ground: models that are coarse or smooth
// look molten on others. A body that a camera measured is preferred.
const MeasuredBody* ground_donor(const DrawnBody& drawn, const BodyPopulation& population);

// The drawn recipe with the relief of the measured body below its other layers, laid as a likeness and as
// large in shares of the diameter. `donor` is the whole recipe of the measured body. Throws InputError, which
// names it by `donor_name`, where it holds no relief.
Recipe lay_ground(const DrawnBody& drawn, const MeasuredBody& measured, const Recipe& donor,
                  const std::string& donor_name);

}  // namespace astrolith
