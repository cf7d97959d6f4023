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
    "type": "metaballs", "kernel": "gaussian",
    "a": 1.5, "b": 1.25, "blend_exponent": 2, "iso_value": 1, "cutoff_radii": 5,
    "spheres": [[0, 0, 0, 1], [0.5, -0.25, 1e-3, 0.75]],
    "warp": {"amplitude": 0.1, "frequency": 2, "octaves": 2, "gain": 0.4, "lacunarity": 2.5}
  },
  "layers": [
    {"type": "simplex", "name": "grit", "amplitude": 0.02, "frequency": 3, "octaves": 6, "gain": 0.5,
     "lacunarity": 1.95, "scale": [1, 1, 2], "bias": [0.5, 0, 0], "weight": 1, "gradient_modulation": 0.25},
    {"type": "gabor", "name": "rock", "pixel_size": 0.001, "height_rms": 0.002, "impulses_per_kernel": 32,
     "exemplar_mean": 0.4, "exemplar_rms": 0.1,
     "color": {"axis": [0.6, 0.8, 0], "mean": [0.5, 0.25, 0.1]}, "lobes": [[4, 0.125, -0.25, 0.75], [12, 0.5, 0, 0.25]]},
    {"type": "worley", "amplitude": 0.03, "distance": "f2-f1", "warp": {"amplitude": 0.5, "frequency": 4}},
    {"type": "perlin", "amplitude": -0.03},
    {"type": "spots", "inverted": true, "cell_size": 3, "size": 2, "sigma": 9, "variances": [1, 2, 1], "layers": 4,
     "density": 2, "exponent": 3},
    {"type": "craters", "complex_from": 0.8, "simple": {"depth": 0.15, "extent": 3, "flank": 2},
     "complex": {"terraces": 2, "peak_height": 0.05},
     "craters": [{"direction": [0, 0, 1], "diameter": 0.9, "age": 2},
                 {"position": [1, 0, 0], "diameter": 0.5, "depth": 0.06, "rim_height": 0.01}],
     "population": {"count": 40, "least_diameter": 0.05, "greatest_diameter": 0.375, "degradation": 0.5}},
    {"type": "boulders", "smoothing": 0.25, "roughness": 0.125,
     "boulders": [{"direction": [0, 1, 1], "axes": [0.3, 0.2, 0.15], "heading": 30, "tilt": 10, "burial": 0.4}],
     "population": {"density": 2.5, "least_diameter": 0.02, "greatest_diameter": 0.125, "least_burial": 0.2}},
    {"type": "sparse", "amplitude": 0.05, "cell_size": 0.5, "levels": 3, "threshold": 0.25, "merged": true}
  ],
  "erosion": {"talus_angle": 35, "iterations": 500, "density": 1500, "rotation_period": 4.3}
}
)";

// kCompleteRecipe with the first `from` replaced by `to`, and what the reader's error must contain.
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

