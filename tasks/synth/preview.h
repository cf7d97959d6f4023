// The picture of synth's mesh, and its maps: depth, normal, layer and landform of each pixel.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/picture/preview.h"
#include "tasks/job/job.h"
#include "tasks/job/picture_options.h"
#include "tasks/synth/body_mesh.h"

namespace astrolith {

struct PreviewRequest {
  std::filesystem::path file;  // empty = none
  std::filesystem::path maps;  // of the same views, as numbers; empty = none
  std::string maps_size;       // WxH; empty = that of the picture
  PictureOptions look;
};

void declare_preview_options(Job& job, PreviewRequest& request);

// Throws InputError when the picture or its maps cannot be written, or when an option about the picture is
// given without --preview.
void check_preview(const Job& job, const PreviewRequest& request);

// Throws InputError for a pinhole deep inside the body of the field, whose mesh need not exist yet.
void require_cameras_outside(const Job& job, const PreviewRequest& request, const ImplicitField& field);
// Throws InputError for a pinhole inside the mesh.
void require_cameras_outside(const Job& job, const PreviewRequest& request, const TriangleMesh& mesh);

// Lengths of the mesh are in `unit`. Pictures of members and pictures with maps have no marks.
void write_preview(const Job& job, const PreviewRequest& request, const TriangleMesh& mesh,
                   const std::string& unit);

// Writes the maps of a part's mesh, whose cells have this side (length units), as NPZ, with these arrays (h x
// w pixels, v views):
//   depth (h, w) float32, normal (h, w, 3) float32, view (h, w) int8,
//   right, up, from, corner, eye (v, 3) float64, pixel () float64    as in synthesis/picture/picture_maps.h
//   layer (h, w) int32       the label of synthesis/field/surface_labels.h; -1 where the ray meets nothing
//   instance (h, w) int32    the row of the feature list, from 0; -1 for none
// An eroded mesh has no layer and no instance, because erosion moves what layers made; a line says so.
void write_preview_maps(Job& job, const PreviewRequest& request, const TriangleMesh& mesh,
                        const MeshPart& part, double cell);

}  // namespace astrolith
