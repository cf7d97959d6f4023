// pack_spheres(): a body is filled with spheres that do not overlap, as fit_shape --packing-only does it.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "python/bindings/arrays.h"
#include "python/bindings/fit_bindings.h"
#include "python/bindings/job.h"
#include "tasks/estimation/body_packing.h"
#include "tasks/estimation/repaired_target.h"

namespace astrolith::python {
namespace {

static_assert(sizeof(Sphere) == 4 * sizeof(double), "spheres are rows of x, y, z and radius");

// Without a checked mesh there is nothing to pack.
Progress heeding_a_stop(const JobState& state) {
  return [&state](double, std::string_view) {
    if (state.stopped()) throw WorkError("stopped while the mesh was checked; nothing was packed yet");
    return true;
  };
}

// Returns (n x 4) centres and radii, the masses, empty without a density, the filling rate, and whether the
// packing was stopped early.
std::tuple<NumpyArray<double>, std::vector<double>, double, bool> pack_in_job(
    const std::string& name, const std::optional<Rows<double>>& vertices,
    const std::optional<Rows<std::uint32_t>>& faces, int spheres, double density, const std::string& unit,
    bool strict, bool wrap, bool all_parts, const std::string& output, int threads, nb::object progress) {
  const std::string title = vertices ? name : std::filesystem::path(name).filename().string();
  const BodyPackingOptions options{spheres, unit, density, title, tool_named("fit_shape"), output};
  const Repair repair{strict, wrap, all_parts};
  std::optional<TriangleMesh> given;
  if (vertices && faces) given = mesh_of(*vertices, *faces, {});
  BodyPacking packing = run_job(
      std::move(progress), threads, [name, options, repair, given = std::move(given)](JobState& state) {
        if (!options.to.empty()) require_writable(options.to);
        TriangleMesh mesh = given ? *given : repair.read(name);
        const RepairedTarget made =
            repaired_target(std::move(mesh), name, options.unit, repair.strict, repair.options(),
                            state.progress("repair"), heeding_a_stop(state));
        return pack_body(made.target, options, state.progress("pack"));
      });
  const std::size_t count = packing.spheres.size();
  return {array_of<double>(std::move(packing.spheres), {count, 4}), std::move(packing.masses),
          packing.filling_rate, packing.interrupted};
}

}  // namespace

void declare_packing(nb::module_& module) {
  module.def("pack_spheres", &pack_in_job, nb::arg("name"), nb::arg("vertices").noconvert().none(),
             nb::arg("faces").noconvert().none(), nb::arg("spheres"), nb::arg("density"), nb::arg("unit"),
             nb::arg("strict"), nb::arg("wrap"), nb::arg("all_parts"), nb::arg("output"), nb::arg("threads"),
             nb::arg("progress").none());
}

}  // namespace astrolith::python
