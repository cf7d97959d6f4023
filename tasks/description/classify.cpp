#include "tasks/description/description_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "descriptor/classification/classifier_file.h"
#include "descriptor/classification/evaluation.h"
#include "descriptor/classification/feature_table.h"
#include "descriptor/classification/retrieval.h"
#include "descriptor/classification/shape_features.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "tasks/job/job.h"
#include "tasks/job/output_names.h"
#include "tasks/repair/mesh_repair.h"

namespace astrolith {
namespace {

// The recall at which each number of a "precision_at_recall" stands.
nlohmann::ordered_json recall_levels() {
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (int k = 0; k < kRecallLevels; ++k) levels.push_back(static_cast<double>(k) / (kRecallLevels - 1));
  return levels;
}

nlohmann::ordered_json to_json(const FeatureOptions& options) {
  nlohmann::ordered_json json{{"kind", feature_name(options.kind)}};
  if (options.kind == FeatureKind::shapedna) {
    json["eigenvalues"] = options.eigenvalues;
  } else {
    json["bins"] = options.bins;
  }
  return json;
}

nlohmann::ordered_json to_json(const Evaluation& evaluation, const std::vector<std::string>& classes) {
  nlohmann::ordered_json json{{"shapes", evaluation.shapes},
                              {"accuracy", evaluation.accuracy},
                              {"mean_average_precision", evaluation.mean_average_precision},
                              {"classes", nlohmann::ordered_json::array()},
                              {"confusion", evaluation.confusion}};  // [true][called], classes in their order
  for (std::size_t c = 0; c < classes.size(); ++c) {
    const ClassScore& score = evaluation.classes[c];
    json["classes"].push_back({{"name", classes[c]},
                               {"shapes", score.shapes},
                               {"precision", score.precision},
                               {"recall", score.recall},
                               {"average_precision", score.ranking.average_precision},
                               {"precision_at_recall", score.ranking.curve}});
  }
  return json;
}

nlohmann::ordered_json to_json(const Retrieval& retrieval) {
  return {{"mean_average_precision", retrieval.mean_average_precision},
          {"nearest_accuracy", retrieval.nearest_accuracy},
          {"precision_at_recall", retrieval.curve},
          {"recall_levels", recall_levels()}};
}

namespace fs = std::filesystem;

struct Arguments {
  // train
  std::vector<fs::path> folders;
  std::string output, kind = "ahd";
  FeatureOptions features;
  TrainingOptions training;
  int folds = 5;
  // predict
  std::string model;
  std::vector<fs::path> meshes;
  // The options that only some features have, to tell whether they were given.
  Option bins, points, eigenvalues;
};

OptionTable& add_train(Job& job, Arguments& a) {
  OptionTable& train = job.options.add_command(
      "train",
      "Learns classes from folders: each folder of meshes is a class of its name. Give the folders, or "
      "one that holds them.");
  train.add_option("folders", a.folders, "folders of meshes, or folders of such folders")
      .required()
      .placeholder("DIR...");
  train.add_option("-o,--output", a.output, "the classifier to write (JSON, which YAML readers read too)")
      .required()
      .placeholder("MODEL.yml")
      .writes();
  train.add_option("--features", a.kind, "what the classes are told apart by")
      .check(one_of({"wahl", "ahd", "d2", "shapedna"}));
  a.bins = train.add_option("--bins", a.features.bins, "histogram bins for each axis; 64 for d2 unless given")
               .check(in_range(2, 1024));
  a.points =
      train
          .add_option(
              "--points", a.features.points,
              "samples of each mesh that the histogram is made of; points without triangles are all taken")
          .check(in_range(16, 100000));
  a.eigenvalues =
      train.add_option("--eigenvalues", a.features.eigenvalues, "number of eigenvalues of shapedna")
          .check(in_range(1, 500));
  train.add_option("--trees", a.training.forest.trees, "number of trees of the random forest")
      .check(in_range(1, 10000));
  train.add_option("--depth", a.training.forest.depth, "largest depth of the trees").check(in_range(1, 60));
  train
      .add_option("--pca", a.training.components,
                  "principal components that the forest sees in place of the features; 0 = the features")
      .check(in_range(0, 100000));
  train.add_option("--folds", a.folds, "folds of the cross-validation; 0 = none").check(in_range(0, 1000));
  return train;
}

void add_predict(Job& job, Arguments& a) {
  OptionTable& predict = job.options.add_command(
      "predict",
      "Prints the class of each mesh and the share of votes for every class, a line of JSON each.");
  predict.add_option("model", a.model, "what train wrote").required().placeholder("MODEL.yml").reads();
  predict.add_option("meshes", a.meshes, "meshes, or folders of meshes")
      .required()
      .placeholder("MESH...")
      .reads();
}

// An option that the features do not have would be passed over in silence.
void require_belongs(const Arguments& a, const Option& option, bool belongs) {
  if (option.count() == 0 || belongs) return;
  throw InputError("--" + option.name() + ": " + a.kind + " has none; leave it out");
}

FeatureOptions chosen_features(const Arguments& a, std::uint64_t seed) {
  const FeatureKind kind = feature_kind_from_name(a.kind);
  const bool spectrum = kind == FeatureKind::shapedna;
  require_belongs(a, a.bins, !spectrum);
  require_belongs(a, a.points, !spectrum);
  require_belongs(a, a.eigenvalues, spectrum);
  FeatureOptions options = a.features;
  options.kind = kind;
  if (a.bins.count() == 0) options.bins = default_features(kind).bins;
  options.seed = seed;
  check(options);
  return options;
}

FeatureTable features_with_failures(Job& job, const std::vector<fs::path>& files,
                                    const FeatureOptions& options) {
  FeatureTable table = read_features(files, options, read_mended_surface, job.progress("describe"));
  for (const std::string& failure : table.failures) job.report_failure(failure);
  for (const std::string& remark : table.remarks) job.say(remark);
  job.summary["failed"] = table.failures;
  return table;
}

// A class whose every file failed would never be called.
void require_each_class(const LabelledFeatures& data) {
  for (std::size_t c = 0; c < data.classes.size(); ++c) {
    if (std::find(data.labels.begin(), data.labels.end(), static_cast<int>(c)) != data.labels.end()) continue;
    throw InputError("class " + data.classes[c] +
                     ": none of its meshes can be used; mend them or leave it out");
  }
}

void say_evaluation(const Job& job, const Evaluation& evaluation, int folds) {
  job.say(fmt::format("{} shapes, {} classes: {:.1f} % right, mean average precision {:.1f} % ({} folds)",
                      evaluation.shapes, evaluation.classes.size(), 100 * evaluation.accuracy,
                      100 * evaluation.mean_average_precision, folds));
}

void say_skipped(const Job& job, const fs::path& file) {
  job.say(file.string() + ": skipped; its ending is not that of a mesh");
}

void train(Job& job, Arguments& a) {
  require_extension(a.output, {".yml", ".yaml", ".json"});
  require_writable(a.output);
  const FeatureOptions features = chosen_features(a, job.seed);
  a.training.forest.seed = job.seed;
  const LabelledFiles files = find_classes(a.folders);
  for (const fs::path& file : files.files) {
    job.options.require_not_written(file);
  }
  for (const fs::path& file : files.skipped) say_skipped(job, file);
  const LabelledFeatures data = labelled(files, features_with_failures(job, files.files, features));
  require_each_class(data);

  job.summary["features"] = to_json(features);
  job.summary["shapes"] = data.rows.size();
  job.summary["class_names"] = data.classes;
  job.summary["retrieval"] = to_json(retrieve(
      data.rows, data.labels, [&](auto f, auto g) { return feature_distance(features.kind, f, g); }));
  if (a.folds > 0) {
    const VoteRows votes = cross_validate(data, a.training, a.folds, job.seed, job.progress("validate"));
    const Evaluation evaluation = evaluate(votes, data.labels, static_cast<int>(data.classes.size()));
    job.summary["cross_validation"] = to_json(evaluation, data.classes);
    job.summary["cross_validation"]["folds"] = a.folds;
    job.summary["cross_validation"]["recall_levels"] = recall_levels();
    say_evaluation(job, evaluation, a.folds);
  }
  write_classifier(train_classifier(data, features, a.training), job.tool(), a.output);
}

std::vector<fs::path> all_meshes(const Job& job, const std::vector<fs::path>& paths) {
  std::vector<fs::path> meshes;
  std::error_code unused;  // what cannot be looked at is named when it is read
  for (const fs::path& path : paths) {
    if (!fs::is_directory(path, unused)) {
      meshes.push_back(path);
      continue;
    }
    const std::vector<fs::path> inside = meshes_in(path);
    if (inside.empty()) throw InputError(path.string() + ": holds no meshes; give a folder of meshes");
    for (const fs::path& file : others_in(path)) say_skipped(job, file);
    meshes.insert(meshes.end(), inside.begin(), inside.end());
  }
  return meshes;
}

std::string prediction_line(const fs::path& mesh, const ShapeClassifier& classifier,
                            const std::vector<float>& row) {
  const std::vector<double> votes = classifier.votes(row);
  nlohmann::ordered_json line{{"mesh", mesh.string()},
                              {"class", classifier.classes[static_cast<std::size_t>(winner(votes))]}};
  for (std::size_t c = 0; c < votes.size(); ++c) line["votes"][classifier.classes[c]] = votes[c];
  // File names need not be UTF-8.
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void predict(Job& job, const Arguments& a) {
  const ShapeClassifier classifier = read_classifier(a.model);
  const std::vector<fs::path> meshes = all_meshes(job, a.meshes);
  const FeatureTable table = features_with_failures(job, meshes, classifier.features);
  std::size_t predicted = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (table.rows[i].empty()) continue;
    ++predicted;
    job.print_result(prediction_line(meshes[i], classifier, table.rows[i]));
  }
  job.summary["shapes"] = predicted;
}

}  // namespace

JobWork declare_classify(Job& job) {
  const auto arguments = std::make_shared<Arguments>();
  const OptionTable& training = add_train(job, *arguments);
  add_predict(job, *arguments);
  job.options.require_command();
  return [&job, &training, arguments] {
    training.was_given() ? train(job, *arguments) : predict(job, *arguments);
  };
}

}  // namespace astrolith
