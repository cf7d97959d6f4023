#include "tasks/synth/synth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "recipe/recipe_json.h"
#include "synthesis/finish/lay_on_base.h"
#include "tasks/description/variation_reference.h"
#include "tasks/job/body_library.h"
#include "tasks/job/density_question.h"
#include "tasks/job/job.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/output_names.h"
#include "tasks/synth/body_mesh.h"
#include "tasks/synth/draws.h"
#include "tasks/synth/finish.h"
#include "tasks/synth/members.h"
#include "tasks/synth/mesh_job.h"
#include "tasks/synth/page.h"
#include "tasks/synth/texture.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

struct SynthOptions {
  SynthCaller caller;
  fs::path recipe = "recipe";  // the caller's recipe has this name
  fs::path base;
  std::string base_lengths = "units";
  MeshJob mesh;
  TextureRequest texture;
  MembersRequest members;
  FinishOptions finish;
  DrawOptions draw;
  bool laid = false;  // whether reliefs are drawn anew, but as `draw.like` is not
  bool fill_unseen = false;
  bool own_heights = false;  // whether the written recipe holds what its reliefs draw
  std::string count;         // of bodies, an option that --members replaces
  int finer = 0;             // levels of reliefs below their models
  double vary = 0.0;         // 0 = the recipe itself
  fs::path sheet;            // a picture of the baked maps; empty = none
  fs::path page;             // the folder of a page; empty = none
  fs::path target;           // the mesh that a variation is to be like; empty = the recipe's own body
};

void declare_options(Job& job, SynthOptions& options) {
  Option recipe = job.options
                      .add_option("recipe", options.recipe,
                                  "the recipe, a JSON file or a compact one (.astro)" + kOrLibraryBody)
                      .default_text("")
                      .reads(recipe_and_images);
  if (options.caller.recipe.empty()) recipe.required();
  job.options
      .add_option("-o,--output", options.mesh.sinks.file,
                  "the mesh: " + written_mesh_words() +
                      ", in the recipe's length unit; with --texture .png or .tif; needed unless --predict, "
                      "--write-recipe or --page is given")
      .placeholder("FILE")
      .writes([&options](const auto& words) {
        if (!options.texture.size.empty()) return texture_files(options.texture, words.front());
        return mesh_files(options.mesh.sinks, words.front());
      });
  declare_mesh_options(job, options.mesh);
  job.options
      .add_option("--base", options.base,
                  "lay the recipe's layers on the body of this recipe, after the layers it has; a relief "
                  "takes the place of that body's own")
      .placeholder("BODY.json")
      .reads(recipe_and_images);
  job.options
      .add_option("--base-lengths", options.base_lengths,
                  "what keeps its size on the --base: units, the lengths themselves, where m and km convert "
                  "and the unit \"body\" is the longest side of that body; body, the shares of the longest "
                  "side; edges, the lengths in mean edges of the two measured models")
      .needs(job.options.option("--base"))
      .check(one_of({"units", "body", "edges"}))
      .placeholder("WHAT");
  declare_draw_options(job, options.draw);
  declare_finish_options(job, options.finish);
  job.options.add_flag(
      "--like", options.draw.like,
      "another body of the kind: the measured heights of the recipe's relief are drawn for "
      "other places, patch by patch, and moved until small patches are distributed as on the "
      "measured surface; every --seed gives another one. With --fill-unseen heights are not moved");
  Option laid = job.options.add_flag("--laid", options.laid,
                                     "as --like without its last step, the moves, in a tenth of the time");
  laid.excludes(job.options.option("--like"));
  job.options.add_flag("--fill-unseen", options.fill_unseen,
                       "ground that no camera saw, which the model has smooth, gets patches of the ground "
                       "that was seen");
  job.options
      .add_option("--finer", options.finer,
                  "continue the recipe's relief below the edges of the model that was measured, by this many "
                  "levels of its own ground, each a quarter as large as the one before")
      .check(in_range(0, kMostFinerLevels))
      .placeholder("LEVELS")
      .default_text("those of the recipe");
  Option vary =
      job.options
          .add_option(
              "--vary", options.vary,
              "another body of the same kind: the strongest variation that --seed draws whose similarity "
              "with the --target, or else with the recipe's own body, by their shape histograms, is at "
              "least 1 less this; with new noise, unless that alone is too different")
          .check(in_range(1e-3, 1.0))
          .default_text("");
  job.options
      .add_option("--target", options.target,
                  "with --vary: the mesh that the body is to be like, such as the one that the recipe was "
                  "fitted to")
      .needs(vary)
      .placeholder("MESH")
      .reads();
  job.options.add_option("--count", options.count, "gone; see --members").placeholder("N");
  job.options
      .add_option("--write-recipe", options.mesh.sinks.recipe,
                  "also write the recipe that is made, with the layers of --base, the variation and the seed "
                  "in it, as JSON or compact (.astro); without -o nothing else")
      .placeholder("FILE.json")
      .writes(recipe_and_relief);
  job.options
      .add_flag(
          "--own-heights", options.own_heights,
          "the recipe of --write-recipe holds the heights that --like, --laid or --fill-unseen draw, as "
          "if they had been measured: its patches and tiles take no longer than those of a measured body, "
          "and have the same bytes, but for --finer, which goes on from these heights")
      .needs(job.options.option("--write-recipe"));
  job.options
      .add_option(
          "--page", options.page,
          "also a page, index.html, on which a browser makes the body of the recipe that is made, and "
          "changes it; without -o nothing else. Needs the page's file (scripts/web.sh install)")
      .placeholder("DIR")
      .writes([](const auto& words) { return page_files(words.front()); });
  declare_texture_options(job, options.texture);
  declare_members_options(job, options.members);
  job.options
      .add_option("--sheet", options.sheet,
                  "with --bake: also a sheet of pictures with a row for each body: its finest mesh, its "
                  "coarsest one without and with its maps, and the maps; of up to " +
                      std::to_string(kMostOnSheet) + " members")
      .needs(job.options.option("--bake"))
      .excludes(job.options.option("--manifest"))
      .placeholder("FILE.png")
      .writes();
  // A texture has its own options; all others are of the mesh.
  static constexpr const char* kTextureOptions[] = {
      "recipe",       "output",  "base",       "base-lengths", "seed", "threads", "quiet", "summary", "count",
      "write-recipe", "texture", "texture-of", "tileable",     "bits", "members", "out",   "manifest"};
  for (const auto& row : job.options.rows()) {
    if (std::ranges::find(kTextureOptions, row->name()) == std::end(kTextureOptions))
      job.options.option("--texture").excludes(job.options.option(row->name()));
  }
  for (const char* excluded : {"--texture", "--tile", "--page"}) {
    job.options.option("--members").excludes(job.options.option(excluded));
  }
  job.options.option("--seed")
      .description("replaces the recipe's seed when given; with --vary the number of the variation")
      .default_text("");
}

