// synth, run as a user runs it: what it refuses, and in which words.
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

using SynthRefusal = SynthTest;

std::string with_layer(const std::string& layer) {
  return ball_recipe("m", 100, R"(, "layers": [)" + layer + "]");
}

// One line about the size in its unit; not a word about a GPU that nobody asked for.
TEST_F(SynthRefusal, TheClosingLineStatesSizeAndUnit) {
  write("ball.json", ball_recipe("km", 1));
  const std::string said = succeed("ball.json -o ball.ply --resolution 32");
  EXPECT_TRUE(has(said, ", 2 x 2 x 2 km"));
  EXPECT_FALSE(has(said, "computed on the CPU"));
  EXPECT_TRUE(
      has(succeed("ball.json -o ball.ply --resolution 32 --device cpu"), " km; computed on the CPU\n"));
}

// U+202E would turn the rest of the line around, and U+2028 breaks it.
TEST_F(SynthRefusal, WhatARecipeQuotesIsEscaped) {
  write("\u202e\xff.json", replaced(kTwoSpheres, "simplex", "\u202e\u2028\u009b"));
  const std::string said = run("\u202e\xff.json -o out.ply").errors;
  for (const char* raw : {"\u202e", "\u2028", "\u009b", "\xff"}) EXPECT_FALSE(has(said, raw));
  EXPECT_TRUE(has(said, R"(\u202e\xff.json: layers[0].type)"));
  EXPECT_TRUE(has(said, R"(\u202e\u2028\u009b)"));
}

TEST_F(SynthRefusal, GaborLayersThatTakeTooLongAreRefused) {
  std::string lobes;
  for (int bandwidth = 1; bandwidth <= 12; ++bandwidth) {
    lobes += (bandwidth > 1 ? ", [" : "[") + std::to_string(bandwidth) + ", 0.1, 0.2, 1]";
  }
  const auto recipe = [&](const std::string& impulses) {
    return ball_recipe("m", 1,
                       R"(, "layers": [{"type": "gabor", "pixel_size": 0.01, "height_rms": 0.01,
      "impulses_per_kernel": )" +
                           impulses + R"(, "lobes": [)" + lobes + "]}]");
  };
  expect_recipe_refused(recipe("1024"),
                        "layers[0].impulses_per_kernel: these impulses, with those of earlier "
                        "layers, take 136584");
  succeed(write("g.json", recipe("32")) + " -o m.ply --resolution 16");
}

// All pairs of options that name files. Names are compared before anything is read, whatever they end in.
TEST_F(SynthRefusal, NoOutputIsAnInputOrAnotherOutput) {
  write("base.json", kTwoSpheres);
  const std::vector<std::string> outputs{"-o",
                                         "--summary",
                                         "--preview",
                                         "--preview-maps",
                                         "--feature-list",
                                         "--height-map",
                                         "--manifest --members 0:2",
                                         "--write-recipe"};
  const auto with_file = [](const std::string& option, const std::string& file) {
    const std::size_t more = option.find(' ');
    if (more == std::string::npos) return " " + option + " " + file;
    return " " + option.substr(0, more) + " " + file + option.substr(more);
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    refuse("r.json" + with_file(outputs[i], "r.json"), "is the input itself");
    refuse("r.json --base base.json" + with_file(outputs[i], "base.json"), "is the input itself");
    refuse("r.json --vary .1 --target base.json" + with_file(outputs[i], "base.json"), "is the input itself");
    for (std::size_t j = i + 1; j < outputs.size(); ++j)
      refuse("r.json" + with_file(outputs[i], "a.json") + with_file(outputs[j], "a.json"), "two outputs");
  }
  refuse("r.json -o out.ply --height-map r.tif", "r.json: is the input itself");  // its frame
  EXPECT_EQ(text("r.json"), kTwoSpheres);
}

TEST_F(SynthRefusal, BadRecipesAreRefused) {
  expect_recipe_refused(replaced(kTwoSpheres, "amplitude", "amplitud"), "layers[0].amplitud: unknown field");
  expect_recipe_refused(replaced(kTwoSpheres, "0.75", "-0.75"), "body.spheres[1].radius");
  expect_recipe_refused(replaced(kTwoSpheres, "]]}", "]}"), "line 2, column");
  expect_recipe_refused(replaced(kTwoSpheres, "0.05", "NaN"), "line 3, column");
  expect_recipe_refused("", "is empty");
  expect_recipe_refused(kTexture, "");  // no body to mesh
  expect_recipe_refused(replaced(kTwoSpheres, "\"spheres\"", "\"iso_value\": 100, \"spheres\""),
                        "body.iso_value");
  expect_recipe_refused(replaced(kTwoSpheres, "0.05", "1e9"), "layers[0].amplitude: heights of up to");
  // An intersection with a joint of 100 km lowers the whole surface of a body of 2 km by 50 km.
  const std::string layers = R"("octaves": 4}, {"type": "simplex", "amplitude": 0.001, "frequency": 2,
    "combine": {"type": "blend", "operator": "intersection", "width": 100}}])";
  expect_recipe_refused(replaced(kTwoSpheres, R"("octaves": 4}])", layers),
                        "layers[1].combine.width: nothing of the body is left");
}

TEST_F(SynthRefusal, AbsurdSizesAreRefused) {
  for (
      const auto& [layer, culprit] : {
          std::pair{R"({"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 900}]})",
                    "craters[0].diameter: is 900"},
          {R"({"type": "boulders", "boulders": [{"direction": [0, 0, 1], "axes": [900, 800, 700]}]})",
           "boulders[0].axes: is 900"},
          {R"({"type": "craters", "population": {"density": 1e5, "least_diameter": 1, "greatest_diameter": 2}})",
           "population.density: would draw"},
          {R"({"type": "spots", "density": 1e9})", "density: must be at most"},
          {R"({"type": "spots", "amplitude": 0.5, "size": 40, "cell_size": 40, "density": 60, "layers": 12,
                "gain": 4})",
           "density: these spots"},
          {R"({"type": "lava"})", "type: must be one of"},
      }) {
    expect_recipe_refused(with_layer(layer), std::string("layers[0].") + culprit);
  }
  for (const std::string resolution : {"0", "1000000"}) {
    refuse("r.json -o out.ply --resolution " + resolution, "--resolution");
  }
}

TEST_F(SynthRefusal, BadFilesAreRefused) {
  std::filesystem::create_directory(folder_ / "folder.ply");
  write("x.json", "\x89PNG\r\n\x1a\n");
  for (const std::string input : {"absent.json", "x.json"}) refuse(input + " -o out.ply", input);
  for (const std::string output : {"absent/out.ply", "folder.ply", "out.xyz"}) {
    refuse("r.json -o " + output, output);
  }
}

TEST_F(SynthRefusal, ReadOnlyFoldersAreRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms{0555});
  refuse("r.json -o locked/out.ply", "out.ply");
}

}  // namespace
}  // namespace astrolith
