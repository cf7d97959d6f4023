// standard_set_experiment: how well do shape descriptors tell everyday objects apart?
//
// Thesis 3.6.3 reached 62.5 %, averaged over the recall axis, on ten classes of the NTU database (1,218
// models). Here any folder of class folders will do; a model is never trained on and tested at once. Bins and
// forest are those of the papers and of `classify`, nothing is fitted to what is tested.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tasks/description/evaluation_json.h"
#include "apps/program.h"
#include "descriptor/classification/cross_validation.h"
#include "descriptor/classification/feature_table.h"
#include "geometry/io/mesh_io.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr FeatureKind kKinds[] = {FeatureKind::ahd, FeatureKind::wahl, FeatureKind::d2,
                                  FeatureKind::shapedna};

struct Arguments {
  std::vector<fs::path> folders;
  std::string output;
  std::int64_t points = 5000;
  int folds = 5, repeats = 5;
  ForestOptions forest;
};

struct MeanAndSpread {
  double mean = 0, spread = 0;  // mean and standard deviation of the repeats
};

MeanAndSpread mean_and_spread(const std::vector<double>& values) {
  MeanAndSpread result;
  for (const double v : values) result.mean += v / static_cast<double>(values.size());
  for (const double v : values) result.spread += (v - result.mean) * (v - result.mean);
  result.spread = values.size() > 1 ? std::sqrt(result.spread / static_cast<double>(values.size() - 1)) : 0;
  return result;
}

Json to_json(const MeanAndSpread& m) { return {{"mean", m.mean}, {"standard_deviation", m.spread}}; }

// The features of the files. Spectra need a surface; where a mesh has none, they are computed from the points
// that the other descriptors see.
FeatureTable features_of(const LabelledFiles& files, const FeatureOptions& options, int& by_points,
                         const Progress& progress) {
  FeatureTable table = features_of_files(files.files, options, progress);
  by_points = 0;
  if (options.kind != FeatureKind::shapedna) return table;
  for (std::size_t i = 0; i < files.files.size(); ++i) {
    if (!table.rows[i].empty()) continue;
    try {
      const SurfaceSamples s = sample_poisson_disk(read_mesh(files.files[i]), options.points, options.seed);
      table.rows[i] = point_features(s.points, s.normals, options);
      ++by_points;
    } catch (const InputError&) {
      // It stays among the failures, by name.
    }
  }
  return table;
}

// Accuracy of forests trained on a few models of each class and tested on all the rest.
MeanAndSpread trained_on_few(const LabelledFeatures& data, int few, const Arguments& a, std::uint64_t seed) {
  std::vector<double> accuracies(static_cast<std::size_t>(a.repeats));
  const int classes = static_cast<int>(data.classes.size());
  parallel_for(0, a.repeats, [&](std::int64_t repeat) {
    CounterRandom random(seed, static_cast<std::uint64_t>(1000 + repeat));
    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    for (std::size_t i = 0; i < data.rows.size(); ++i) order.emplace_back(random.next(), i);
    std::sort(order.begin(), order.end());
    std::vector<int> taken(data.classes.size(), 0), labels;
    LabelledFeatures train{data.classes, {}, {}};
    std::vector<std::size_t> rest;
    for (const auto& [key, i] : order) {
      if (taken[static_cast<std::size_t>(data.labels[i])]++ < few) {
        train.rows.push_back(data.rows[i]);
        train.labels.push_back(data.labels[i]);
      } else {
        rest.push_back(i);
      }
    }
    const ShapeClassifier forest = train_classifier(train, {}, {0, a.forest});
    VoteRows votes;
    for (const std::size_t i : rest) {
      votes.push_back(forest.votes(data.rows[i]));
      labels.push_back(data.labels[i]);
    }
    accuracies[static_cast<std::size_t>(repeat)] = evaluate(votes, labels, classes).accuracy;
  });
  return mean_and_spread(accuracies);
}

