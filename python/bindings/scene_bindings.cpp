#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "python/bindings/recipe_text.h"
#include "python/bindings/synthesis_bindings.h"
#include "synthesis/finish/known_albedo.h"
#include "synthesis/finish/view_ground.h"
#include "synthesis/picture/scene.h"

namespace astrolith::python {
namespace {

using Floats = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Named = nb::typed<nb::dict, nb::str, nb::any>;

Vec3d to_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// A camera in the order of the Python class: fx fy cx cy skew k1 k2 p1 p2 k3.
SceneCamera make_camera(int width, int height, const std::array<double, 10>& c,
                        const std::array<double, 3>& position, const Matrix3& axes) {
  return {
      {width, height, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], c[9]}, to_vector(position), axes};
}

std::size_t add(Scene& scene, const Rows<double>& vertices, const Rows<std::uint32_t>& faces,
                const std::optional<Rows<double>>& normals, const std::optional<Floats>& albedo, int threads,
                nb::object progress) {
  std::vector<float> values;
  if (albedo) values.assign(albedo->data(), albedo->data() + albedo->size());
  // The scene is replaced as a whole, so that other threads of Python may use it meanwhile.
  Scene longer =
      run_job(std::move(progress), threads,
              [longer = scene, mesh = mesh_of(vertices, faces, normals), values](JobState&) mutable {
                longer.add(mesh, values);
                return longer;
              });
  scene = std::move(longer);
  return scene.size() - 1;
}

// A body of a scene whose ground is what the last camera needed.
class DetailedBody {
 public:
  // An albedo in words is given to the recipe; a number is that of all ground, and 0 or less is none.
  DetailedBody(const std::string& json, const std::filesystem::path& name, double cell,
               const std::string& albedo_name, double albedo)
      : albedo_(albedo) {
    Recipe recipe = loaded_recipe(json, name);
    if (!albedo_name.empty()) set_albedo(recipe, named_albedo(albedo_name, recipe.seed));
    ground_ = std::make_unique<ViewGround>(recipe, name.string(), cell);
  }

  // Adds the body to a scene, as it is seen from far away.
  void add_to(Scene& scene, int threads, nb::object progress) {
    constexpr double kFar = 1e15;
    Look look;
    Scene longer = run_job(
        std::move(progress), threads,
        [&, longer = scene](JobState& state) mutable {
          look = ground_->look({{}, {0.0, 0.0, -kFar}, kIdentity3}, state.progress("ground"));
          body_ = longer.add(look->mesh, albedos(*look));
          return longer;
        },
        true);
    scene = std::move(longer);
    shown_ = std::move(look);
  }

  // Makes the body what the camera needs, and returns the edge of the finest cells. The scene, which other
  // threads of Python may change meanwhile, gets the new mesh at the end, under Python's lock.
  double look(Scene& scene, int width, int height, const std::array<double, 10>& calibration,
              const std::array<double, 3>& position, const Matrix3& axes, int threads, nb::object progress) {
    const SceneCamera camera =
        in_axes_of_body(make_camera(width, height, calibration, position, axes), scene.pose(body_));
    Look look;
    Scene made;
    run_job(
        std::move(progress), threads,
        [&](JobState& state) {
          look = ground_->look(camera, state.progress("ground"));
          if (look != shown_) made.add(look->mesh, albedos(*look));
          return true;
        },
        true);
    if (made.size() > 0) scene.replace(body_, made, 0);
    shown_ = std::move(look);
    return shown_->finest;
  }

  std::size_t triangles() const { return shown_->mesh.triangles.size(); }

 private:
  using Look = std::shared_ptr<const GroundLook>;

  std::vector<float> albedos(const GroundLook& look) const {
    if (albedo_ <= 0.0) return look.albedo;
    return std::vector<float>(look.mesh.vertices.size(), static_cast<float>(albedo_));
  }

