#include "tasks/synthesis/comparison.h"

#include "descriptor/histogram_distance.h"
#include "geometry/surface/surface_distance.h"
#include "tasks/synthesis/describe_file.h"

namespace astrolith {
namespace {

// Samples shapes. Each sampling of a shape has a seed of its own.
struct Sampler {
  const DescriptionOptions& options;
  const StageProgress& progress;
  std::vector<std::string>& remarks;

  ShapeHistogram operator()(const NamedMesh& shape, std::uint64_t which) const {
    DescriptionOptions own = options;
    own.seed = options.seed + which * 0x9e3779b97f4a7c15u;
    ShapeDescription description = describe_file(shape.name, shape.mesh, own, progress("describe"));
    if (which < 2) {
      for (const std::string& remark : description.remarks) remarks.push_back(shape.name + ": " + remark);
    }
    return std::move(description.histogram);
  }
};

nlohmann::ordered_json figures(const DistanceFigures& d) {
  return {{"mean", d.mean}, {"p99", d.p99}, {"max", d.max}};
}

void compare_histograms(const NamedMesh& a, const NamedMesh& b, bool with_floor, const Sampler& sampled,
                        nlohmann::ordered_json& result) {
  const ShapeHistogram ha = sampled(a, 0), hb = sampled(b, 1);
  const HistogramDistances d = histogram_distances(ha, hb);
  result["similarity"] = d.similarity;
  if (with_floor) {
    result["similarity_floor"] = {{"a", similarity(ha, sampled(a, 2))}, {"b", similarity(hb, sampled(b, 3))}};
  }
  result["l2"] = d.l2;
  result["chi_square"] = d.chi_square;
  result["jensen_shannon"] = d.jensen_shannon;
  result["earth_movers"] = d.earth_movers;
}

void compare_surfaces(const TriangleMesh& a, const TriangleMesh& b, std::int64_t samples, std::uint64_t seed,
                      const Progress& progress, nlohmann::ordered_json& result) {
  const SurfaceDistanceReport d = surface_distance(a, b, samples, seed, progress);
  const double diagonal = a.bounds().diagonal();
  result["mean_distance"] = d.mean / diagonal;
  result["p99_distance"] = d.p99 / diagonal;
  result["max_distance"] = d.max / diagonal;
  result["in_units_of_the_files"] = {{"diagonal_of_a", diagonal},
                                     {"both", figures({d.mean, d.p99, d.max})},
                                     {"from_a_to_b", figures(d.from_a_to_b)},
                                     {"from_b_to_a", figures(d.from_b_to_a)}};
}

}  // namespace

Comparison compare_meshes(const NamedMesh& a, const NamedMesh& b, const DescriptionOptions& options,
                          std::int64_t samples, bool with_floor, const StageProgress& progress) {
  Comparison comparison;
  comparison.figures = nlohmann::ordered_json::object();
  compare_histograms(a, b, with_floor, {options, progress, comparison.remarks}, comparison.figures);
  compare_surfaces(a.mesh, b.mesh, samples, options.seed, progress("distance"), comparison.figures);
  return comparison;
}

}  // namespace astrolith