// Documents that are JSON and no recipe.
inline std::vector<Spoiled> spoiled_recipes() {
  return {
      // Names.
      {R"("spheres": [[0)", R"("sphers": [[0)", R"(body.sphers: unknown field; did you mean 'spheres'?)"},
      {R"("amplitude": 0.02)", R"("amplitdue": 0.02)",
       R"(layers[0].amplitdue: unknown field; did you mean 'amplitude'?)"},
      {R"("length_unit")", R"("lenght_unit")", R"(lenght_unit: unknown field; did you mean 'length_unit'?)"},
      {R"("seed")", R"("colour")", R"(colour: unknown field; known are)"},
      {R"("tool")", R"("tol")", R"(provenance.tol: unknown field; did you mean 'tool'?)"},
      {R"("lobes")", R"("LOBES")", R"(layers[1].LOBES: unknown field; known are)"},
      {R"("height_rms")", R"("height\nrms")",
       R"(layers[1].height\nrms: unknown field; did you mean 'height_rms'?)"},
      {R"("mean": [)", R"("meen": [)", R"(layers[1].color.meen: unknown field; did you mean 'mean'?)"},
      // Missing fields.
      {R"("axis": [0.6, 0.8, 0], )", R"()", R"(layers[1].color.axis: is missing)"},
      {R"("format_version": 1,)", R"()", R"(format_version: is missing)"},
      {R"("length_unit": "km",)", R"()", R"(length_unit: is missing)"},
      {R"("type": "metaballs",)", R"()", R"(body.type: is missing)"},
      {R"("type": "simplex",)", R"()", R"(layers[0].type: is missing)"},
      {R"(, "lobes": [[4, 0.125, -0.25, 0.75], [12, 0.5, 0, 0.25]])", R"()",
       R"(layers[1].lobes: is missing)"},
      // Types.
      {R"("format_version": 1)", R"("format_version": "1")",
       R"(format_version: must be an integer, is the string "1")"},
      {R"("km")", R"(7)", R"(length_unit: must be a string, is 7)"},
      {R"("body-fixed")", R"(null)", R"(frame: must be a string, is null)"},
      {R"(9007199254740991)", R"(1.5)", R"(seed: must be an integer, is 1.5)"},
      {R"({"spheres": "2"})", R"({"spheres": 2})", R"(provenance.options.spheres: must be a string, is 2)"},
      {R"({"mean_distance": 0.001})", R"({"mean_distance": "small"})",
       R"(provenance.achieved.mean_distance: must be a number)"},
      {R"({"mean_distance": 0.001})", R"([1])",
       R"(provenance.achieved: must be an object, is an array of 1)"},
      {R"("a": 1.5)", R"("a": true)", R"(body.a: must be a number, is true)"},
      {R"([[0, 0, 0, 1], [0.5, -0.25, 1e-3, 0.75]])", R"({})",
       R"(body.spheres: must be an array, is an object)"},
      {R"([0, 0, 0, 1])", R"([0, 0, 1])", R"(body.spheres[0]: must be [x, y, z, radius], is an array of 3)"},
      {R"([0, 0, 0, 1])", R"([0, "0", 0, 1])", R"(body.spheres[0].y: must be a number)"},
      {R"([0.5, 0, 0])", R"([0.5, 0])", R"(layers[0].bias: must be [x, y, z], is an array of 2)"},
      {R"("octaves": 6)", R"("octaves": 6.5)", R"(layers[0].octaves: must be an integer, is 6.5)"},
      {R"([4, 0.125, -0.25, 0.75])", R"([4, 0.125, -0.25, 0.75, 0])",
       R"(layers[1].lobes[0]: must be [bandwidth, frequency_x, frequency_y, variance])"},
      {R"([4, 0.125, -0.25, 0.75])", R"([4.5, 0.125, -0.25, 0.75])",
       R"(layers[1].lobes[0].bandwidth: must be an integer)"},
      // Words.
      {R"("format_version": 1)", R"("format_version": 2)", R"(format_version: is 2, this program reads 1)"},
      {R"("km")", R"("Km")", R"(length_unit: must be "m", "km" or "px", is "Km")"},
      {R"("metaballs")", R"("mesh")", R"(body.type: must be "metaballs")"},
      {R"("gaussian")", R"("wyvill")", R"(body.kernel: must be "gaussian")"},
      {R"("simplex")", R"("value")",
       R"(layers[0].type: must be one of "simplex", "perlin", "worley", "spots", "sparse", "craters", "boulders" and "gabor", is "value")"},
      {R"("simplex")", R"("worley")", R"(layers[0].gradient_modulation: unknown field)"},
      {R"("f2-f1")", R"("f3")", R"(layers[2].distance: must be "f1", "f2" or "f2-f1", is "f3")"},
      {R"("perlin", "amplitude")", R"("perlin", "distance")", R"(layers[3].distance: unknown field)"},
      {R"("rock.obj")", R"("shapes/rock.obj")",
       R"(provenance.input_name: must be a file name without folders)"},
      {R"(ba7816bf)", R"(xa7816bf)", R"(provenance.input_sha256: must be 64 hexadecimal digits)"},
      // Ranges.
      {R"(9007199254740991)", R"(9007199254740992)",
       R"(seed: must be an integer from 0 to 9007199254740991)"},
      {R"(9007199254740991)", R"(-1)", R"(seed: must be an integer from 0)"},
      {R"("a": 1.5)", R"("a": 0)", R"(body.a: must be above 0 (from 1e-12)"},
      {R"("b": 1.25)", R"("b": -1)", R"(body.b: must be above 0 (from 1e-12)"},
      {R"("blend_exponent": 2)", R"("blend_exponent": 0)",
       R"(body.blend_exponent: must be above 0 (from 1e-12)"},
      {R"("blend_exponent": 2)", R"("blend_exponent": 60)", R"(blend_exponent * a must be at most 80, is 90)",
       false},
      {R"("iso_value": 1)", R"("iso_value": 0)", R"(body.iso_value: must be above 0 (from 1e-12)"},
      {R"("cutoff_radii": 5)", R"("cutoff_radii": 1)", R"(body.cutoff_radii: must be above 1)"},
      {R"(1e-3, 0.75])", R"(1e-3, -0.75])",
       R"(body.spheres[1].radius: must be above 0 (from 1e-12 to 1e+12), is -0.75)"},
      {R"(1e-3, 0.75])", R"(1e300, 0.75])", R"(body.spheres[1].z: must be from -1e+12)"},
      {R"([[0, 0, 0, 1], [0.5, -0.25, 1e-3, 0.75]])", R"([])", R"(body.spheres: must hold at least one)"},
      {R"("frequency": 3)", R"("frequency": 0)", R"(layers[0].frequency: must be above 0 (from 1e-12)"},
      {R"("octaves": 6)", R"("octaves": 0)", R"(layers[0].octaves: must be an integer from 1 to 24, is 0)"},
      {R"("octaves": 6)", R"("octaves": 25)", R"(layers[0].octaves: must be an integer from 1 to 24, is 25)"},
      {R"("octaves": 6)", R"("octaves": 3000000000)", R"(layers[0].octaves: must be an integer)"},
      {R"("gain": 0.5)", R"("gain": -0.5)", R"(layers[0].gain: must be from 0 to 4, is -0.5)"},
      {R"(0.25})", R"(-0.25})", R"(layers[0].gradient_modulation: must be from 0 to 1e+12, is -0.25)"},
      {R"("amplitude": 0.1, )", R"()", R"(body.warp.amplitude: is missing)"},
      {R"("lacunarity": 2.5)", R"("lacunarity": 0.5)", R"(body.warp.lacunarity: must be above 1)"},
      {R"("frequency": 4)", R"("frequency": -4)", R"(layers[2].warp.frequency: must be above 0)"},
      {R"("frequency": 4)", R"("frequenzy": 4)", R"(layers[2].warp.frequenzy: unknown field)"},
      {R"("talus_angle": 35, )", R"()", R"(erosion.talus_angle: is missing)"},
      {R"("talus_angle": 35)", R"("talus_angle": 90)", R"(erosion.talus_angle: must be from 1 to 85, is 90)"},
      {R"("iterations": 500)", R"("iterations": 0)",
       R"(erosion.iterations: must be an integer from 1 to 100000)"},
      {R"("density": 1500)", R"("density": 0)", R"(erosion.density: must be from 1 to 30000, is 0)"},
      {R"("rotation_period": 4.3)", R"("rotation_period": 1e-3)",
       R"(erosion.rotation_period: must be from 0.01 to 1e+06)"},
      {R"("inverted": true)", R"("inverted": 1)", R"(layers[4].inverted: must be true or false, is 1)"},
      {R"("density": 2)", R"("density": 1e9)", R"(layers[4].density: must be at most 64 impulses a cell)"},
      {R"("exponent": 3)", R"("exponent": 6)", R"(layers[4].density: must be at most 64)", false},
      {R"("size": 2)", R"("size": 20)", R"(layers[4].cell_size: a spot's half axis)", false},
      {R"([1, 2, 1])", R"([1, 0, 1])", R"(layers[4].variances.y: must be from 1e-06)"},
      {R"("layers": 4)", R"("layers": 13)", R"(layers[4].layers: must be an integer from 1 to 12, is 13)"},
      {R"("terraces")", R"("steps")", R"(layers[5].complex.steps: unknown field; known are)"},
      {R"("terraces": 2)", R"("terraces": 17)",
       R"(layers[5].complex.terraces: must be an integer from 0 to 16)"},
      {R"("extent": 3)", R"("extent": 1)", R"(layers[5].simple.extent: must be from 1.05 to 10, is 1)"},
      {R"("direction": [0, 0, 1])", R"("diection": [0, 0, 1])",
       R"(layers[5].craters[0].diection: unknown field)"},
      {R"("direction": [0, 0, 1], )", R"()", R"(layers[5].craters[0].direction: is missing)"},
      {R"("direction": [0, 0, 1])", R"("direction": [0, 0, 0])",
       R"(layers[5].craters[0].direction: must not be [0, 0, 0])", false},
      {R"("direction": [0, 0, 1])", R"("direction": [0, 0, 1], "position": [0, 0, 1])",
       R"(layers[5].craters[0].direction: stands beside a position)"},
      {R"("diameter": 0.9)", R"("diameter": 0)", R"(layers[5].craters[0].diameter: must be above 0)"},
      {R"("depth": 0.06)", R"("depth": 0.6)", R"(layers[5].craters[1].depth: must be from 0 to 0.5, is 0.6)",
       false},
      {R"("age": 2)", R"("age": -2)", R"(layers[5].craters[0].age: must be from 0)"},
      {R"("count": 40)", R"("count": 1000001)",
       R"(layers[5].population.count: must be an integer from 0 to 1000000)"},
      {R"("count": 40, )", R"()", R"(layers[5].population.count: is missing; give a count or a density)"},
      {R"("count": 40)", R"("count": 40, "density": 1)",
       R"(layers[5].population.count: stands beside a density)"},
      {R"("greatest_diameter": 0.375)", R"("greatest_diameter": 0.01)",
       R"(layers[5].population.greatest_diameter: is 0.01, below least_diameter)", false},
      {R"("degradation": 0.5)", R"("degradation": 1.5)",
       R"(layers[5].population.degradation: must be from 0 to 1)"},
      {R"("burial": 0.4)", R"("burial": 1.4)",
       R"(layers[6].boulders[0].burial: must be from 0 to 1, is 1.4)"},
      {R"([0.3, 0.2, 0.15])", R"([0.3, 0.2, 0])", R"(layers[6].boulders[0].axes.z: must be above 0)"},
      {R"([0.3, 0.2, 0.15])", R"([0.3, 0.2, 0.01])",
       R"(layers[6].boulders[0].axes: the shortest must be at least 0.05 of the longest)", false},
      {R"("least_burial": 0.2)", R"("least_burial": 0.7)",
       R"(layers[6].population.greatest_burial: is 0.6, below least_burial)", false},
      {R"("density": 2.5)", R"("density": -2.5)", R"(layers[6].population.density: must be from 0)"},
      {R"("roughness": 0.125)", R"("roughness": 1)", R"(layers[6].roughness: must be from 0 to 0.5, is 1)"},
      {R"("threshold": 0.25)", R"("threshold": 2)", R"(layers[7].threshold: must be from 0 to 1, is 2)"},
      {R"("merged": true)", R"("merged": "yes")", R"(layers[7].merged: must be true or false)"},
      {R"("levels": 3)", R"("levels": 0)", R"(layers[7].levels: must be an integer from 1 to 16, is 0)"},
      {R"(1.95)", R"(1)", R"(layers[0].lacunarity: must be above 1 and at most 16, is 1)"},
      {R"("pixel_size": 0.001)", R"("pixel_size": 0)",
       R"(layers[1].pixel_size: must be above 0 (from 1e-12)"},
      {R"("height_rms": 0.002)", R"("height_rms": -1)", R"(layers[1].height_rms: must be from 0)"},
      {R"("impulses_per_kernel": 32)", R"("impulses_per_kernel": 0)",
       R"(layers[1].impulses_per_kernel: must be an integer from 1 to 1024)"},
      {R"("exemplar_rms": 0.1)", R"("exemplar_rms": -0.1)", R"(layers[1].exemplar_rms: must be from 0)"},
      {R"([0.6, 0.8, 0])", R"([0.6, 1.8, 0])", R"(layers[1].color.axis.y: must be from -1 to 1, is 1.8)"},
      {R"([[4, 0.125, -0.25, 0.75], [12, 0.5, 0, 0.25]])", R"([])",
       R"(layers[1].lobes: must hold at least one)"},
      {R"([12, 0.5)", R"([14, 0.5)",
       R"(layers[1].lobes[1].bandwidth: must be an integer from 1 to 12, is 14)"},
      {R"([12, 0.5)", R"([12, 0.51)", R"(layers[1].lobes[1].frequency_x: must be from -0.5 to 0.5, is 0.51)"},
      {R"(-0.25, 0.75], [12)", R"(-0.25, 0], [12)",
       R"(layers[1].lobes[0].variance: must be above 0 (from 1e-12)"},
  };
}

}  // namespace astrolith::testing