  double albedo_;
  std::unique_ptr<ViewGround> ground_;
  Look shown_;
  std::size_t body_ = 0;
};

Named image(const Scene& scene, int width, int height, const std::array<double, 10>& calibration,
            const std::array<double, 3>& position, const Matrix3& axes, const std::array<double, 3>& sun,
            const std::string& reflectance, int oversampling, bool smooth, int threads, nb::object progress) {
  const SceneCamera camera = make_camera(width, height, calibration, position, axes);
  const SceneImageOptions options{parse_reflectance("reflectance", reflectance), oversampling, smooth};
  SceneImage made = run_job(std::move(progress), threads, [=, towards = to_vector(sun)](JobState& state) {
    return scene.image(camera, towards, options, state.progress("image"));
  });
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  Named result;
  result["radiance"] = array_of<float>(std::move(made.radiance), {h, w});
  result["depth"] = array_of<double>(std::move(made.depth), {h, w});
  result["normal"] = array_of<float>(std::move(made.normal), {h, w, 3});
  result["facet"] = array_of<std::int32_t>(std::move(made.facet), {h, w});
  result["body"] = array_of<std::int16_t>(std::move(made.body), {h, w});
  result["incidence"] = array_of<float>(std::move(made.incidence), {h, w});
  result["emission"] = array_of<float>(std::move(made.emission), {h, w});
  result["phase"] = array_of<float>(std::move(made.phase), {h, w});
  return result;
}

// The rows of an array, in place.
std::span<const Vec3d> vectors_in_place(const Rows<double>& rows) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  return {reinterpret_cast<const Vec3d*>(rows.data()), rows.shape(0)};
}

Named ranges(const Scene& scene, const Rows<double>& origins, const Rows<double>& directions, double noise,
             double beam, std::uint64_t seed, int threads, nb::object progress) {
  const RangeOptions options{noise, beam, seed};
  SceneRanges made = run_job(
      std::move(progress), threads,
      [=, from = vectors_in_place(origins), towards = vectors_in_place(directions)](JobState& state) {
        return scene.ranges(from, towards, options, state.progress("ranges"));
      },
      true);
  const std::size_t n = made.range.size();
  Named result;
  result["range"] = array_of<double>(std::move(made.range), {n});
  result["incidence"] = array_of<float>(std::move(made.incidence), {n});
  result["facet"] = array_of<std::int32_t>(std::move(made.facet), {n});
  result["body"] = array_of<std::int16_t>(std::move(made.body), {n});
  return result;
}

NumpyArray<double> project(int width, int height, const std::array<double, 10>& calibration,
                           const std::array<double, 3>& position, const Matrix3& axes,
                           const Rows<double>& points) {
  const SceneCamera camera = make_camera(width, height, calibration, position, axes);
  constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();
  std::vector<ImagePoint> places;
  for (const Vec3d& p : points_of(points))
    places.push_back(camera.project(p).value_or(ImagePoint{kUnseen, kUnseen}));
  const std::size_t n = places.size();
  return array_of<double>(std::move(places), {n, 2});
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<Scene>(module, "Scene")
      .def(nb::init<>())
      .def("add", &add, nb::arg("vertices").noconvert(), nb::arg("faces").noconvert(),
           nb::arg("normals").noconvert().none(), nb::arg("albedo").noconvert().none(), nb::arg("threads"),
           nb::arg("progress").none())
      .def(
          "place",
          [](Scene& scene, std::size_t body, const Matrix3& rotation, const std::array<double, 3>& position) {
            scene.place(body, {rotation, to_vector(position)});
          },
          nb::arg("body"), nb::arg("rotation"), nb::arg("position"))
      .def("image", &image, nb::arg("width"), nb::arg("height"), nb::arg("calibration"), nb::arg("position"),
           nb::arg("axes"), nb::arg("sun"), nb::arg("reflectance"), nb::arg("oversampling"),
           nb::arg("smooth"), nb::arg("threads"), nb::arg("progress").none())
      .def("ranges", &ranges, nb::arg("origins").noconvert(), nb::arg("directions").noconvert(),
           nb::arg("noise"), nb::arg("beam"), nb::arg("seed"), nb::arg("threads"),
           nb::arg("progress").none());
  nb::class_<DetailedBody>(module, "DetailedBody")
      .def(nb::init<const std::string&, const std::filesystem::path&, double, const std::string&, double>(),
           nb::arg("json"), nb::arg("name"), nb::arg("cell"), nb::arg("albedo_name"), nb::arg("albedo"),
           nb::call_guard<nb::gil_scoped_release>())
      .def("add_to", &DetailedBody::add_to, nb::arg("scene"), nb::arg("threads"), nb::arg("progress").none())
      .def("look", &DetailedBody::look, nb::arg("scene"), nb::arg("width"), nb::arg("height"),
           nb::arg("calibration"), nb::arg("position"), nb::arg("axes"), nb::arg("threads"),
           nb::arg("progress").none())
      .def("triangles", &DetailedBody::triangles);
  module.def("project", &project, nb::arg("width"), nb::arg("height"), nb::arg("calibration"),
             nb::arg("position"), nb::arg("axes"), nb::arg("points").noconvert());
}

}  // namespace astrolith::python
