// What a kind of noise is, as the field asks it. Each kind states its traits in its struct, as `kTraits`. The
// table of kinds (LayerNoise, synthesis/field/field_tables.h) takes no kind without them.
#pragma once

#include "numerics/stated.h"

namespace astrolith {

// The lists of elements that a kind of noise needs in every block (BlockLists,
// synthesis/field/field_tables.h).
enum class NoiseLists { kNone, kSpots, kGabor, kCraters };

struct NoiseTraits {
  // Whether heights belong to the surface: a point has the height at its projection on the bare body, and no
  // warp displaces it. Other noise belongs to space, and is evaluated at the point after all warps so far.
  Stated<bool> on_surface;
  // Whether points may be lifted to the surface that the layers below make. The noise then has a member
  // `lifted`, which tells whether they are.
  Stated<bool> lifts;
  // Whether the noise has heights that join the elevation (layer_join.h). Other kinds change the elevation by
  // a rule of their own.
  Stated<bool> has_heights;
  // Whether bounds over a box depend on the box: the one of the points, or of their projections if
  // on_surface.
  Stated<bool> bounded_by_box;
  // Whether the noise of the body's frame can be evaluated at coordinates local to a patch. It then has a
  // has_local_form(), whether its parameters allow that, an evaluate_local_heights() and a local_form().
  Stated<bool> local_form;
  Stated<NoiseLists> lists;
};

}  // namespace astrolith
