#include "tasks/job/picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "tasks/job/output_names.h"
#include "tasks/job/pixel_size.h"

namespace astrolith {
namespace {

constexpr const char* kPictureOptions[] = {
    "--picture-size", "--picture-bits", "--camera",     "--view",     "--sun", "--sun-body", "--phase",
    "--reflectance",  "--ambient",      "--background", "--no-marks", "--map", "--letters"};

constexpr int kMapHeight = 760;  // of 1280 pixels across: a map is as wide as two squares

Vec3d to_vector(const Direction& d) { return {std::get<0>(d), std::get<1>(d), std::get<2>(d)}; }

void require_direction(const char* option, const Vec3d& v) {
  const double square = squared_norm(v);
  if (!(square > 0.0) || !std::isfinite(square)) {
    throw InputError(std::string(option) + ": has no length, so it is no direction; give another");
  }
}

PixelSize picture_size(const std::string& text) {
  return parse_pixel_size("--picture-size", text, kLeastPictureSide, kMostPictureSide);
}

std::vector<Camera> parse_cameras(const std::vector<std::string>& words) {
  std::vector<Camera> cameras;
  for (const std::string& camera : words) cameras.push_back(parse_camera("--camera", camera));
  return cameras;
}

bool is_page(const std::filesystem::path& file) { return file.extension() != ".png"; }

}  // namespace

void PictureOptions::add_to(OptionTable& app) {
  app.add_option("--picture-size", size, "pixels of the picture")
      .placeholder("WxH (default 1280x960)")
      .default_text("");
  app.add_option("--picture-bits", bits, "bits of a channel of the picture").check(one_of({8, 16}));
  app.add_option("--camera", cameras,
                 "a camera, in words with their numbers: lat and lon in degrees, or from X Y Z, where it "
                 "stands over the body; roll in degrees; up X Y Z; target X Y Z, what it looks at (default "
                 "the middle of the mesh); with fov in degrees across the view a pinhole, whose distance is "
                 "in lengths of the mesh or radii in radii of the mesh (default as the mesh needs), or which "
                 "stands at X Y Z; may be given several times")
      .repeated()
      .placeholder("\"lat 20 lon 45 fov 30 radii 4\"")
      .default_text("");
  app.add_option("--view", views,
                 "look from this direction, along parallel lines; may be given several times")
      .placeholder("X Y Z")
      .default_text("");
  app.add_option(
         "--map", map,
         "a map in place of views: equirectangular, all longitudes and latitudes, or hemispheres, two "
         "by Lambert's projection, which keeps areas. Shows what is outermost in each direction from "
         "the origin, lit from the upper left, with lines every 30 degrees")
      .check(one_of({"equirectangular", "hemispheres"}))
      .placeholder("PROJECTION")
      .default_text("");
  app.add_option("--sun", sun, "towards the sun, in the axes of each view: right, up, to the viewer")
      .placeholder("X Y Z (default -0.75 0.45 0.55)")
      .default_text("");
  app.add_option("--sun-body", sun_body, "towards the sun, in the axes of the mesh")
      .expected(3)
      .placeholder("X Y Z")
      .default_text("");
  app.add_option("--phase", phase,
                 "the sun by its phase angle, 0 (behind the viewer) to 180 degrees, and its azimuth in the "
                 "picture, degrees counter-clockwise from up")
      .expected(2)
      .placeholder("ANGLE AZIMUTH")
      .default_text("");
  app.add_option(
         "--reflectance", reflectance,
         "lambert; lommel-seeliger, as of dark dust; rock, .35 of lommel-seeliger and .65 of lambert; "
         "akimov; or a law with its numbers: \"mcewen L .5\", \"minnaert k .7\", "
         "\"hapke w .2 g -.3 b0 .8 h .05 theta 20\" (theta in degrees)")
      .placeholder("LAW");
  app.add_option("--ambient", ambient, "light from everywhere as a share of sunlight; 0 leaves shadows black")
      .check(in_range(0.0, 10.0));
  app.add_option("--background", background, "behind the body")
      .check(one_of({"dark", "black", "white", "transparent"}));
  app.add_flag("--no-marks", no_marks, "without the scale of lengths, the axes and the degrees of maps");
  app.add_flag("--letters", letters, "(a), (b) ... in the corners of the views");
}

void PictureOptions::check(const Job& job, bool has_picture, const std::string& remedy) const {
  if (!has_picture) {
    for (const char* name : kPictureOptions) {
      if (job.options.option(name).count() > 0)
        throw InputError(std::string(name) + ": is about a picture; " + remedy);
    }
    return;
  }
  if (!size.empty()) picture_size(size);
  constexpr std::size_t kMostViews = 64;
  if (cameras.size() + views.size() > kMostViews) {
    throw InputError("--camera, --view: give at most 64 of them together");
  }
  if (!map.empty() && (cameras.size() + views.size() > 0 || chooses_sun(job)))
    throw InputError(
        "--map: shows all directions, lit from the upper left; leave out --camera, --view and the sun");
  parse_cameras(cameras);
  parse_reflectance("--reflectance", reflectance);
  for (const Direction& view : views) require_direction("--view", to_vector(view));
  require_direction("--sun", to_vector(sun));
  int suns = 0;
  for (const char* name : {"--sun", "--sun-body", "--phase"}) suns += job.options.option(name).count() > 0;
  if (suns > 1) throw InputError("--sun, --sun-body and --phase place one sun; give one of them");
  if (!sun_body.empty()) require_direction("--sun-body", {sun_body[0], sun_body[1], sun_body[2]});
  if (!phase.empty() && !(phase[0] >= 0.0 && phase[0] <= 180.0 && std::fabs(phase[1]) <= 360.0)) {
    throw InputError("--phase: the angle must be 0 to 180 degrees; the azimuth must be -360 to 360");
  }
}

PreviewOptions PictureOptions::options(const Job& job, const TriangleMesh& mesh,
                                       const std::string& unit) const {
  PreviewOptions made;
  if (!size.empty()) {
    const PixelSize pixels = picture_size(size);
    made.width = pixels.width;
    made.height = pixels.height;
  } else if (!map.empty()) {
    made.height = kMapHeight;
  }
  made.seed = job.seed;
  made.sun.direction = to_vector(sun);
  if (!sun_body.empty()) made.sun = {{sun_body[0], sun_body[1], sun_body[2]}, true};
  if (!phase.empty()) made.sun = sun_at_phase(phase[0], phase[1]);
  made.views = parse_cameras(cameras);
  for (const Direction& view : views) made.views.push_back(view_from(to_vector(view)));
  if (!map.empty() && usual_views(mesh).size() < standard_views().size())
    throw InputError("--map: is of a whole body, and this patch faces one way; leave it out");
  if (!map.empty())
    made.views =
        map_views(map == "hemispheres" ? MapProjection::kHemisphere : MapProjection::kEquirectangular);
  if (made.views.empty()) made.views = usual_views(mesh);
  made.ambient = ambient;
  made.reflectance = parse_reflectance("--reflectance", reflectance);
  made.transparent = background == "transparent";
  made.marks.axes = !no_marks;
  made.marks.letters = letters;
  if (!no_marks) made.marks.length_unit = unit;
  if (background == "black") made.background = {0, 0, 0};
  if (background == "white") made.background = {1, 1, 1};
  return made;
}

void PictureOptions::refuse_light(const Job& job, const std::string& colors) {
  for (const char* name : {"--ambient", "--reflectance"}) {
    if (job.options.option(name).count() > 0)
      throw InputError(std::string(name) + ": does nothing to colours that stand for numbers (" + colors +
                       "), which keep a faint relief; leave it out");
  }
}

bool PictureOptions::chooses_view(const Job& job) {
  return job.options.option("--camera").count() + job.options.option("--view").count() +
             job.options.option("--map").count() >
         0;
}

bool PictureOptions::chooses_sun(const Job& job) {
  return job.options.option("--sun").count() + job.options.option("--sun-body").count() +
             job.options.option("--phase").count() >
         0;
}

void PictureOptions::look_from(const Vec3d& direction) {
  cameras.clear();
  views = {{direction.x, direction.y, direction.z}};
}

void PictureOptions::light_from(const Vec3d& direction) {
  sun_body.clear();
  phase.clear();
  sun = {direction.x, direction.y, direction.z};
}

void PictureOptions::check_file(const std::filesystem::path& file) const {
  require_extension(file, {".png", ".svg", ".pdf"});
  if (is_page(file) && bits == 16)
    throw InputError("--picture-bits: " + file.string() + " is a page with a picture of 8 bits; name a .png");
}

void PictureOptions::write(const Job& job, RenderedPicture picture, const std::filesystem::path& file) const {
  for (const std::size_t view : picture.empty_views) {
    job.say(
        fmt::format("note: {}: the body covers no pixel of view {}; change the target of its camera, or "
                    "bring a pinhole nearer",
                    file.string(), view + 1));
  }
  if (is_page(file)) {
    write_page(picture, file);
  } else {
    write_png(std::move(picture).marked(), bits, background == "transparent", file);
  }
}

bool PictureOptions::has_pinholes() const {
  const std::vector<Camera> all = parse_cameras(cameras);
  return std::any_of(all.begin(), all.end(), [](const Camera& camera) { return camera.field_of_view > 0.0; });
}

}  // namespace astrolith
