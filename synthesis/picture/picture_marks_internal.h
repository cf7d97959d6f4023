// Draws the marks of a picture into it.
#pragma once

#include "synthesis/picture/preview.h"
#include "synthesis/picture/preview_rays_internal.h"
#include "synthesis/picture/ray_scene_internal.h"

namespace astrolith {

void draw_marks(RgbaImage16& image, const PreviewOptions& options, const PreviewRays& rays,
                const RayScene& scene);

}  // namespace astrolith