void make_texture(Job& job, const SynthOptions& options, const Recipe& recipe) {
  require_extension(options.mesh.sinks.file, {".png", ".tif", ".tiff"});
  const std::vector<fs::path> files = texture_files(options.texture, options.mesh.sinks.file);
  for (const fs::path& file : files) require_writable(file);
  write_texture(job, options.texture, recipe, options.recipe, options.mesh.sinks.file);
  summarize_output(job, files.front());
}

// Changes all reliefs; the words say what an option does with their heights, for a recipe without any.
template <class Change>
void change_reliefs(Recipe& recipe, const fs::path& file, std::string_view does, const Change& change) {
  bool has_relief = false;
  for (Layer& layer : recipe.layers) {
    if (ReliefLayer* relief = std::get_if<ReliefLayer>(&layer)) change(*relief), has_relief = true;
  }
  if (has_relief) return;
  throw InputError(
      fmt::format("{}: layers: hold no relief, whose heights {}; fit_shape writes one", file.string(), does));
}

// The recipe of the file, or of the caller. The images of the caller's recipe must not be written over.
Recipe loaded_input(const Job& job, const SynthOptions& options) {
  if (options.caller.recipe.empty()) return load_recipe(options.recipe);
  Recipe recipe = parse_recipe(options.caller.recipe, options.recipe.string());
  load_images(recipe, {}, options.recipe.string());
  for (Layer& layer : recipe.layers) {
    const NamedImage* const named = find_image(layer);
    if (named != nullptr && !named->image.empty()) job.options.require_not_written(named->image);
  }
  return recipe;
}

