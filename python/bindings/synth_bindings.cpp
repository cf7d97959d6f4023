#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings/arrays.h"
#include "python/bindings/called_job.h"
#include "python/bindings/synthesis_bindings.h"
#include "tasks/synth/synth.h"

namespace nb = nanobind;

namespace astrolith::python {
namespace {

using Prefixes = std::vector<std::filesystem::path>;
using Fields = nb::typed<nb::dict, nb::str, nb::any>;

struct MadeBySynth {
  std::string figures;  // as JSON
  std::vector<KeptMesh> meshes;
};

// Does the job. `recipe` is the text of a recipe; where it is empty, an option names the file. The meshes are
// kept where they are asked for, and then need no files.
MadeBySynth do_synth(const GivenOptions& given, const std::string& recipe, const Prefixes& prefixes,
                     bool keep, JobState& state) {
  CalledJob job("synth", state);
  MadeBySynth made;
  std::mutex mutex;
  SynthCaller caller{recipe, prefixes};
  if (keep)
    caller.arrays = [&](KeptMesh&& mesh) {
      const std::lock_guard lock(mutex);
      made.meshes.push_back(std::move(mesh));
    };
  const JobWork work = declare_called_synth(job, std::move(caller));
  job.take(given);
  work();
  made.figures = job.figures();
  std::sort(made.meshes.begin(), made.meshes.end(),
            [](const KeptMesh& a, const KeptMesh& b) { return a.member < b.member; });
  return made;
}

std::string call_synth(const GivenOptions& given, const std::string& recipe, const Prefixes& prefixes,
                       int threads, nb::object progress) {
  return run_job(std::move(progress), threads,
                 [=](JobState& state) { return do_synth(given, recipe, prefixes, false, state); })
      .figures;
}

std::vector<Vec3f> narrowed(const std::vector<Vec3d>& vectors) {
  std::vector<Vec3f> narrow;
  narrow.reserve(vectors.size());
  for (const Vec3d& v : vectors) narrow.push_back(to_float(v));
  return narrow;
}

nb::tuple tuple_of(const Vec3d& v) { return nb::make_tuple(v.x, v.y, v.z); }

Fields fields_of(KeptMesh& kept) {
  TriangleMesh& mesh = kept.mesh;
  const std::size_t n = mesh.vertices.size(), m = mesh.triangles.size();
  Fields result;
  result["figures"] = kept.figures.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  result["vertices"] = array_of<float>(narrowed(mesh.vertices), {n, 3});
  result["faces"] = array_of<std::uint32_t>(std::move(mesh.triangles), {m, 3});
  result["normals"] = array_of<float>(narrowed(mesh.normals), {n, 3});
  if (!mesh.colors.empty()) result["colors"] = array_of<std::uint8_t>(std::move(mesh.colors), {n, 3});
  if (!kept.labels.empty()) {
    std::vector<std::int32_t> labels;
    std::vector<float> elevations;
    for (const VertexLabel& label : kept.labels) {
      labels.push_back(label.label);
      elevations.push_back(label.elevation);
    }
    result["labels"] = array_of<std::int32_t>(std::move(labels), {n});
    result["elevations"] = array_of<float>(std::move(elevations), {n});
    result["legend"] = kept.info.notes;
  }
  nb::dict values;
  for (VertexValues& column : kept.values)
    values[nb::str(column.name.c_str())] = array_of<double>(std::move(column.values), {n});
  result["values"] = values;
  result["length_unit"] = kept.info.length_unit;
  result["frame"] = kept.info.frame;
  result["comment"] = kept.info.comment;
  if (kept.info.origin) result["origin"] = tuple_of(*kept.info.origin);
  if (kept.plane) {
    nb::dict plane;
    plane["right"] = tuple_of(kept.plane->axes.right);
    plane["ahead"] = tuple_of(kept.plane->axes.ahead);
    plane["up"] = tuple_of(kept.plane->axes.up);
    plane["origin"] = tuple_of(kept.plane->origin);
    result["map_plane"] = plane;
  }
  return result;
}

// The figures of the run, and the mesh, or one for each member.
std::pair<std::string, std::vector<Fields>> meshes(const GivenOptions& given, const std::string& recipe,
                                                   const Prefixes& prefixes, int threads,
                                                   nb::object progress) {
  MadeBySynth made = run_job(std::move(progress), threads,
                             [=](JobState& state) { return do_synth(given, recipe, prefixes, true, state); });
  std::vector<Fields> all;
  for (KeptMesh& mesh : made.meshes) all.push_back(fields_of(mesh));
  return {made.figures, std::move(all)};
}

std::vector<OptionDescription> options_of_synth() {
  JobState unused;
  CalledJob job("synth", unused);
  const JobWork work = declare_synth(job);
  return descriptions_of(job.options);
}

}  // namespace

void bind_synth(nb::module_& module) {
  module.def("synth", &call_synth, nb::arg("options"), nb::arg("recipe"), nb::arg("prefixes"),
             nb::arg("threads"), nb::arg("progress").none());
  module.def("meshes", &meshes, nb::arg("options"), nb::arg("recipe"), nb::arg("prefixes"),
             nb::arg("threads"), nb::arg("progress").none());
  module.def("options_of_synth", &options_of_synth);
}

}  // namespace astrolith::python
