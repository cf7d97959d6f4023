// synth, run as a user runs it: resolutions by triangles, predictions and limits of memory.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/memory_use.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using SynthPrediction = SynthTest;

// A body with a Gabor layer of three bands, which masks a second layer.
const std::string kMaskedByGabor = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "gabor", "name": "grain", "pixel_size": 0.01, "height_rms": 0.01,
              "lobes": [[2, 0.1, 0.1, 1], [3, 0.125, -0.25, 1], [4, 0.05, 0.02, 1]]},
             {"type": "simplex", "amplitude": 0.05, "frequency": 2,
              "mask": {"layer": "grain", "from": -0.01, "to": 0.01}}]})";

// Two spheres under a Gabor layer of one band.
std::string gabor_layer(double pixel_size, int impulses, const std::string& more) {
  return R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
    "layers": [{"type": "gabor", "height_rms": 0.003, "lobes": [[3, 0.125, -0.25, 1]], "pixel_size": )" +
         std::to_string(pixel_size) + ", \"impulses_per_kernel\": " + std::to_string(impulses) + "}]" + more +
         "}";
}

TEST_F(SynthPrediction, TrianglesChooseTheResolutionAndMemoryIsKept) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres);
  const std::string output = (folder_ / "out.obj").string(), summary = (folder_ / "s.json").string();
  const testing::Outcome outcome =
      run_program(kSynth, {recipe, "-o", output, "--triangles", "30000", "--summary", summary});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const auto figures = nlohmann::json::parse(text_of(summary));
  EXPECT_NEAR(figures["triangles"].get<double>(), 30e3, 3e3);
  EXPECT_NEAR(figures["predicted"]["triangles"].get<double>(), 30e3, 2e3);
  std::filesystem::remove(output);
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--resolution", "1024", "--max-memory", "0.1"},
                 "needs");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--triangles", "1e10"}, "--triangles");
  expect_refusal(folder_, kSynth, {recipe, "-o", output, "--resolution", "64", "--triangles", "1000"},
                 "excludes");
}

TEST_F(SynthPrediction, PredictionWritesNothing) {
  const std::string summary = (folder_ / "s.json").string();
  const testing::Outcome outcome =
      run_program(kSynth, {folder_.write("r.json", kTwoSpheres), "-o", (folder_ / "x.ply").string(),
                           "--resolution", "64", "--predict", "--summary", summary});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("triangles"), std::string::npos);
  EXPECT_EQ(folder_.files(), (std::set<std::string>{"r.json", "s.json"}));
  const auto predicted = nlohmann::json::parse(text_of(summary)).at("predicted");
  for (const char* figure : {"triangles", "file_bytes", "peak_bytes", "seconds"}) {
    EXPECT_GT(predicted.at(figure).get<double>(), 0.0) << figure;
  }
}

TEST_F(SynthPrediction, AMaskMayNameAGaborLayer) {
  const std::string recipe = folder_.write("masked.json", kMaskedByGabor);
  const std::string output = (folder_ / "out.ply").string();
  for (const char* size : {"--resolution", "--triangles"}) {
    const std::string value = size == std::string("--resolution") ? "24" : "3000";
    const testing::Outcome made = run_program(kSynth, {recipe, "-o", output, size, value});
    EXPECT_EQ(made.status, 0) << made.errors;
  }
  const testing::Outcome predicted =
      run_program(kSynth, {recipe, "-o", output, "--resolution", "24", "--predict"});
  EXPECT_EQ(predicted.status, 0) << predicted.errors;
}

