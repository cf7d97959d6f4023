// Moisan's periodic plus smooth decomposition. The borders of an image do not match, and the jump between
// them draws a cross over its spectrum. The periodic component has the details of the image and no cross.
#pragma once

#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

struct PeriodicDecomposition {
  GreyImage periodic;  // same mean as the image
  GreyImage smooth;    // zero mean; periodic + smooth = image
};

// Solves (periodic Laplacian of smooth) = v, where v holds the jumps between opposite borders and is zero
// inside (Moisan, Periodic plus smooth image decomposition, JMIV 2011, eq. 11). Both sides of the image are
// >= 2.
PeriodicDecomposition decompose_periodic(const GreyImage& image);

}  // namespace astrolith