// Cross-validations that differ in the shapes of each fold. The first one is stated in detail.
Json cross_validations(const LabelledFeatures& data, const Arguments& a, std::uint64_t seed,
                       const Progress& progress) {
  std::vector<double> accuracies, precisions;
  Json first;
  for (int repeat = 0; repeat < a.repeats; ++repeat) {
    const VoteRows votes =
        cross_validate(data, {0, a.forest}, a.folds, seed + static_cast<std::uint64_t>(repeat));
    const Evaluation e = evaluate(votes, data.labels, static_cast<int>(data.classes.size()));
    accuracies.push_back(e.accuracy);
    precisions.push_back(e.mean_average_precision);
    if (repeat == 0) first = to_json(e, data.classes);
    if (!report(progress, (repeat + 1.0) / a.repeats, "forests")) throw WorkError("stopped; run it again");
  }
  return {{"accuracy", to_json(mean_and_spread(accuracies))},
          {"mean_average_precision", to_json(mean_and_spread(precisions))},
          {"first", first}};
}

int smallest_class(const LabelledFeatures& data) {
  int smallest = static_cast<int>(data.labels.size());
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    smallest = std::min(
        smallest, static_cast<int>(std::count(data.labels.begin(), data.labels.end(), static_cast<int>(c))));
  }
  return smallest;
}

Json describe(Program& program, const Arguments& a, const LabelledFiles& files, FeatureKind kind) {
  FeatureOptions options = default_features(kind);
  options.points = a.points;
  options.seed = program.seed;
  int by_points = 0;
  const FeatureTable table = features_of(files, options, by_points, program.progress(name_of(kind)));
  const LabelledFeatures data = labelled(files, table);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].empty())
      program.report_failure(files.files[i].string() + ": cannot be described by " + name_of(kind));
  }
  Json json{{"features", to_json(options)}, {"shapes", data.rows.size()}, {"described_by_points", by_points}};
  json["cross_validation"] = cross_validations(data, a, program.seed, program.progress("validate"));
  for (int few = 1; few < smallest_class(data); few *= 2) {
    json["trained_on_few"].push_back(
        {{"models_a_class", few}, {"accuracy", to_json(trained_on_few(data, few, a, program.seed))}});
  }
  json["retrieval"] = to_json(retrieve(data.rows, data.labels, static_cast<int>(data.classes.size()),
                                       [&](auto f, auto g) { return feature_distance(kind, f, g); }));
  return json;
}

void run(Program& program, Arguments& a) {
  require_writable(a.output);
  a.forest.seed = program.seed;
  const LabelledFiles files = find_classes(a.folders);
  Json result{{"protocol",
               {{"tool", program.tool()},
                {"seed", program.seed},
                {"models", files.files.size()},
                {"classes", files.classes},
                {"points", a.points},
                {"folds", a.folds},
                {"repeats", a.repeats},
                {"trees", a.forest.trees},
                {"depth", a.forest.depth},
                {"thesis_accuracy", 0.625},
                {"thesis_set", "ten classes of the NTU database, 1218 models"}}},
              {"recall_levels", recall_levels()}};
  for (const FeatureKind kind : kKinds) {
    result["descriptors"].push_back(describe(program, a, files, kind));
    const Json& d = result["descriptors"].back();
    char line[200];
    std::snprintf(line, sizeof line, "%-9s %.1f +- %.1f %% right, retrieval %.1f %% average precision",
                  name_of(kind).c_str(), 100 * d["cross_validation"]["accuracy"]["mean"].get<double>(),
                  100 * d["cross_validation"]["accuracy"]["standard_deviation"].get<double>(),
                  100 * d["retrieval"]["mean_average_precision"].get<double>());
    program.say(line);
  }
  write_file(a.output, result.dump(1) + "\n");
}

void declare_options(Program& program, Arguments& a) {
  OptionTable& app = program.app;
  app.add_option("folders", a.folders, "a folder of class folders, or a folder for each class")
      .required()
      .placeholder("DIR...")
      .default_text("");
  app.add_option("-o,--output", a.output, "the figures to write").required().placeholder("RESULTS.json");
  app.add_option("--points", a.points, "samples of each mesh").check(in_range(16, 100000));
  app.add_option("--folds", a.folds, "folds of the cross-validation").check(in_range(2, 1000));
  app.add_option("--repeats", a.repeats, "repeats of every random split").check(in_range(1, 100));
  app.add_option("--trees", a.forest.trees, "number of trees of each random forest")
      .check(in_range(1, 10000));
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program(
      "standard_set_experiment",
      "Tells classes of models apart by four descriptors: cross-validated random forests, forests "
      "trained on few models, and retrieval.");
  astrolith::Arguments a;
  astrolith::declare_options(program, a);
  return program.run(argc, argv, [&] { astrolith::run(program, a); });
}