TEST_F(SynthPrediction, MemoryStaysBelowWhatIsAllowed) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  const std::string recipe = folder_.write("masked.json", kMaskedByGabor);
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  int made = 0, refused = 0;
  for (const double gigabytes : {0.01, 0.03, 0.045, 0.06, 0.5}) {
    const testing::Outcome outcome =
        run_program(kSynth, {recipe, "-o", output, "--resolution", "64", "--threads", "2", "--max-memory",
                             std::to_string(gigabytes), "--summary", summary});
    if (outcome.status == 0) {
      ++made;
      EXPECT_LE(nlohmann::json::parse(text_of(summary)).at("peak_bytes").get<double>(), 1e9 * gigabytes);
    } else {
      ++refused;
      EXPECT_EQ(outcome.status, 2) << outcome.errors;
      EXPECT_NE(outcome.errors.find("GB"), std::string::npos) << outcome.errors;
      EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    }
  }
  EXPECT_GE(made, 1);
  EXPECT_GE(refused, 1);
}

// Prediction looks at few blocks, so that it is far quicker than the mesh and not far from the truth.
TEST_F(SynthPrediction, PredictionMeetsTheMesh) {
  const std::string recipe = folder_.write("masked.json", kMaskedByGabor);
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe, "-o", output, "--resolution", "96", "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary));
  };
  const auto predicted = figures({"--predict"}), made = figures({});
  const auto& of_mesh = predicted.at("predicted");
  EXPECT_NEAR(of_mesh.at("triangles").get<double>() / made.at("triangles").get<double>(), 1.0, 0.3);
  if (!kMemoryIsTheProgramsOwn) return;
  EXPECT_LE(made.at("peak_bytes").get<double>(), 1.2 * of_mesh.at("peak_bytes").get<double>());
  EXPECT_GE(made.at("peak_bytes").get<double>(), 0.5 * of_mesh.at("peak_bytes").get<double>());
}

// A body with craters, boulders and noise.
const std::string kWithLandforms = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [100, 0, 0, 75]]},
  "layers": [{"type": "simplex", "amplitude": 4, "frequency": 0.02, "octaves": 4},
             {"type": "craters", "population": {"count": 60, "least_diameter": 10, "greatest_diameter": 60,
                                                "exponent": 2}},
             {"type": "boulders", "population": {"count": 80, "least_diameter": 8, "greatest_diameter": 25,
                                                 "exponent": 2}}]})";
// Noise in the space around a body.
const std::string kHills = R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.08, "frequency": 2, "octaves": 6}]})";

// A warp that folds the surface leaves many blocks that it might cross and does not, and sheets of surface
// that a coarse mesh does not show.
TEST_F(SynthPrediction, MemoryOfAFoldedSurfaceIsMetFromBothSides) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  const std::string recipe = folder_.write("r.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]],
             "warp": {"amplitude": 0.5, "frequency": 2, "octaves": 3}}})");
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe,      "-o", output,      "--resolution", "240",
                                       "--threads", "1",  "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary));
  };
  const auto predicted = figures({"--predict"}).at("predicted"), made = figures({});
  const double memory = predicted.at("peak_bytes").get<double>() / made.at("peak_bytes").get<double>();
  EXPECT_LE(memory, 1.4);
  EXPECT_GE(memory, 1.0 / 1.2);
  EXPECT_GE(predicted.at("triangles").get<double>(), 0.4 * made.at("triangles").get<double>());
}

// Samples are counted, because seconds depend on what else the machine does.
TEST_F(SynthPrediction, EvaluatesFewSamplesBesideThoseOfTheMesh) {
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  for (const std::string& content : {kTwoSpheres, kHills, kWithLandforms}) {
    const std::string recipe = folder_.write("r.json", content);
    const auto figures = [&](std::vector<std::string> more) {
      std::vector<std::string> arguments{recipe, "-o", output, "--resolution", "320", "--summary", summary};
      arguments.insert(arguments.end(), more.begin(), more.end());
      EXPECT_EQ(run_program(kSynth, arguments).status, 0);
      return nlohmann::json::parse(text_of(summary));
    };
    const double own = figures({"--predict"}).at("predicted").at("own_evaluations").get<double>();
    const double of_mesh = figures({}).at("evaluations").get<double>();
    EXPECT_GT(own, 0.0);
    EXPECT_LE(own, 0.05 * of_mesh) << content;
  }
}

