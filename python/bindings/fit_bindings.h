// What the fits of shapes and of photos have in common in the module astrolith._estimation.
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <utility>
#include <vector>

#include "recipe/recipe.h"
#include "tasks/repair/mesh_repair.h"

namespace astrolith::python {

using Options = std::vector<std::pair<std::string, std::string>>;

// A recipe, and the figures of the fit as JSON.
struct Fitted {
  std::string json, figures;
};

// What is done with a mesh that is no closed body.
struct Repair {
  bool strict = false, wrap = false, all_parts = false;

  RepairOptions options() const {
    RepairOptions options;
    options.wrap = wrap;
    options.all_parts = all_parts;
    options.remedy = "repair it, or pass wrap=True";
    return options;
  }
  TriangleMesh read(const std::string& file) const { return read_mesh_to_repair(file, wrap); }
};

// "fit_shape 0.2.0 (1a2b3c4)"
std::string tool_named(const std::string& program);

// The provenance of a fit to a file, or to arrays, which have no name.
Provenance provenance_of(const std::string& program, const std::string& file, const Options& options);

void declare_packing(nanobind::module_& module);
void declare_texture_fit(nanobind::module_& module);

}  // namespace astrolith::python
