#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "numerics/parallel_for.h"
#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "python/bindings/recipe_text.h"
#include "python/bindings/synthesis_bindings.h"
#include "tasks/synth/body_mesh.h"

namespace astrolith::python {
namespace {

// Points that one task evaluates before it looks whether to stop.
constexpr std::int64_t kChunk = 1024;

class Field {
 public:
  Field(const std::string& json, const std::filesystem::path& name)
      : recipe_(loaded_recipe(json, name)), field_(make_region_field(recipe_, name, Region{})) {}

  const ImplicitField& operator*() const { return field_; }

 private:
  Recipe recipe_;
  ImplicitField field_;
};

// Fills rows of `width` numbers, one for each point: fill(p, row).
template <typename T, typename Fill>
std::vector<T> at_points(const Rows<double>& points, std::size_t width, int threads, nb::object progress,
                         const Fill& fill) {
  const auto n = static_cast<std::int64_t>(points.shape(0));
  const double* const coordinates = points.data();
  std::vector<T> rows;
  T* out = nullptr;
  {
    const nb::gil_scoped_release release;
    rows.resize(static_cast<std::size_t>(n) * width);
    out = rows.data();
  }
  run_job(
      std::move(progress), threads,
      [=, &fill](JobState& state) {
        const Progress report_progress = state.progress("field");
        parallel_for(0, (n + kChunk - 1) / kChunk, [&](std::int64_t chunk) {
          if (state.stopped()) return;
          const std::int64_t end = std::min(n, (chunk + 1) * kChunk);
          for (std::int64_t i = chunk * kChunk; i < end; ++i) {
            const double* p = coordinates + 3 * i;
            fill(Vec3d{p[0], p[1], p[2]}, out + static_cast<std::size_t>(i) * width);
          }
          report_progress(static_cast<double>(end) / static_cast<double>(n), "");
        });
        return true;
      },
      true);
  return rows;
}

NumpyArray<double> values(const Field& field, const Rows<double>& points, int threads, nb::object progress) {
  const std::size_t n = points.shape(0);
  return array_of<double>(at_points<double>(points, 1, threads, std::move(progress),
                                            [&](const Vec3d& p, double* out) { *out = (*field).value(p); }),
                          {n});
}

NumpyArray<double> gradients(const Field& field, const Rows<double>& points, int threads,
                             nb::object progress) {
  const std::size_t n = points.shape(0);
  const auto fill = [&](const Vec3d& p, double* out) {
    const Vec3d g = (*field).gradient(p);
    out[0] = g.x, out[1] = g.y, out[2] = g.z;
  };
  return array_of<double>(at_points<double>(points, 3, threads, std::move(progress), fill), {n, 3});
}

NumpyArray<bool> insides(const Field& field, const Rows<double>& points, int threads, nb::object progress) {
  const std::size_t n = points.shape(0);
  const auto fill = [&](const Vec3d& p, std::uint8_t* out) { *out = (*field).inside(p) ? 1 : 0; };
  return array_of<bool>(at_points<std::uint8_t>(points, 1, threads, std::move(progress), fill), {n});
}

std::pair<std::vector<double>, std::vector<double>> bounds(const Field& field) {
  const Box box = (*field).bounds();
  return {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
}

std::vector<std::tuple<int, double, double>> left_out(const Field& field) {
  std::vector<std::tuple<int, double, double>> layers;
  for (const LayerLeftOut& left : (*field).left_out()) {
    layers.emplace_back(left.layer, left.variance_share, left.finest);
  }
  return layers;
}

}  // namespace

void bind_field(nb::module_& module) {
  nb::class_<Field>(module, "Field")
      .def(nb::init<const std::string&, const std::filesystem::path&>(), nb::arg("json"), nb::arg("name"),
           nb::call_guard<nb::gil_scoped_release>())
      .def("value", &values, nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def("gradient", &gradients, nb::arg("points").noconvert(), nb::arg("threads"),
           nb::arg("progress").none())
      .def("inside", &insides, nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def("bounds", &bounds)
      .def("gradient_step", [](const Field& field) { return (*field).gradient_step(); })
      .def("left_out", &left_out);
}

}  // namespace astrolith::python
