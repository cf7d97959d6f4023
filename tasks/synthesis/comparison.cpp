#include "tasks/synthesis/comparison.h"

#include "descriptor/histogram_distance.h"
#include "descriptor/surface/evened_surface.h"
#include "geometry/surface/surface_distance.h"
#include "numerics/errors.h"
#include "tasks/synthesis/alignment.h"
#include "tasks/synthesis/describe_file.h"

namespace astrolith {
namespace {

// Describes shapes by points that are as far apart on each, at which the surface is evened: what is finer
// than the points on one mesh does not count. Each sampling of a shape has a seed of its own.
struct Sampler {
  const DescriptionOptions& options;
  const StageProgress& progress;
  std::vector<std::string>& remarks;

  ShapeHistogram operator()(const NamedMesh& shape, std::uint64_t which) const {
    DescriptionOptions own = options;
    own.seed = options.seed + which * 0x9e3779b97f4a7c15u;
    const EvenedSurface even = evened(shape, own);
    ShapeDescription description =
        describe_file(shape.name, even.points, even.normals, own, progress("describe"));
    if (which < 2) {
      for (const std::string& remark : description.remarks) remarks.push_back(shape.name + ": " + remark);
    }
    return std::move(description.histogram);
  }

 private:
  EvenedSurface evened(const NamedMesh& shape, const DescriptionOptions& own) const {
    try {
      return even_surface(shape.mesh, own.points, own.seed, progress("even"));
    } catch (const InputError& e) {
      throw InputError(shape.name + ": " + e.what());
    }
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

SurfaceTree tree_of(const NamedMesh& shape) {
  try {
    return SurfaceTree(shape.mesh);
  } catch (const InputError& e) {
    throw InputError(shape.name + ": " + e.what());
  }
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
  const SurfaceTree tree_of_a = tree_of(a), tree_of_b = tree_of(b);
  Comparison comparison;
  comparison.figures = nlohmann::ordered_json::object();
  const std::uint64_t seed = options.description.seed;
  compare_histograms(a, b, {options.description, progress, comparison.remarks}, comparison.figures);
  const double diagonal = a.mesh.bounds().diagonal();
  const auto measure = [&](const TriangleMesh& other, const SurfaceTree& tree_of_other) {
    add_distances(surface_distance(a.mesh, tree_of_a, other, tree_of_other, options.samples, seed,
                                   progress("distance")),
                  diagonal, comparison.figures);
  };
  if (!options.align) {
    measure(b.mesh, tree_of_b);
    return comparison;
  }
  const RigidMotion motion = align_surface(a.mesh, tree_of_a, b.mesh, seed, progress("align"));
  const TriangleMesh aligned = moved(motion, b.mesh);
  measure(aligned, SurfaceTree(aligned));
  comparison.figures["alignment"] = alignment_json(motion);
  return comparison;
}

}  // namespace astrolith
