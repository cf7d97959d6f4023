#include "tasks/estimation/fit_population.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "estimation/shape/fit/shape_fit.h"
#include "geometry/io/mesh_io.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/relative_path.h"
#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/relief/relief_noise.h"
#include "tasks/estimation/body_class.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/output_names.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

struct PopulationOptions {
  std::vector<std::string> models;
  fs::path output, add_to, table;
  std::string unit = "km";
  int spheres = 80;
};

constexpr int kFrameCells = 128;  // of the mesh that a recipe's frame and class are measured on

double meters_in(const std::string& unit) { return unit == "km" ? 1000.0 : 1.0; }

// A table's row: columns by the names of its header.
using Row = std::map<std::string, std::string>;

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
    while (!cell.empty() && is_space(cell.back())) cell.pop_back();
    while (!cell.empty() && is_space(cell.front())) cell.erase(0, 1);
    cells.push_back(cell);
  }
  return cells;
}

// The rows of a table by the names of the bodies.
class BodyTable {
 public:
  explicit BodyTable(const fs::path& file) : file_(file) {
    if (file.empty()) return;
    std::ifstream in(file);
    std::string line;
    if (!in || !std::getline(in, line))
      throw InputError(file.string() + ": cannot be read; give a table (.csv)");
    const std::vector<std::string> names = split_cells(line);
    if (std::find(names.begin(), names.end(), "name") == names.end()) {
      throw InputError(file.string() +
                       ": has no column called name; its columns are name, source, class, rotation_period_h, "
                       "density_kg_m3");
    }
    while (std::getline(in, line)) {
      const std::vector<std::string> cells = split_cells(line);
      Row row;
      for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) row[names[i]] = cells[i];
      if (!row["name"].empty()) rows_[row["name"]] = row;
    }
  }

  // The row of a model, whose file may add a mission or a version to the body's name; or null.
  const Row* find_row(const std::string& model) const {
    const Row* best = nullptr;
    std::size_t longest = 0;
    for (const auto& [name, row] : rows_) {
      if (model.rfind(name, 0) == 0 && name.size() > longest) best = &row, longest = name.size();
    }
    return best;
  }

  void apply(const Row& row, MeasuredBody& body) const {
    if (const std::string& name = text(row, "name"); !name.empty()) body.name = name;
    set_word(row, "source", kShapeSources, source_word, body.source);
    set_word(row, "class", kBodyClasses, class_word, body.kind);
    set_number(row, "rotation_period_h", body.rotation_period);
    set_number(row, "density_kg_m3", body.density);
  }

 private:
  static const std::string& text(const Row& row, const std::string& column) {
    static const std::string none;
    const auto at = row.find(column);
    return at == row.end() ? none : at->second;
  }
  template <class T, std::size_t n>
  void set_word(const Row& row, const std::string& column, const T (&values)[n],
                std::string_view (*to_word)(T), T& value) const {
    const std::string& word = text(row, column);
    if (word.empty()) return;
    for (const T candidate : values) {
      if (to_word(candidate) == word) {
        value = candidate;
        return;
      }
    }
    std::vector<std::string_view> known;
    for (const T candidate : values) known.push_back(to_word(candidate));
    fail(row, column, fmt::format("must be one of {}, is {}", fmt::join(known, ", "), word));
  }
  void set_number(const Row& row, const std::string& column, double& value) const {
    const std::string& word = text(row, column);
    if (word.empty()) return;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !(value >= 0.0)) {
      fail(row, column, "must be a number of at least 0, is " + word);
    }
  }
  [[noreturn]] void fail(const Row& row, const std::string& column, const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}: {}", file_.string(), text(row, "name"), column, what));
  }

  fs::path file_;
  std::map<std::string, Row> rows_;
};

bool is_recipe(const fs::path& file) { return file.extension() == ".json" || file.extension() == ".astro"; }