TEST_F(SynthPrediction, TrianglesAreMetOnRoughBodiesToo) {
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  for (const std::string& content : {kHills, kWithLandforms}) {
    const std::string recipe = folder_.write("r.json", content);
    const testing::Outcome made =
        run_program(kSynth, {recipe, "-o", output, "--triangles", "100000", "--summary", summary});
    ASSERT_EQ(made.status, 0) << made.errors;
    EXPECT_NEAR(nlohmann::json::parse(text_of(summary)).at("triangles").get<double>(), 100e3, 10e3)
        << content;
  }
}

// Gravity sums over the body at every vertex, and labels evaluate the field there once more.
TEST_F(SynthPrediction, LabelsAndGravityAreCounted) {
  std::string layers;
  for (int i = 0; i < 12; ++i) {
    layers += std::string(i > 0 ? "," : "") +
              R"({"type": "simplex", "amplitude": 0.002, "frequency": 2, "octaves": 8, "seed": )" +
              std::to_string(i) + "}";
  }
  const std::string recipe = folder_.write("r.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]}, "layers": [)" +
                                                         layers + "]}");
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe,      "-o", output,      "--resolution", "96",
                                       "--threads", "1",  "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary));
  };
  const auto predicted = [&](std::vector<std::string> more) {
    more.push_back("--predict");
    return figures(more).at("predicted");
  };
  // Few samples tell the seconds, which scatter: the least of three predictions counts.
  double plain = predicted({}).at("seconds").get<double>();
  for (int again = 0; again < 2; ++again) plain = std::min(plain, predicted({}).at("seconds").get<double>());
  for (const std::vector<std::string>& of :
       {std::vector<std::string>{"--labels"}, {"--gravity", "2000", "5"}}) {
    const auto& with = predicted(of);
    if (of[0] == "--gravity") {
      EXPECT_GT(with.at("seconds").get<double>(), 1.3 * plain);
    }
    figures(of);
    EXPECT_NEAR(with.at("file_bytes").get<double>() / double(std::filesystem::file_size(output)), 1.0, 0.08)
        << of[0];
  }
}

// An eroded mesh is held in memory, with its edges and verticals, beside the tiles of impulses.
TEST_F(SynthPrediction, MemoryOfErosionIsPredicted) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  const std::string recipe = folder_.write(
      "eroded.json", gabor_layer(0.007, 32, R"(, "erosion": {"talus_angle": 30, "iterations": 5})"));
  const std::string output = (folder_ / "out.ply").string(), summary = (folder_ / "s.json").string();
  const auto figures = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{recipe,      "-o", output,      "--resolution", "20",
                                       "--threads", "1",  "--summary", summary};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(kSynth, arguments).status, 0);
    return nlohmann::json::parse(text_of(summary));
  };
  const double predicted = figures({"--predict"}).at("predicted").at("peak_bytes").get<double>();
  EXPECT_LE(figures({}).at("peak_bytes").get<double>(), 1.2 * predicted);
}

// A block here needs tiles of 200 MB, many times what the cache keeps of them.
TEST_F(SynthPrediction, ThreadsHoldFewTilesOfImpulses) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer has memory of its own";
  const std::string recipe = folder_.write("dense.json", gabor_layer(0.02, 400, "")),
                    summary = (folder_ / "s.json").string();
  const testing::Outcome made =
      run_program(kSynth, {recipe, "-o", (folder_ / "out.ply").string(), "--resolution", "12", "--threads",
                           "2", "--summary", summary});
  EXPECT_EQ(made.status, 0) << made.errors;
  EXPECT_LE(nlohmann::json::parse(text_of(summary)).at("peak_bytes").get<double>(), 120e6);
}

}  // namespace
}  // namespace astrolith
