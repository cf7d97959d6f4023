// Recipes for tests: one valid document that uses every field, and the ways to spoil it.
#pragma once

#include <string>
#include <vector>

namespace astrolith::testing {

inline const std::string kCompleteRecipe = R"({
  "format_version": 1,
  "description": "two spheres",
  "length_unit": "km",
  "frame": "body-fixed",
  "seed": 9007199254740991,
  "provenance": {
    "tool": "fit_shape 0.1.0",
    "input_name": "rock.obj",
    "input_sha256": "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
    "options": {"spheres": "2"},
    "achieved": {"mean_distance": 0.001}
  },
  "body": {
    "type": "metaballs", "kernel": "gaussian", "a": 1.5, "b": 1.25, "blend_exponent": 2, "iso_value": 1, "cutoff_radii": 5,
    "spheres": [[0, 0, 0, 1], [0.5, -0.25, 1e-3, 0.75]], "subtract": [[1.25, 0, 0, 0.5]], "groups": {"both": [1, 0], "head": [1]},
    "warp": {"amplitude": 0.1, "frequency": 2, "octaves": 2, "gain": 0.4, "lacunarity": 2.5},
    "operations": [
      {"type": "difference", "alpha": 0.5, "body": {"type": "metaballs", "spheres": [[1, 1, 0, 0.5]]}},
      {"type": "blend", "width": 0.25, "exponent": 2.5, "body": {"type": "metaballs", "kernel": "wyvill",
       "spheres": [[-1, 0, 0, 0.5]], "operations": [
         {"type": "clean_union", "bulge": -0.1, "reach": [0.2, 0.4], "body": {"type": "metaballs", "spheres": [[-2, 0, 0, 0.5]]}}]}}]
  },
  "layers": [
    {"type": "simplex", "name": "grit", "amplitude": 0.02, "frequency": 3, "octaves": 6, "gain": 0.5,
     "lacunarity": 1.95, "scale": [1, 1, 2], "bias": [0.5, 0, 0], "weight": 1, "gradient_modulation": 0.25,
     "albedo": {"normal": 0.04, "color": [1, 1, 0.9], "contrast": 0.25}},
    {"type": "gabor", "name": "rock", "pixel_size": 0.001, "height_rms": 0.002, "impulses_per_kernel": 32,
     "exemplar_mean": 0.4, "exemplar_rms": 0.1,
     "color": {"axis": [0.6, 0.8, 0], "mean": [0.5, 0.25, 0.1]}, "lobes": [[4, 0.125, -0.25, 0.75], [12, 0.5, 0, 0.25]]},
    {"type": "worley", "amplitude": 0.03, "distance": "f2-f1", "warp": {"amplitude": 0.5, "frequency": 4}},
    {"type": "perlin", "amplitude": -0.03, "locality": {"group": "head", "width": 0.125}},
    {"type": "spots", "inverted": true, "cell_size": 3, "size": 2, "sigma": 9, "variances": [1, 2, 1], "layers": 4,
     "density": 2, "exponent": 3, "seed": 7, "even": true, "lattice": [[1, 0, 0], [0.5, 0.75, 0], [0, 0, 1]],
     "parts": [{"center": [0.5, 0, 0], "axes": [1, 0.5, 1], "turn": [0, 0, 30], "weight": -0.5}, {}], "mask": {"layer": "grit", "from": 0.01, "to": -0.01}},
    {"type": "craters", "complex_from": 0.8, "simple": {"depth": 0.15, "extent": 3, "flank": 2},
     "complex": {"terraces": 2, "peak_height": 0.05}, "albedo": {"fresh": 1.5, "color": [1, 1, 1.125]},
     "craters": [{"direction": [0, 0, 1], "diameter": 0.9, "age": 2},
                 {"position": [1, 0, 0], "diameter": 0.5, "depth": 0.06, "rim_height": 0.01}],
     "population": {"count": 40, "least_diameter": 0.05, "greatest_diameter": 0.375, "degradation": 0.5,
                    "depth_deviation": 0.25, "weibull": {"scale": 0.1, "shape": 0.75},
                    "clusters": {"number": 3, "radius": 0.2, "share": 0.5}, "locality": {"group": "both", "width": 0.25}}},
    {"type": "boulders", "smoothing": 0.25, "roughness": 0.125,
     "boulders": [{"direction": [0, 1, 1], "axes": [0.3, 0.2, 0.15], "heading": 30, "tilt": 10, "burial": 0.4}],
     "population": {"density": 2.5, "least_diameter": 0.02, "greatest_diameter": 0.125, "least_burial": 0.2,
                    "mask": {"layer": "grit", "from": 0.005, "to": -0.005, "over": 0.5}, "by_cells": true},
     "gravity": {"density": 1900, "rotation_period": 7.6},
     "albedo": {"normal": 0.045, "spread": 0.25, "bright_share": 0.02, "bright": 2.5}},
    {"type": "sparse", "amplitude": 0.05, "cell_size": 0.5, "levels": 3, "threshold": 0.25, "merged": true},
    {"type": "random_phase", "height_rms": 0.01, "waves": 8, "frequency_min": 2, "frequency_max": 5.5, "randomness": 0.5,
     "combine": {"type": "blend", "operator": "intersection", "width": 0.002}},
    {"type": "exemplar", "image": "images/gravel.png", "image_sha256": "0123456789abcdef0123456789ABCDEF0123456789abcdef0123456789abcdef",
     "height_range": -0.25, "anchor_spacing": 0.35, "border": "mirror", "rotation": "quarter", "color": true},
    {"type": "phasor", "amplitude": 0.01, "frequency": 6, "cell_size": 0.75, "profile": "square", "direction": [0, 1, 0],
     "combine": {"type": "warp", "direction": [0.5, 0, 2]}}
  ],
  "albedo": {"normal": 0.05, "color": [1.25, 1, 0.75], "steep": 1.5, "elevation": {"from": 0, "to": -0.1, "factor": 0.8}},
  "erosion": {"talus_angle": 35, "iterations": 500, "density": 1500, "rotation_period": 4.3},
  "family": {"any_view": true, "any_sun": true, "fields": [
    {"field": "layers[0].amplitude", "distribution": "normal", "low": 0.01, "high": 0.05, "mean": 0.03, "deviation": 0.01},
    {"field": "layers[0].octaves", "distribution": "choice", "values": [2, 3]}]}
}
)";