Recipe read_input(const Job& job, const SynthOptions& options) {
  Recipe recipe = loaded_input(job, options);
  if (!options.base.empty()) {
    recipe = lay_on_base(recipe, options.recipe.string(), load_recipe(options.base), options.base.string(),
                         parse_base_lengths(options.base_lengths));
  }
  // The ground of a draw does not stand in the recipe yet, and is laid.
  if ((options.draw.like || options.laid) && !recipe.population) {
    const ReliefArrangement arrangement =
        options.draw.like ? ReliefArrangement::kLike : ReliefArrangement::kLaid;
    change_reliefs(recipe, options.recipe,
                   options.draw.like ? "--like draws for other places" : "--laid draws for other places",
                   [&](ReliefLayer& relief) { relief.arrangement = arrangement; });
  }
  if (options.fill_unseen) {
    change_reliefs(recipe, options.recipe, "--fill-unseen fills",
                   [](ReliefLayer& relief) { relief.fill_unseen = true; });
  }
  if (job.options.option("--finer").count() > 0) {
    change_reliefs(recipe, options.recipe, "--finer continues",
                   [&](ReliefLayer& relief) { relief.finer = options.finer; });
  }
  apply_conditions(job, options.draw, options.recipe, recipe);
  // A variation has the seed as its number, and members have numbers of their own.
  const bool is_one_variation = options.vary > 0.0 && options.members.range.empty();
  if (job.options.option("--seed").count() > 0 && !is_one_variation) recipe.seed = job.seed;
  return recipe;
}

// The mesh that variations are to be like.
TriangleMesh load_target(const Job& job, const SynthOptions& options, const Recipe& recipe) {
  const Provenance& origin = recipe.provenance;
  if (options.target.empty()) return mesh_for_comparison(recipe);
  if (!origin.input_sha256.empty() && file_sha256(options.target) != origin.input_sha256) {
    job.say("note: " + options.target.string() + " is not the file that the recipe was fitted to, " +
            origin.input_name);
  }
  WoundSurface wound = wound_surface(read_mesh(options.target));
  if (wound.changed()) job.say(options.target.string() + ": " + wound.words());
  return std::move(wound.mesh);
}

Recipe varied(Job& job, const SynthOptions& options, const Recipe& recipe, std::uint64_t seed) {
  const TriangleMesh target = load_target(job, options, recipe);
  const SimilarityMeasure similarity =
      target.triangles.empty() ? SimilarityMeasure() : similarity_with(target);
  Variation variation = find_variation(recipe, similarity, options.vary, seed, job.progress("vary"));
  const std::string whose = options.target.empty() ? "the recipe's own body" : options.target.string();
  job.summary["similarity"] = variation.similarity;
  job.summary["similarity_with"] = options.target.empty() ? "recipe" : "target";
  job.summary["variation"] = to_json(variation);
  job.say(fmt::format("variation {}: similarity {:.4f} with {}; {}", seed, variation.similarity, whose,
                      describe(variation)));
  return std::move(variation.recipe);
}

// Refuses outputs that cannot be written before any work.
void check_outputs(const Job& job, const SynthOptions& options) {
  const bool single = options.members.range.empty();
  if (!options.count.empty()) {
    throw InputError(
        "--count: is gone; write --members A:B, bodies A to B - 1, with {member} in the names of files");
  }
  if (!options.sheet.empty()) {
    require_extension(options.sheet, {".png"});
    if (options.mesh.sinks.file.empty() || options.mesh.sinks.bake == 0)
      throw InputError("--sheet: shows the maps of --bake beside a mesh; add -o FILE.glb");
    if (!single && options.sheet.has_parent_path()) make_output_folder(options.sheet.parent_path());
    require_writable(options.sheet);
    check_sheet(options.members, options.sheet);
  }
  check_finish(options.finish);
  if (!options.mesh.spec.gravity.empty()) question_density(job, options.mesh.spec.gravity[0]);
  check_members(options.members, options.mesh);
  if (!options.mesh.sinks.recipe.empty()) {
    require_extension(options.mesh.sinks.recipe, {".json", ".astro"});
    if (single) require_writable(options.mesh.sinks.recipe);
  }
  if (options.texture.size.empty()) {
    if (options.texture.tileable) throw InputError("--tileable: is about --texture; add --texture WxH");
    if (single) check_mesh_outputs(job, options.mesh);
  } else if (!options.mesh.sinks.file.empty()) {
    require_extension(options.mesh.sinks.file, {".png", ".tif", ".tiff"});
  }
  if (!options.mesh.sinks.file.empty() || !options.mesh.sinks.recipe.empty() || !options.page.empty() ||
      options.mesh.only_predict || options.mesh.sinks.arrays)
    return;
  throw InputError("--output: is required; name the file to make, such as -o body.ply");
}

// Refuses members that would not differ as the options say.
void check_member_options(const Job& job, const Recipe& recipe) {
  if (!recipe.family && !recipe.population && job.options.option("--seed").count() > 0)
    throw InputError(
        "--seed: bodies of --members have their numbers as seeds, but for those of a family; leave "
        "out --seed, and name other numbers");
}

