// compare: how alike two meshes are in shape, and how far apart their surfaces lie.
#include <cstdio>
#include <string>

#include "apps/program.h"
#include "apps/shape_options.h"
#include "descriptor/histogram_distance.h"
#include "geometry/io/mesh_io.h"
#include "geometry/surface/surface_distance.h"
#include "numerics/files/output_file.h"

namespace astrolith {
namespace {

struct Arguments {
  std::string a, b, output;
  ShapeOptions options;
  std::int64_t samples = 100000;
  bool floor = false;
};

void add_options(Program& program, Arguments& arguments) {
  CommandLine& app = program.app;
  const std::string formats = "mesh: obj, ply, stl, off, PDS plate .tab, ICQ, bmf";
  app.add_option("a", arguments.a, formats).required().placeholder("A");
  app.add_option("b", arguments.b, formats).required().placeholder("B");
  app.add_option("-o,--output", arguments.output, "write the JSON here rather than to stdout")
      .placeholder("FILE.json");
  arguments.options.add_to(app);
  app.add_option("--samples", arguments.samples,
                 "samples of each surface, for the distances between the surfaces")
      .check(in_range(std::int64_t{100}, std::int64_t{10000000}));
  app.add_flag("--floor", arguments.floor,
               "also say how alike two samplings of A are, and of B: more cannot be expected");
}

// Each sampling of a shape has a seed of its own.
struct Shape {
  Program& program;
  const DescriptionOptions options;
  const std::string& file;
  const TriangleMesh& mesh;

  ShapeHistogram sampled(std::uint64_t which) const {
    DescriptionOptions own = options;
    own.seed = options.seed + which * 0x9e3779b97f4a7c15u;
    const ShapeDescription description = describe_file(file, mesh, own, program.progress("describe"));
    if (which < 2) {
      for (const std::string& remark : description.remarks) program.say(file + ": " + remark);
    }
    return description.histogram;
  }
};

nlohmann::ordered_json figures(const DistanceFigures& d) {
  return {{"mean", d.mean}, {"p99", d.p99}, {"max", d.max}};
}

void compare_histograms(const Shape& a, const Shape& b, bool with_floor, nlohmann::ordered_json& result) {
  const ShapeHistogram ha = a.sampled(0), hb = b.sampled(1);
  const HistogramDistances d = histogram_distances(ha, hb);
  result["similarity"] = d.similarity;
  if (with_floor) {
    result["similarity_floor"] = {{"a", similarity(ha, a.sampled(2))}, {"b", similarity(hb, b.sampled(3))}};
  }
  result["l2"] = d.l2;
  result["chi_square"] = d.chi_square;
  result["jensen_shannon"] = d.jensen_shannon;
  result["earth_movers"] = d.earth_movers;
}

// Compares the surfaces as they stand: neither is moved, turned or scaled.
void compare_surfaces(const TriangleMesh& a, const TriangleMesh& b, std::int64_t samples, std::uint64_t seed,
                      nlohmann::ordered_json& result) {
  const SurfaceDistanceReport d = surface_distance(a, b, samples, seed);
  const double diagonal = a.bounds().diagonal();
  result["mean_distance"] = d.mean / diagonal;
  result["p99_distance"] = d.p99 / diagonal;
  result["max_distance"] = d.max / diagonal;
  result["in_units_of_the_files"] = {{"diagonal_of_a", diagonal},
                                     {"both", figures({d.mean, d.p99, d.max})},
                                     {"from_a_to_b", figures(d.from_a_to_b)},
                                     {"from_b_to_a", figures(d.from_b_to_a)}};
}

void print(const nlohmann::ordered_json& result, const std::string& output) {
  // File names need not be UTF-8.
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  const std::string text = result.dump(2, ' ', false, replace) + "\n";
  if (output.empty()) {
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
      throw WorkError("stdout: writing failed; is the disk full?");
    }
    return;
  }
  OutputFile file(output);
  file.write(text.data(), text.size());
  file.commit();
}

void run(Program& program, const Arguments& arguments) {
  if (!arguments.output.empty()) require_writable(arguments.output);
  const TriangleMesh a = read_mesh(arguments.a), b = read_mesh(arguments.b);
  const DescriptionOptions options = arguments.options.with_seed(program.seed);
  nlohmann::ordered_json result{{"a", arguments.a},
                                {"b", arguments.b},
                                {"features", arguments.options.features},
                                {"bins", options.bins},
                                {"points", options.points}};
  compare_histograms({program, options, arguments.a, a}, {program, options, arguments.b, b}, arguments.floor,
                     result);
  compare_surfaces(a, b, arguments.samples, program.seed, result);
  print(result, arguments.output);
  program.summary = result;
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program(
      "compare",
      "Says as JSON how alike two meshes are in shape (similarity 1: the same; position, "
      "attitude and size do not matter) and how far apart their surfaces lie as they "
      "stand (mean, p99 and max distance as fractions of A's bounding-box diagonal).");
  astrolith::Arguments arguments;
  astrolith::add_options(program, arguments);
  return program.run(argc, argv, [&] { astrolith::run(program, arguments); });
}
