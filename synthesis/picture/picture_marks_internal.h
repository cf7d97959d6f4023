// Draws the marks of a picture into it.
#pragma once

#include "synthesis/picture/preview.h"
#include "synthesis/picture/preview_rays_internal.h"

namespace astrolith {

// `length_per_pixel` is in lengths of the mesh.
void draw_marks(RgbaImage16& image, const PreviewOptions& options, const PreviewRays& rays,
                double length_per_pixel);

}  // namespace astrolith
