// The picture of synth's mesh.
#pragma once

#include <filesystem>
#include <string>

#include "apps/program.h"
#include "geometry/triangle_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/picture/preview.h"
#include "tasks/synthesis/picture_options.h"

namespace astrolith {

struct PreviewRequest {
  std::filesystem::path file;  // empty = none
  std::filesystem::path maps;  // of the same views, as numbers; empty = none
  std::string maps_size;       // WxH; empty = that of the picture
  PictureOptions look;
};

void declare_preview_options(Program& program, PreviewRequest& request);

// Throws InputError when the picture or its maps cannot be written, or when an option about the picture is
// given without --preview.
void check_preview(const Program& program, const PreviewRequest& request);

// Throws InputError for a pinhole deep inside the body of the field, whose mesh need not exist yet.
void require_cameras_outside(const Program& program, const PreviewRequest& request,
                             const ImplicitField& field);
// Throws InputError for a pinhole inside the mesh.
void require_cameras_outside(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh);

// Lengths of the mesh are in `unit`. Pictures of members and pictures with maps have no marks.
void write_preview(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh,
                   const std::string& unit);

// The cameras of the request with the size of its maps.
PreviewOptions maps_options(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh);

}  // namespace astrolith