double rounded(double number) { return round_to_seven_digits(number); }
Vec3d rounded(const Vec3d& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

// A body of metaballs in a unit, with what it looks like. `mesh` is its surface.
MeasuredBody measured_body(const MetaballBody& body, const TriangleMesh& mesh, double unit) {
  const BodyFrame frame = body_frame(mesh);
  MeasuredBody measured;
  measured.kind = classify_body(shape_features(mesh, frame));
  measured.body = {body};
  measured.body.front().groups.clear();
  measured.unit = unit;
  measured.diameter = rounded(unit * portable::cbrt(6.0 / std::numbers::pi * frame.volume));
  measured.center = rounded(frame.center);
  measured.half_axes = rounded(frame.half_axes);
  for (std::size_t k = 0; k < 3; ++k) measured.axes[k] = rounded(frame.axes[k]);
  return measured;
}

// The roughness of the first relief, in diameters; nothing without one.
std::optional<double> ground_roughness(const Recipe& recipe, const std::string& name, double diameter) {
  constexpr double kDeviation = 0.01;  // of the means, diameters
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const auto* relief = std::get_if<ReliefLayer>(&recipe.layers[i]);
    if (relief == nullptr) continue;
    ArrayStore arrays;
    const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
    const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
    const LayerSource source{recipe, static_cast<int>(i), fmt::format("{}: layers[{}]", name, i)};
    return relief_roughness(*relief, source, {body, arrays.view(), metaballs.lists()},
                            kDeviation * diameter) /
           diameter;
  }
  return std::nullopt;
}

// The body of a recipe that a fit wrote. Its ground is laid on drawn bodies from that file.
MeasuredBody from_recipe(const fs::path& file, const PopulationOptions& options) {
  const Recipe recipe = load_recipe(file);
  const std::string name = file.string();
  if (!recipe.body) throw InputError(name + ": has no body; give a recipe of fit_shape");
  if (recipe.length_unit != "m" && recipe.length_unit != "km") {
    throw InputError(name + ": length_unit: has no physical scale; a population needs m or km");
  }
  const MetaballBody& body = *recipe.body;
  if (body.morph || !body.operations.empty() || body.warp) {
    throw InputError(name +
                     ": body: has operations or a warp, or is drawn; a measured body is metaballs alone");
  }
  const double unit = meters_in(recipe.length_unit) / meters_in(options.unit);
  MeasuredBody measured = measured_body(body, bare_body(recipe).meshed_at(kFrameCells), unit);
  if (const std::optional<double> roughness =
          ground_roughness(recipe, name, measured.diameter / measured.unit)) {
    measured.roughness = rounded(*roughness);
    measured.recipe = relative_to(options.output, file);
  }
  return measured;
}

// Fits metaballs to a closed mesh.
MeasuredBody from_mesh(Job& job, const fs::path& file, const PopulationOptions& options) {
  WoundSurface wound = wound_surface(read_mesh(file));
  if (wound.changed()) job.say(file.string() + ": " + wound.words());
  const TargetBody target = prepare_target(wound.mesh, file.string());
  ShapeFitOptions fit;
  fit.spheres = options.spheres;
  fit.seed = job.seed;
  const ShapeFitResult result = fit_shape(target, fit, job.stages());
  if (job.stopped()) throw WorkError(file.string() + ": the fit was stopped; nothing was written");
  job.say(fmt::format("{}: {} metaballs, {:.2g} of the diagonal from the model on average", file.string(),
                      result.body.num_metaballs(), result.check.distance.mean));
  return measured_body(result.body, wound.mesh, 1.0);
}

void add_body(MeasuredBody body, std::vector<MeasuredBody>& bodies) {
  const auto same = std::find_if(bodies.begin(), bodies.end(),
                                 [&](const MeasuredBody& other) { return other.name == body.name; });
  if (same != bodies.end()) {
    *same = std::move(body);
  } else {
    bodies.push_back(std::move(body));
  }
}

