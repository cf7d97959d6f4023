#include <memory>
#include <string>
#include <utility>

#include "python/bindings/called_job.h"
#include "python/bindings/synthesis_bindings.h"
#include "tasks/synth/synth.h"

namespace nb = nanobind;

namespace astrolith::python {
namespace {

// The figures as JSON. `recipe` is the text of a recipe; where it is empty, an option names the file.
std::string call_synth(const GivenOptions& given, const std::string& recipe,
                       const std::vector<std::filesystem::path>& prefixes, int threads, nb::object progress) {
  return run_job(std::move(progress), threads, [=](JobState& state) {
    CalledJob job("synth", state);
    const JobWork work = declare_called_synth(job, {recipe, prefixes});
    job.take(given);
    work();
    return job.figures();
  });
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
  module.def("options_of_synth", &options_of_synth);
}

}  // namespace astrolith::python