// The body that a recipe's population gives by the recipe's own seed.
FamilyMember single_draw(const Recipe& recipe) {
  FamilyMember member;
  member.body = draw_body(recipe);
  member.recipe = member.body->recipe;
  return member;
}

// The recipe of a drawn body with its ground, reported.
Recipe grounded(Job& job, const SynthOptions& options, const FamilyMember& member,
                const BodyPopulation& population) {
  report_draw(job, member);
  return with_ground(job, options.draw, member, population, options.recipe);
}

void write_sheet(const SynthOptions& options) {
  if (options.mesh.sinks.sheet) options.mesh.sinks.sheet->write(options.sheet);
}

void synthesize(Job& job, const SynthOptions& options) {
  check_outputs(job, options);
  const bool makes_mesh = options.mesh.sinks.wanted() && options.texture.size.empty();
  const std::future<void> start = makes_mesh ? options.mesh.device.start() : std::future<void>();
  Recipe recipe = read_input(job, options);
  const bool has_members = !options.members.range.empty();
  if (recipe.population && !has_members)
    recipe = grounded(job, options, single_draw(recipe), *recipe.population);
  job.summary["length_unit"] = recipe.length_unit;
  if (!options.texture.size.empty()) return make_texture(job, options, recipe);
  if (!recipe.population) require_body(recipe, options.recipe);
  const std::vector<fs::path>& prefixes = options.caller.prefixes;
  if (!options.page.empty())
    check_page(recipe, options.recipe, prefixes);  // before a variation is searched for
  const fs::path& file = options.base.empty() ? options.recipe : options.base;
  const MeshJob& mesh = options.mesh;
  const double patch_side = mesh.spec.patch.empty() ? 0.0 : mesh.spec.patch.back();
  const auto variation = [&](Job& part, const Recipe& of, std::uint64_t seed) {
    return finished(part, options.finish, varied(part, options, of, seed), file.string(), patch_side);
  };
  const bool is_varied = options.vary > 0.0;
  FinishOptions of_whole = options.finish;
  if (has_members) of_whole.albedo = {};  // each member gets its own
  const Recipe whole =
      is_varied || recipe.population ? recipe : finished(job, of_whole, recipe, file.string(), patch_side);
  if (has_members) {
    check_member_options(job, recipe);
    const auto draw = [&](Job& part, std::uint64_t number) {
      if (recipe.population) {
        FamilyMember member = family_member(recipe, number);
        member.recipe = grounded(part, options, member, *recipe.population);
        member.recipe = is_varied ? variation(part, member.recipe, number)
                                  : finished(part, options.finish, member.recipe, file.string(), patch_side);
        return member;
      }
      if (!is_varied) {
        FamilyMember member = family_member(whole, number);
        options.finish.albedo.apply(part, member.recipe);
        return member;
      }
      if (!recipe.family) return FamilyMember{variation(part, recipe, number), {}, {}, {}, {}};
      FamilyMember member = family_member(recipe, number);
      member.recipe = variation(part, member.recipe, number);
      return member;
    };
    const auto draw_own = [&](Job& part, std::uint64_t number) {
      FamilyMember member = draw(part, number);
      if (options.own_heights) member.recipe = with_own_heights(std::move(member.recipe), file.string());
      return member;
    };
    const auto work = mesh.only_predict ? predict_members : make_members;
    work(job, options.members, mesh, {whole, file, draw_own});
    return write_sheet(options);
  }
  Recipe made = is_varied ? variation(job, recipe, job.seed) : whole;
  if (options.own_heights) made = with_own_heights(std::move(made), file.string());
  if (!mesh.sinks.recipe.empty()) write_loaded_recipe(made, mesh.sinks.recipe);
  if (!options.page.empty()) write_page(made, options.recipe, options.page, prefixes);
  if (!mesh.sinks.wanted() && !mesh.only_predict) return;
  make_mesh(job, mesh, made, file);
  write_sheet(options);
}

}  // namespace

JobWork declare_synth(Job& job) { return declare_called_synth(job, {"", {program_prefix()}}); }

JobWork declare_called_synth(Job& job, SynthCaller caller) {
  const auto options = std::make_shared<SynthOptions>();
  options->caller = std::move(caller);
  options->mesh.sinks.arrays = options->caller.arrays;
  declare_options(job, *options);
  return [&job, options] {
    if (!options->members.folder.empty()) options->mesh.sinks.file = options->members.folder / "{member}.ply";
    if (!options->sheet.empty()) options->mesh.sinks.sheet = std::make_shared<MapsSheet>();
    synthesize(job, *options);
  };
}

}  // namespace astrolith