Recipe begun_population(const PopulationOptions& options) {
  Recipe recipe;
  recipe.length_unit = options.unit;
  recipe.population.emplace();
  if (options.add_to.empty()) return recipe;
  recipe = load_recipe(options.add_to);
  if (!recipe.population)
    throw InputError(options.add_to.string() + ": has no population; fit_population writes one");
  return recipe;
}

// Refuses before any fit what would make no population.
void check_models(const PopulationOptions& options, std::size_t bodies_before) {
  std::set<std::string> names;
  for (const fs::path file : options.models) {
    if (!names.insert(file.stem().string()).second)
      throw InputError("models: " + file.stem().string() + " is given twice; give each body once");
  }
  if (names.size() + bodies_before < 2)
    throw InputError("models: are one; give two or more, between which bodies are drawn");
}

nlohmann::ordered_json to_json(const MeasuredBody& body) {
  return {{"name", body.name},
          {"class", std::string(class_word(body.kind))},
          {"source", std::string(source_word(body.source))},
          {"diameter", body.diameter},
          {"roughness", body.roughness},
          {"has_ground", !body.recipe.empty()}};
}

void fit_population(Job& job, PopulationOptions& options) {
  require_extension(options.output, {".json", ".astro"});
  require_writable(options.output);
  Recipe recipe = begun_population(options);
  options.unit = recipe.length_unit;
  check_models(options, recipe.population->bodies.size());
  const BodyTable table(options.table);
  for (const fs::path file : options.models) {
    const std::string model = file.stem().string();
    MeasuredBody body = is_recipe(file) ? from_recipe(file, options) : from_mesh(job, file, options);
    body.name = model;
    if (const Row* row = table.find_row(model)) {
      table.apply(*row, body);
    } else if (!options.table.empty()) {
      job.note(fmt::format("note: {}: has no row for {}; taken as measured by a camera",
                           options.table.string(), model));
    }
    job.note(fmt::format("{}: {}, {}, {:.4g} {}", body.name, class_word(body.kind), source_word(body.source),
                         body.diameter, options.unit));
    add_body(std::move(body), recipe.population->bodies);
  }
  if (options.table.empty())
    job.note(
        "note: all models are taken as measured by a camera; --table says which are of radar or light "
        "curves");
  validate_recipe(recipe, options.output.string());
  auto bodies = nlohmann::ordered_json::array();
  for (const MeasuredBody& body : recipe.population->bodies) bodies.push_back(to_json(body));
  job.summary["length_unit"] = recipe.length_unit;
  job.summary["bodies"] = std::move(bodies);
  write_loaded_recipe(recipe, options.output);
}

}  // namespace

JobWork declare_fit_population(Job& job) {
  const auto options = std::make_shared<PopulationOptions>();
  job.options
      .add_option(
          "models", options->models,
          "closed meshes of measured bodies, to which metaballs are fitted, and recipes of fit_shape; drawn "
          "bodies can have the ground of recipes with a relief")
      .required()
      .placeholder("MODEL...")
      .reads();
  job.options.add_option("-o,--output", options->output, "the population, as JSON or compact (.astro)")
      .required()
      .placeholder("POPULATION.astro")
      .writes();
  job.options
      .add_option("--add-to", options->add_to,
                  "a population to which the models are added; one of the same name takes the other's place")
      .placeholder("POPULATION")
      .reads();
  job.options
      .add_option(
          "--table", options->table,
          "what is known of the bodies, as .csv with a header: name (with which a model's file name begins), "
          "source "
          "(camera, radar, adaptive_optics, light_curve), class (top, contact_binary, elongated, rounded, "
          "fragment; by features of the shape where it is absent), rotation_period_h, density_kg_m3")
      .placeholder("FILE.csv")
      .reads();
  job.options.add_option("--unit", options->unit, "length unit of the population and of its meshes")
      .check(one_of({"km", "m"}));
  job.options.add_option("--spheres", options->spheres, "largest number of metaballs of a fitted mesh")
      .check(in_range(10, 1000));
  return [&job, options] { fit_population(job, *options); };
}

}  // namespace astrolith
