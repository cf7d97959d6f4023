// The picture of synth's mesh.
#pragma once

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "apps/program.h"
#include "geometry/triangle_mesh.h"
#include "synthesis/picture/preview.h"

namespace astrolith {

using Direction = std::tuple<double, double, double>;

struct PreviewRequest {
  std::filesystem::path file;    // empty = none
  std::filesystem::path maps;    // of the same view, as numbers; empty = none
  std::vector<Direction> views;  // from the body to the viewer; empty = usual_views()
  std::string size;              // WxH; empty = the default
  Direction sun{-0.75, 0.45, 0.55};
};

void declare_preview_options(Program& program, PreviewRequest& request);

// Throws InputError when the picture or its maps cannot be written, or when an option about the picture is
// given without --preview.
void check_preview(const Program& program, const PreviewRequest& request);

// The size, the views and the sun of the request, without colours.
PreviewOptions preview_options(const Program& program, const PreviewRequest& request,
                               const TriangleMesh& mesh);

void write_preview(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh);

}  // namespace astrolith