// A change that spoils kCompleteRecipe: its first `from` becomes `to`, and the reader's error contains
// `error`.
struct Spoiled {
  std::string from;
  std::string to;
  std::string error;
  bool schema_can_tell = true;
};

inline std::string spoil(const Spoiled& change) {
  std::string text = kCompleteRecipe;
  return text.replace(text.find(change.from), change.from.size(), change.to);
}

// Changes that leave the document JSON, but no recipe: each rule that is not the limits or the name of one
// field, and some fields' limits and names. recipe_schema_test.cpp holds those of all fields to the schema.
inline std::vector<Spoiled> spoiled_recipes() {
  return {
      // Misspelt names.
      {R"("spheres": [[0)", R"("sphers": [[0)", R"(body.sphers: unknown field; did you mean 'spheres'?)"},
      {R"("seed")", R"("colour")", R"(colour: unknown field; known are)"},
      {R"("tool")", R"("tol")", R"(provenance.tol: unknown field; did you mean 'tool'?)"},
      {R"("lobes")", R"("LOBES")", R"(layers[1].LOBES: unknown field; known are)"},
      {R"("height_rms")", R"("height\nrms")", R"(layers[1].height\nrms: unknown field; did you mean)"},
      // Missing fields.
      {R"(, "width": 0.125)", R"()", R"(layers[3].locality.width: is missing)"},
      {R"("format_version": 1,)", R"()", R"(format_version: is missing)"},
      {R"(, "lobes": [[4, 0.125, -0.25, 0.75], [12, 0.5, 0, 0.25]])", R"()",
       R"(layers[1].lobes: is missing)"},
      // Values of a wrong type.
      {R"("format_version": 1)", R"("format_version": "1")", R"(format_version: must be an integer, is the)"},
      {R"("km")", R"(7)", R"(length_unit: must be a string, is 7)"},
      {R"("body-fixed")", R"(null)", R"(frame: must be a string, is null)"},
      {R"(9007199254740991)", R"(1.5)", R"(seed: must be an integer, is 1.5)"},
      {R"({"mean_distance": 0.001})", R"([1])", R"(provenance.achieved: must be an object, is an array of)"},
      {R"("a": 1.5)", R"("a": true)", R"(body.a: must be a number, is true)"},
      {R"([[0, 0, 0, 1], [0.5, -0.25, 1e-3, 0.75]])", R"({})", R"(body.spheres: must be an array, is an)"},
      {R"([0, 0, 0, 1])", R"([0, 0, 1])", R"(body.spheres[0]: must be [x, y, z, radius], is an array of 3)"},
      {R"([0, 0, 0, 1])", R"([0, "0", 0, 1])", R"(body.spheres[0].y: must be a number)"},
      {R"([0.5, 0, 0])", R"([0.5, 0])", R"(layers[0].bias: must be [x, y, z], is an array of 2)"},
      {R"([4, 0.125, -0.25, 0.75])", R"([4, 0.125, -0.25, 0.75, 0])", R"(layers[1].lobes[0]: must be)"},
      // Unknown words, and rules that depend on a word.
      {R"("format_version": 1)", R"("format_version": 2)", R"(format_version: is 2, this program reads 1)"},
      {R"("km")", R"("Km")", R"(length_unit: must be "m", "km", "px" or "body", is "Km")"},
      {R"("gaussian", "a": 1.5)", R"("wyvill", "a": 11)", R"(body.a: must be at most 10 for kernel)", false},
      {R"("gaussian", "a": 1.5, "b": 1.25)", R"("cauchy", "a": 0.02, "b": 0.02)",
       R"(body.a: must be at least 0.04)", false},
      {R"("gaussian", "a": 1.5, "b": 1.25, "blend_exponent": 2)", R"("metaball", "blend_exponent": 0.5)",
       R"(body.blend_exponent: must be at least 1 for kernel "metaball")", false},
      {R"("simplex")", R"("worley")", R"(layers[0].gradient_modulation: unknown field)"},
      {R"("rock.obj")", R"("shapes/rock.obj")", R"(provenance.input_name: must be a file name without)"},
      {R"(ba7816bf)", R"(xa7816bf)", R"(provenance.input_sha256: must be 64 hexadecimal digits)"},
      {R"("alpha": 0.5)", R"("width": 0.5)", R"(body.operations[0].width: unknown field)"},
      {R"([[-2, 0, 0, 0.5]]})", R"([[-2, 0, 0, 0]]})",
       R"(body.operations[1].body.operations[0].body.spheres[0].radius: must be above 0)"},
      {R"([0.2, 0.4])", R"([0.2])", R"(body.operations[1].body.operations[0].reach: must be [a1, a2])"},
      {R"({"type": "warp", "direction": [0.5, 0, 2]})", R"({"type": "warp", "dir": [0.5, 0, 2]})",
       R"(layers[10].combine.dir: unknown field; known are)"},
      {R"({"type": "warp", "direction": [0.5, 0, 2]})", R"({"type": "warp"})",
       R"(layers[10].combine.direction: is missing)", false},
      {R"({"type": "warp", "direction": [0.5, 0, 2]})", R"({"type": "add", "width": 1})",
       R"(layers[10].combine.width: unknown field)", false},
      {R"("layer": "grit")", R"("layer": "sand")", R"(layers[4].mask.layer: no layer before this)", false},
      {R"("layer": "grit")", R"("layer": "")", R"(layers[4].mask.layer: must be a name)", false},
      {R"("to": -0.01)", R"("to": 0.01)", R"(layers[4].mask.to: is too near to `from`)", false},
      // Numbers out of range.
      {R"("frequency_max": 5.5)", R"("frequency_max": 1)", R"(layers[8].frequency_max: must be at)", false},
      {R"("images/gravel.png")", R"("/images/gravel.png")", R"(layers[9].image: must be a path relative to)"},
      {R"("images/gravel.png")", R"("")", R"(layers[9].image: must be a path relative)"},
      {R"("0123456789abcdef0123)", R"("x123456789abcdef0123)", R"(layers[9].image_sha256: must be the 64)"},
      {R"("height_range": -0.25)", R"("height_range": 1, "height_rms": 1)",
       R"(layers[9].height_range: must be 0 where height_rms is not)", false},
      {R"("cell_size": 0.75)", R"("cell_size": 1e6)", R"(layers[10].cell_size: frequency *)", false},
      {R"([0, 1, 0])", R"([0, 0, 0])", R"(layers[10].direction: must not be zero)", false},
      {R"("kernel": "wyvill",)", R"("groups": {"a": [0]},)",
       R"(body.operations[1].body.groups: only the first body's spheres)", false},
      {R"("head": [1])", R"("head": [2])", R"(body.groups.head[0]: must be an integer from 0 to 1)", false},
      {R"("head": [1])", R"("head": [])", R"(body.groups.head: must hold at least one)"},
      {R"("head": [1])", R"("head": [1, 1])", R"(body.groups.head[1]: sphere 1 is there already)"},
      {R"("head": [1])", R"("tail": [1])", R"(layers[3].locality.group: the body has no group)", false},
      {R"(9007199254740991)", R"(9007199254740992)", R"(seed: must be an integer from 0 to)"},
      {R"("a": 1.5)", R"("a": 0)", R"(body.a: must be above 0 (from 1e-12)"},
      {R"("blend_exponent": 2)", R"("blend_exponent": 60)", R"(blend_exponent * a must be at most 80, is 90)",
       false},
      {R"("cutoff_radii": 5)", R"("cutoff_radii": 1)", R"(body.cutoff_radii: must be above 1)"},
      {R"(1e-3, 0.75])", R"(1e300, 0.75])", R"(body.spheres[1].z: must be from -1e+12)"},
      {R"([[0, 0, 0, 1], [0.5, -0.25, 1e-3, 0.75]])", R"([])", R"(body.spheres: must hold at least one)"},
      {R"([[1.25, 0, 0, 0.5]])", R"([0.5])", R"(body.subtract[0])"},
      {R"("blend_exponent": 2)", R"("blend_exponent": 50)", R"(body.subtract: asks for)", false},
      {R"("octaves": 6)", R"("octaves": 0)", R"(layers[0].octaves: must be an integer from 1 to 24, is 0)"},
      {R"("octaves": 6)", R"("octaves": 3000000000)", R"(layers[0].octaves: must be an integer)"},
      {R"("lacunarity": 2.5)", R"("lacunarity": 0.5)", R"(body.warp.lacunarity: must be above 1)"},
      {R"("low": 0.01)", R"("low": "x")", R"(family.fields[0].low: must be a number, is the string "x")"},
      {R"("low": 0.01)", R"("low": 1)", R"(family.fields[0].high: must be at least low, 1, is 0.05)", false},
      {R"("layers[0].octaves", "dist)", R"("layers[0].octave", "dist)",
       R"(family.fields[1].field: names no number of this recipe: "layers[0].octave")", false},
      {R"("rotation_period": 4.3)", R"("rotation_period": 1e-3)", R"(erosion.rotation_period: must be from)"},
      {R"("inverted": true)", R"("inverted": 1)", R"(layers[4].inverted: must be true or false, is 1)"},
      {R"("density": 2)", R"("density": 1e9)", R"(layers[4].density: must be at most 64 impulses a cell)"},
      {R"("exponent": 3)", R"("exponent": 6)", R"(layers[4].density: must be at most 64)", false},
      {R"("size": 2)", R"("size": 20)", R"(layers[4].cell_size: a spot's half axis)", false},
      {R"("center": [0.5, 0, 0])", R"("center": [50, 0, 0])", R"(layers[4].cell_size: a spot's half)", false},
      {R"([0.5, 0.75, 0])", R"([0.9, 0.3, 0])", R"(layers[4].lattice: its cells must be 0.4 high)", false},
      {R"([0.5, 0.75, 0])", R"([2, 0.75, 0])", R"(layers[4].lattice[1]: must be 0.4 to 2 long)", false},
      {R"("axes": [1, 0.5, 1])", R"("axes": [1, 0, 1])", R"(layers[4].parts[0].axes.y: must be from 0.01)"},
      {R"("terraces")", R"("steps")", R"(layers[5].complex.steps: unknown field; known are)"},
      {R"("direction": [0, 0, 1])", R"("direction": [0, 0, 0])",
       R"(layers[5].craters[0].direction: must not be [0, 0, 0])", false},
      {R"("direction": [0, 0, 1])", R"("direction": [0, 0, 1], "position": [0, 0, 1])",
       R"(layers[5].craters[0].direction: stands beside a position)"},
      {R"("depth": 0.06)", R"("depth": 0.6)", R"(layers[5].craters[1].depth: must be from 0 to 0.5)", false},
      {R"("count": 40, )", R"()", R"(layers[5].population.count: is missing; give a count or a density)"},
      {R"("count": 40)", R"("count": 40, "density": 1)", R"(layers[5].population.count: stands beside a)"},
      {R"("greatest_diameter": 0.375)", R"("greatest_diameter": 0.01)",
       R"(layers[5].population.greatest_diameter: is 0.01, below least_diameter)", false},
      {R"("group": "both")", R"("group": "bath")", R"(layers[5].population.locality.group: the body)", false},
      {R"("layer": "grit", "from": 0.005)", R"("layer": "sand", "from": 0.005)",
       R"(layers[6].population.mask.layer: no layer before this one has the name "sand")", false},
      {R"("to": -0.005)", R"("to": 0.005)", R"(layers[6].population.mask.to: is too near to `from`)", false},
      {R"("to": -0.01}},)", R"("to": -0.01, "over": 0.5}},)",
       R"(layers[4].mask.over: only a population has it; leave it out)", false},
      {R"("density": 2.5)", R"("count": 25)", R"(layers[6].population.by_cells: a population drawn)", false},
      {R"("by_cells": true)", R"("by_cells": true, "clusters": {"number": 3, "radius": 1})",
       R"(layers[6].population.by_cells: a population drawn by cells has no clusters; leave one)", false},
      {R"([0.3, 0.2, 0.15])", R"([0.3, 0.2, 0.01])", R"(layers[6].boulders[0].axes: the shortest)", false},
      {R"("least_burial": 0.2)", R"("least_burial": 0.7)",
       R"(layers[6].population.greatest_burial: is 0.6, below least_burial)", false},
      {R"("impulses_per_kernel": 32)", R"("impulses_per_kernel": 32, "evaluation": "tiles")",
       R"(layers[1].evaluation: "tiles" is gone; leave it out)"},
      {R"([[4, 0.125, -0.25, 0.75], [12, 0.5, 0, 0.25]])", R"([])", R"(layers[1].lobes: must hold at least)"},
      {R"(-0.25, 0.75], [12)", R"(-0.25, 0], [12)", R"(layers[1].lobes[0].variance: must be above 0 (from)"},
  };
}

}  // namespace astrolith::testing
