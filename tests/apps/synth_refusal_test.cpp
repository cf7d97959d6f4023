// synth, run as a user runs it: what it refuses, and in which words.
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using SynthRefusal = SynthTest;

TEST_F(SynthRefusal, ABodyThatTheIsoValueErasesIsAnInputError) {
  expect_recipe_refused(replaced(kTwoSpheres, "\"spheres\"", "\"iso_value\": 100, \"spheres\""),
                        "body.iso_value");
}

TEST_F(SynthRefusal, HeightsBeyondAllMeasureAreRefusedByName) {
  expect_recipe_refused(replaced(kTwoSpheres, "0.05", "1e9"), "layers[0].amplitude: heights of up to");
}

// An intersection with a joint of 100 km lowers the whole surface of a body of 2 km by 50 km.
TEST_F(SynthRefusal, ALayerThatTakesTheBodyAwayIsNamed) {
  const std::string layers = R"("octaves": 4}, {"type": "simplex", "amplitude": 0.001, "frequency": 2,
    "combine": {"type": "blend", "operator": "intersection", "width": 100}}])";
  expect_recipe_refused(replaced(kTwoSpheres, R"("octaves": 4}])", layers),
                        "layers[1].combine.width: nothing of the body is left");
}

// One line about the size in its unit; not a word about a GPU that nobody asked for.
TEST_F(SynthRefusal, TheClosingLineStatesSizeAndUnit) {
  const std::string ball = folder_.write("ball.json", R"({"format_version": 1, "length_unit": "km",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}})");
  const std::string mesh = (folder_ / "ball.ply").string();
  const std::string said = testing::run_program(kSynth, {ball, "-o", mesh, "--resolution", "32"}).errors;
  EXPECT_NE(said.find(", 2 x 2 x 2 km"), std::string::npos) << said;
  EXPECT_EQ(said.find("computed on the CPU"), std::string::npos) << said;
  const std::string asked =
      testing::run_program(kSynth, {ball, "-o", mesh, "--resolution", "32", "--device", "cpu"}).errors;
  EXPECT_NE(asked.find(" km; computed on the CPU\n"), std::string::npos) << asked;
}

// U+202E would turn the rest of the line around, and U+2028 breaks it.
TEST_F(SynthRefusal, WhatARecipeQuotesIsEscaped) {
  expect_recipe_refused(replaced(kTwoSpheres, "simplex", "\u202esim\u2028plex\u009b"),
                        "layers[0].type: must be one of");
  const testing::Outcome outcome = run_program(
      kSynth, {folder_.write("\u202e\xff.json", replaced(kTwoSpheres, "simplex", "\u202e\u2028\u009b")), "-o",
               (folder_ / "out.ply").string()});
  for (const char* raw : {"\u202e", "\u2028", "\u009b", "\xff"}) {
    EXPECT_EQ(outcome.errors.find(raw), std::string::npos) << outcome.errors;
  }
  EXPECT_NE(outcome.errors.find(R"(\u202e\xff.json: layers[0].type)"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find(R"(\u202e\u2028\u009b)"), std::string::npos) << outcome.errors;
}

TEST_F(SynthRefusal, SpotsThatTakeTooLongAreRefused) {
  expect_recipe_refused(R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs",
    "spheres": [[0, 0, 0, 100]]}, "layers": [{"type": "spots", "amplitude": 0.5, "size": 40, "cell_size": 40,
    "density": 60, "layers": 12, "gain": 4}]})",
                        "layers[0].density: these spots");
}

