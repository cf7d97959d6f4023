#include "apps/synth/synth_preview.h"

#include "apps/output_names.h"
#include "apps/synth/pixel_size.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/srgb.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace {

Vec3f linear_color(const VertexColor& color) {
  const auto linear = [](std::uint8_t byte) { return static_cast<float>(linear_of_srgb(byte / 255.0)); };
  return {linear(color[0]), linear(color[1]), linear(color[2])};
}

PixelSize picture_size(const std::string& text) {
  return parse_pixel_size("--picture-size", text, kLeastPictureSide, kMostPictureSide);
}

Vec3d vector_of(const Direction& d) { return {std::get<0>(d), std::get<1>(d), std::get<2>(d)}; }

}  // namespace

void declare_preview_options(Program& program, PreviewRequest& request) {
  program.app
      .add_option("--preview", request.file,
                  "also a picture of the mesh under sunlight, with shadows: from +x, +y, +z and obliquely, a "
                  "patch from above its ground and obliquely")
      .placeholder("FILE.png");
  program.app.add_option("--picture-size", request.size, "pixels of the picture and its maps")
      .placeholder("WxH (default 1280x960)")
      .default_text("");
  program.app
      .add_option("--preview-maps", request.maps,
                  "also what each pixel of the picture shows, for numpy.load: depth, normal, layer, and "
                  "instance, the row of the --feature-list; with the cameras")
      .placeholder("FILE.npz");
  program.app
      .add_option("--view", request.views,
                  "look from this direction in the picture instead; may be given several times")
      .placeholder("X Y Z")
      .default_text("");
  program.app
      .add_option("--sun", request.sun, "towards the sun, in the axes of each view: right, up, to the viewer")
      .placeholder("X Y Z (default -0.75 0.45 0.55)")
      .default_text("");
}

void check_preview(const Program& program, const PreviewRequest& request) {
  if (request.file.empty()) {
    for (const char* name : {"--preview-maps", "--picture-size", "--view", "--sun"}) {
      if (program.app.option(name).count() > 0) {
        throw InputError(std::string(name) + ": is about a picture; add --preview FILE.png");
      }
    }
    return;
  }
  if (!request.size.empty()) picture_size(request.size);
  require_extension(request.file, {".png"});
  require_writable(request.file);
  if (!request.maps.empty()) {
    require_extension(request.maps, {".npz"});
    require_writable(request.maps);
  }
  for (const Direction& view : request.views) {
    if (!(squared_norm(vector_of(view)) > 0.0))
      throw InputError("--view: 0 0 0 is no direction; give another");
  }
  if (!(squared_norm(vector_of(request.sun)) > 0.0))
    throw InputError("--sun: 0 0 0 is no direction; give another");
}

PreviewOptions preview_options(const Program& program, const PreviewRequest& request,
                               const TriangleMesh& mesh) {
  PreviewOptions options;
  if (!request.size.empty()) {
    const PixelSize size = picture_size(request.size);
    options.width = size.width;
    options.height = size.height;
  }
  options.seed = program.seed;
  options.sun = vector_of(request.sun);
  options.views.clear();
  if (request.views.empty()) {
    options.views = usual_views(mesh);
  } else {
    for (const Direction& view : request.views) options.views.push_back(view_from(vector_of(view)));
  }
  return options;
}

void write_preview(const Program& program, const PreviewRequest& request, const TriangleMesh& mesh) {
  PreviewOptions options = preview_options(program, request, mesh);
  for (const VertexColor& color : mesh.colors) options.vertex_colors.push_back(linear_color(color));
  write_png8_rgb(render_preview(mesh, options, program.progress("preview")), request.file);
}

}  // namespace astrolith
