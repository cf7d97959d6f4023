// What pictures look like: --picture-size, --camera, --view, --sun and the like, alike in all programs.
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "synthesis/picture/preview.h"
#include "tasks/job/job.h"

namespace astrolith {

using Direction = std::tuple<double, double, double>;

struct PictureOptions {
  std::string size;                  // WxH; empty = the default
  std::vector<std::string> cameras;  // the words of parse_camera()
  std::vector<Direction> views;      // from the body to an orthographic camera; both empty = usual_views()
  Direction sun{-0.75, 0.45, 0.55};  // in the axes of each view
  std::vector<double> sun_body;      // in the axes of the mesh, or empty
  std::vector<double> phase;         // phase angle and azimuth, or empty
  std::string reflectance = "rock", background = "dark";
  double ambient = PreviewOptions{}.ambient;
  int bits = 8;
  bool no_marks = false, letters = false;
  std::string map;  // equirectangular, hemispheres; empty = views

  void add_to(OptionTable& app);

  // Throws InputError where the options cannot be, or where one of them is given and `has_picture` is not
  // set.
  void check(const Job& job, bool has_picture, const std::string& remedy) const;

  // The size, the cameras, the light, and, unless --no-marks is given, axes and a scale in the mesh's unit;
  // without colours.
  PreviewOptions options(const Job& job, const TriangleMesh& mesh, const std::string& unit) const;

  // Throws InputError where light is chosen for a picture that hardly shows any; `colors` is the option that
  // makes its colours stand for numbers.
  static void refuse_light(const Job& job, const std::string& colors);

  // Looks from one direction under one sun instead.
  void look_from(const Vec3d& direction);
  void light_from(const Vec3d& direction);

  // Throws InputError for a file that is no .png, .svg or .pdf, and for 16 bits of a page of vectors.
  void check_file(const std::filesystem::path& file) const;
  // Writes the picture, and says which of its views show nothing of the body.
  void write(const Job& job, RenderedPicture picture, const std::filesystem::path& file) const;

  bool has_pinholes() const;
  // Whether an option says from where to look, or where the sun stands.
  static bool chooses_view(const Job& job);
  static bool chooses_sun(const Job& job);
};

}  // namespace astrolith