TEST_F(SynthRefusal, GaborLayersThatTakeTooLongAreRefused) {
  std::string lobes;
  for (int bandwidth = 1; bandwidth <= 12; ++bandwidth)
    lobes += (bandwidth > 1 ? ", [" : "[") + std::to_string(bandwidth) + ", 0.1, 0.2, 1]";
  const auto recipe = [&](const std::string& impulses) {
    return R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]},
      "layers": [{"type": "gabor", "pixel_size": 0.01, "height_rms": 0.01, "impulses_per_kernel": )" +
           impulses + R"(, "lobes": [)" + lobes + "]}]}";
  };
  expect_recipe_refused(recipe("1024"),
                        "layers[0].impulses_per_kernel: these impulses, with those of earlier "
                        "layers, take 136584");
  const testing::Outcome made = run_program(kSynth, {folder_.write("r.json", recipe("32")), "-o",
                                                     (folder_ / "m.ply").string(), "--resolution", "16"});
  EXPECT_EQ(made.status, 0) << made.errors;
}

TEST_F(SynthRefusal, NoOutputIsTheInputOrAnotherOutput) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const std::string output = (folder_ / "out.ply").string();
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--summary", recipe}, "is the input itself");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--preview", recipe}, "is the input itself");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--summary", output}, "two outputs");
  EXPECT_EQ(text_of(recipe), kTwoSpheres);
}

TEST_F(SynthRefusal, BadRecipesAreRefused) {
  expect_recipe_refused(replaced(kTwoSpheres, "amplitude", "amplitud"), "layers[0].amplitud: unknown field");
  expect_recipe_refused(replaced(kTwoSpheres, "0.75", "-0.75"), "body.spheres[1].radius");
  expect_recipe_refused(replaced(kTwoSpheres, "]]}", "]}"), "line 2, column");
  expect_recipe_refused(replaced(kTwoSpheres, "0.05", "NaN"), "line 3, column");
  expect_recipe_refused("", "is empty");
  expect_recipe_refused(kTexture, "");  // no body to mesh
}

TEST_F(SynthRefusal, AbsurdSizesAreRefused) {
  const auto with_layer = [](const std::string& layer) {
    return R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100]]},
               "layers": [)" +
           layer + "]}";
  };
  expect_recipe_refused(
      with_layer(R"({"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 900}]})"),
      "layers[0].craters[0].diameter: is 900");
  expect_recipe_refused(
      with_layer(R"({"type": "boulders", "boulders": [{"direction": [0, 0, 1], "axes": [900, 800, 700]}]})"),
      "layers[0].boulders[0].axes: is 900");
  expect_recipe_refused(
      with_layer(
          R"({"type": "craters", "population": {"density": 1e5, "least_diameter": 1, "greatest_diameter": 2}})"),
      "layers[0].population.density: would draw");
  expect_recipe_refused(with_layer(R"({"type": "spots", "density": 1e9})"),
                        "layers[0].density: must be at most");
  expect_recipe_refused(with_layer(R"({"type": "lava"})"), "layers[0].type: must be one of");
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  for (const char* resolution : {"0", "1000000"}) {
    expect_refusal(folder_, kSynth,
                   {recipe, "-o", (folder_ / "out.ply").string(), "--resolution", resolution},
                   "--resolution");
  }
}

TEST_F(SynthRefusal, BadFilesAreRefused) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  std::filesystem::create_directory(folder_ / "folder.ply");
  const auto refuse = [&](const std::string& input, const std::string& output, const std::string& culprit) {
    expect_refusal(folder_, kSynth, {input, "-o", output, "--resolution", "16"}, culprit);
  };
  refuse((folder_ / "absent.json").string(), (folder_ / "out.ply").string(), "absent.json");
  refuse(folder_.write("x.json", "\x89PNG\r\n\x1a\n"), (folder_ / "out.ply").string(), "x.json");
  refuse(recipe, (folder_ / "absent" / "out.ply").string(), "out.ply");
  refuse(recipe, (folder_ / "folder.ply").string(), "folder.ply");
  refuse(recipe, (folder_ / "out.xyz").string(), "out.xyz");
}

TEST_F(SynthRefusal, ReadOnlyFoldersAreRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms{0555});
  expect_refusal(folder_, kSynth, {recipe, "-o", (folder_ / "locked" / "out.ply").string()}, "out.ply");
}

}  // namespace
}  // namespace astrolith
