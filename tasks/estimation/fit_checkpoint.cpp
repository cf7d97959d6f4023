#include "tasks/estimation/fit_checkpoint.h"

#include <bit>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/json_whole.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

using nlohmann::ordered_json;

constexpr int kFormat = 3;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20;
constexpr std::size_t kNewEvaluations = 40;  // evaluations after which the file is written again

ordered_json key_json(const CheckpointKey& key) {
  ordered_json options = ordered_json::object();
  for (const auto& [name, value] : key.options) {
    if (name != "time-limit") options[name] = value;
  }
  const ordered_json of{
      {"tool", key.tool}, {"changes", key.changes}, {"input_sha256", key.input_sha256}, {"options", options}};
  // Names of files need not be UTF-8.
  return ordered_json::parse(of.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

ordered_json base_json(const ShapeFitResult& base) {
  Recipe recipe;
  recipe.body = base.body;
  ordered_json convergence = ordered_json::array();
  for (const ConvergencePoint& p : base.convergence) {
    convergence.push_back({p.iterations, p.spheres, p.mean_distance});
  }
  return {{"recipe", ordered_json::parse(recipe_to_json(recipe))},
          {"filling_rate", base.filling_rate},
          {"similarity", base.base_similarity},
          {"spheres", base.base_spheres},
          {"evaluations", base.evaluations},
          {"history", base.search_history},
          {"convergence", convergence}};
}

ShapeFitResult read_base(const ordered_json& json, const std::string& name) {
  ShapeFitResult base;
  const Recipe recipe = parse_recipe(json.at("recipe").dump(), name + ": base.recipe");
  if (!recipe.body) throw InputError(name + ": base.recipe: has no body");
  base.body = *recipe.body;
  base.filling_rate = json.at("filling_rate").get<double>();
  base.base_similarity = json.at("similarity").get<double>();
  base.base_spheres = whole_number<int>(json.at("spheres"), 0).value();
  base.evaluations = whole_number<std::int64_t>(json.at("evaluations"), 0).value();
  base.search_history = json.at("history").get<std::vector<double>>();
  for (const auto& p : json.at("convergence")) {
    base.convergence.push_back({whole_number<int>(p.at(0), 0).value(), whole_number<int>(p.at(1), 0).value(),
                                p.at(2).get<double>()});
  }
  if (base.convergence.empty()) throw InputError(name + ": base.convergence: is empty");
  return base;
}

// The log stores the bits of a value, so that every value reads back unchanged, infinite values too.
ordered_json log_json(const EvaluationLog& log) {
  ordered_json entries = ordered_json::array();
  for (const auto& [key, value] : log.entries()) {
    entries.push_back({key, std::bit_cast<std::uint64_t>(value)});
  }
  return entries;
}

std::map<std::uint64_t, double> read_log(const ordered_json& json) {
  std::map<std::uint64_t, double> entries;
  for (const auto& entry : json) {
    entries.emplace(whole_number<std::uint64_t>(entry.at(0)).value(),
                    std::bit_cast<double>(whole_number<std::uint64_t>(entry.at(1)).value()));
  }
  return entries;
}

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error || bytes > kMostBytes) {
    throw InputError(file.string() + ": is no checkpoint; give --checkpoint the name of another file");
  }
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// Throws InputError for a checkpoint that other code wrote: its values need not be those of this code.
void require_same_code(const ordered_json& of, const CheckpointKey& key, const std::string& name) {
  const std::string tool = of.at("tool").get<std::string>();
  if (tool == key.tool && of.value("changes", "") == key.changes) return;
  const std::string other =
      tool == key.tool ? ", whose source has been modified since" : ", and this is " + key.tool;
  throw InputError(name + ": was written by " + tool + other +
                   "; go on with the program that wrote it, or delete it to begin anew");
}

}  // namespace

FitCheckpoint::FitCheckpoint(std::filesystem::path file, CheckpointKey key)
    : file_(std::move(file)), key_(std::move(key)) {
  if (!file_.empty() && std::filesystem::exists(file_)) read();
}

void FitCheckpoint::read() {
  const std::string name = file_.string();
  const std::string damaged =
      name + ": is no checkpoint, or damaged; delete it, or give --checkpoint another file";
  try {
    const ordered_json json = ordered_json::parse(read_text(file_));
    const std::optional<int> format = whole_number<int>(json.at("astrolith_checkpoint"));
    require_same_code(json.at("of"), key_, name);
    if (format != kFormat || json.at("of") != key_json(key_)) {
      throw InputError(
          name +
          ": is the checkpoint of another mesh or of other options; repeat those, or delete it to "
          "begin anew");
    }
    if (json.contains("base")) {
      base_ = read_base(json.at("base"), name);
      has_base_ = true;
    }
    log_.restore(read_log(json.at("evaluations")));
    saved_evaluations_ = log_.size();
    resumed_ = true;
  } catch (const nlohmann::json::exception&) {
    throw InputError(damaged);
  } catch (const std::bad_optional_access&) {  // a number is no whole one
    throw InputError(damaged);
  }
}

void FitCheckpoint::keep_base(const ShapeFitResult& base) {
  base_ = ShapeFitResult{};
  base_.body = base.body;
  base_.filling_rate = base.filling_rate;
  base_.base_similarity = base.base_similarity;
  base_.base_spheres = base.base_spheres;
  base_.evaluations = base.evaluations;
  base_.search_history = base.search_history;
  base_.convergence = base.convergence;
  has_base_ = true;
  save();
}

Progress FitCheckpoint::guard(Progress progress) {
  if (file_.empty()) return progress;
  return [this, progress = std::move(progress)](double fraction, std::string_view words) {
    const bool go_on = report(progress, fraction, words);
    if (!go_on || log_.size() >= saved_evaluations_ + kNewEvaluations) save();
    return go_on;
  };
}

void FitCheckpoint::save() {
  if (file_.empty()) return;
  ordered_json json{{"astrolith_checkpoint", kFormat}, {"of", key_json(key_)}};
  if (has_base_) json["base"] = base_json(base_);
  json["evaluations"] = log_json(log_);
  write_file(file_, json.dump() + "\n");
  saved_evaluations_ = log_.size();
}

}  // namespace astrolith
