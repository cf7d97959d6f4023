#include "tasks/description/comparison.h"

#include "descriptor/histogram_distance.h"
#include "descriptor/surface/evened_surface.h"
#include "geometry/surface/surface_distance.h"
#include "numerics/errors.h"
#include "tasks/description/alignment.h"

namespace astrolith {
namespace {

// The result of work on a shape, whose name stands before what is wrong with it.
template <typename Work>
auto named(const NamedMesh& shape, const Work& work) {
  try {
    return work();
  } catch (const InputError& e) {
    throw InputError(shape.name + ": " + e.what());
  }
}

// Describes shapes by points that are as far apart on each: what is finer on one mesh does not count.
struct Sampler {
  const DescriptionOptions& options;
  const StageProgress& progress;
  std::vector<std::string>& remarks;

  ShapeHistogram operator()(const NamedMesh& shape, std::uint64_t which) const {
    ShapeDescription description =
        named(shape, [&] { return describe_evened(shape.mesh, for_sampling(options, which), progress); });
    if (which < 2) {
      for (const std::string& remark : description.remarks) remarks.push_back(shape.name + ": " + remark);
    }
    return std::move(description.histogram);
  }
};

nlohmann::ordered_json figures(const DistanceFigures& d) {
  return {{"mean", d.mean}, {"p99", d.p99}, {"max", d.max}};
}

void compare_histograms(const NamedMesh& a, const NamedMesh& b, const Sampler& sampled,
                        nlohmann::ordered_json& result) {
  const ShapeHistogram ha = sampled(a, 0), hb = sampled(b, 1);
  const HistogramDistances d = histogram_distances(ha, hb);
  result["similarity"] = d.similarity;
  result["similarity_floor"] = {{"a", similarity(ha, sampled(a, 2))}, {"b", similarity(hb, sampled(b, 3))}};
  result["l2"] = d.l2;
  result["chi_square"] = d.chi_square;
  result["jensen_shannon"] = d.jensen_shannon;
  result["earth_movers"] = d.earth_movers;
}

void add_distances(const SurfaceDistanceReport& d, double diagonal, nlohmann::ordered_json& result) {
  result["mean_distance"] = d.mean / diagonal;
  result["p99_distance"] = d.p99 / diagonal;
  result["max_distance"] = d.max / diagonal;
  result["in_units_of_the_files"] = {{"diagonal_of_a", diagonal},
                                     {"both", figures({d.mean, d.p99, d.max})},
                                     {"from_a_to_b", figures(d.from_a_to_b)},
                                     {"from_b_to_a", figures(d.from_b_to_a)}};
}

}  // namespace

Comparison compare_meshes(const NamedMesh& a, const NamedMesh& b, const ComparisonOptions& options,
                          const StageProgress& progress) {
  // Trees refuse garbled meshes, so that they come first.
  const SurfaceTree tree_a = named(a, [&] { return SurfaceTree(a.mesh); }),
                    tree_b = named(b, [&] { return SurfaceTree(b.mesh); });
  Comparison comparison;
  comparison.figures = nlohmann::ordered_json::object();
  const std::uint64_t seed = options.description.seed;
  compare_histograms(a, b, {options.description, progress, comparison.remarks}, comparison.figures);
  const double diagonal = a.mesh.bounds().diagonal();
  const auto measure = [&](const TriangleMesh& other, const SurfaceTree& other_tree) {
    add_distances(
        surface_distance(a.mesh, tree_a, other, other_tree, options.samples, seed, progress("distance")),
        diagonal, comparison.figures);
  };
  if (!options.align) {
    measure(b.mesh, tree_b);
    return comparison;
  }
  const RigidMotion motion = align_surface(a.mesh, tree_a, b.mesh, seed, progress("align"));
  const TriangleMesh aligned = moved(motion, b.mesh);
  measure(aligned, SurfaceTree(aligned));
  comparison.figures["alignment"] = alignment_json(motion);
  return comparison;
}

}  // namespace astrolith
