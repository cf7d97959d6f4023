#include "apps/synth/synth_preview.h"

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/srgb.h"
#include "synthesis/field/field_mesh.h"
#include "tasks/job/output_names.h"
#include "tasks/job/pixel_size.h"

namespace astrolith {
namespace {

Vec3f linear_color(const VertexColor& color) {
  const auto linear = [](std::uint8_t byte) { return static_cast<float>(linear_of_srgb(byte / 255.0)); };
  return {linear(color[0]), linear(color[1]), linear(color[2])};
}

PixelSize size_of_maps(const std::string& text) {
  return parse_pixel_size("--maps-size", text, kLeastPictureSide, kMostPictureSide);
}

// Pictures of members are smaller unless a size is given: many are made, of meshes of few triangles. Pictures
// for training show the body alone, and their pixels are those of their maps.
PreviewOptions picture_options(const Program& program, const PreviewRequest& request,
                               const TriangleMesh& mesh, const std::string& unit) {
  PreviewOptions options = request.look.options(program, mesh, unit);
  const bool of_member = program.app.option("--members").count() > 0;
  if (of_member && request.look.size.empty()) options.width = 640, options.height = 480;
  if (of_member || !request.maps.empty()) options.marks = {};
  return options;
}

}  // namespace

void declare_preview_options(Program& program, PreviewRequest& request) {
  program.app
      .add_option("--preview", request.file,
                  "also a picture of the mesh under sunlight, with shadows: from +x, +y, +z and obliquely, a "
                  "patch from above its ground and obliquely")
      .placeholder("FILE.png")
      .writes();
  request.look.add_to(program.app);
  program.app.option("--picture-size").placeholder("WxH (default 1280x960, 640x480 of --members)");
  program.app
      .add_option("--preview-maps", request.maps,
                  "also what each pixel of the picture shows, for numpy.load: depth, normal, layer, and "
                  "instance, the row of the --feature-list; with the cameras")
      .placeholder("FILE.npz")
      .writes();
  program.app.add_option("--maps-size", request.maps_size, "pixels of the maps")
      .placeholder("WxH (default that of the picture)")
      .default_text("");
}

void check_preview(const Program& program, const PreviewRequest& request) {
  const bool has_picture = !request.file.empty(), has_maps = !request.maps.empty();
  request.look.check(program, has_picture, "add --preview FILE.png");
  if (has_maps && !has_picture) {
    throw InputError("--preview-maps: is about a picture; add --preview FILE.png");
  }
  if (!request.maps_size.empty()) {
    if (!has_maps) throw InputError("--maps-size: is about maps; add --preview-maps FILE.npz");
    size_of_maps(request.maps_size);
  }
  if (has_picture) {
    require_extension(request.file, {".png"});
    require_writable(request.file);
  }
  if (has_maps) {
    require_extension(request.maps, {".npz"});
    require_writable(request.maps);
  }
}

PreviewOptions maps_options(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh) {
  PreviewOptions options = picture_options(program, request, mesh, "");
  options.marks = {};
  if (request.maps_size.empty()) return options;
  const PixelSize size = size_of_maps(request.maps_size);
  options.width = size.width;
  options.height = size.height;
  return options;
}

void require_cameras_outside(const Program& program, const PreviewRequest& request,
                             const ImplicitField& field) {
  if (request.file.empty() || !request.look.has_pinholes()) return;
  constexpr int kCells = 32;  // along the longest side of the body
  MeshStatistics made;
  const TriangleMesh coarse = coarse_mesh_of(field, kCells, &made);
  if (coarse.triangles.empty()) return;
  // Cameras that stand by the body's box are known to about a cell.
  const double deep = 2.0 * made.step;
  for (const Vec3d& place : pinhole_places(coarse, picture_options(program, request, coarse, ""))) {
    if (field.value(place) > deep) fail_inside();
  }
}

void require_cameras_outside(const Program& program, const PreviewRequest& request,
                             const TriangleMesh& mesh) {
  if (request.file.empty() || !request.look.has_pinholes()) return;
  require_cameras_outside(mesh, picture_options(program, request, mesh, ""));
}

void write_preview(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh,
                   const std::string& unit) {
  PreviewOptions options = picture_options(program, request, mesh, unit);
  for (const VertexColor& color : mesh.colors) options.vertex_colors.push_back(linear_color(color));
  request.look.write(program, render_picture(mesh, options, program.progress("preview")), request.file);
}

}  // namespace astrolith
