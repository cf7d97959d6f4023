// synth, run as a user runs it: resolutions by triangles, predictions and limits of memory.
#include <algorithm>

#include "numerics/memory_use.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

using SynthPrediction = SynthTest;

std::string two_spheres_with(const std::string& layers, const std::string& more = "") {
  return R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]}, "layers": [)" +
         layers + "]" + more + "}";
}

// A body with a Gabor layer of three bands, which masks a second layer.
const std::string kMaskedByGabor =
    two_spheres_with(R"({"type": "gabor", "name": "grain", "pixel_size": 0.01, "height_rms": 0.01,
      "lobes": [[2, 0.1, 0.1, 1], [3, 0.125, -0.25, 1], [4, 0.05, 0.02, 1]]},
     {"type": "simplex", "amplitude": 0.05, "frequency": 2,
      "mask": {"layer": "grain", "from": -0.01, "to": 0.01}})");

// A Gabor layer of one band.
std::string gabor_layer(double pixel_size, int impulses) {
  return R"({"type": "gabor", "height_rms": 0.003, "lobes": [[3, 0.125, -0.25, 1]], "pixel_size": )" +
         std::to_string(pixel_size) + ", \"impulses_per_kernel\": " + std::to_string(impulses) + "}";
}

TEST_F(SynthPrediction, TrianglesChooseTheResolutionAndMemoryIsKept) {
  const auto made = figures("r.json -o out.obj --triangles 30000");
  EXPECT_NEAR(made["triangles"], 30e3, 3e3);
  EXPECT_NEAR(made["predicted"]["triangles"], 30e3, 2e3);
  std::filesystem::remove(folder_ / "out.obj");
  refuse("r.json -o out.obj --resolution 1024 --max-memory 0.1", "needs");
  refuse("r.json -o out.obj --triangles 1e10", "--triangles");
  refuse("r.json -o out.obj --resolution 64 --triangles 1000", "excludes");
}

TEST_F(SynthPrediction, PredictionWritesNothing) {
  const testing::Outcome said = run("r.json -o x.ply --resolution 64 --predict --summary s.json");
  EXPECT_TRUE(has(said.output, "triangles"));
  EXPECT_EQ(said.errors, "");
  EXPECT_EQ(folder_.files(), (std::set<std::string>{"r.json", "s.json"}));
  for (const char* figure : {"triangles", "file_bytes", "peak_bytes", "seconds", "processor_seconds"}) {
    EXPECT_GT(json("s.json").at("predicted").at(figure), 0.0) << figure;
  }
}

TEST_F(SynthPrediction, AMaskMayNameAGaborLayer) {
  write("masked.json", kMaskedByGabor);
  for (const std::string size : {"--resolution 24", "--triangles 3000", "--resolution 24 --predict"}) {
    succeed("masked.json -o out.ply " + size);
  }
}

TEST_F(SynthPrediction, MemoryStaysBelowWhatIsAllowed) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  write("masked.json", kMaskedByGabor);
  int made = 0, refused = 0;
  for (const double gigabytes : {0.01, 0.03, 0.045, 0.06, 0.5}) {
    const testing::Outcome outcome =
        run("masked.json -o out.ply --resolution 64 --threads 2 --summary s.json --max-memory " +
            std::to_string(gigabytes));
    if (outcome.status == 0) {
      ++made;
      EXPECT_LE(json("s.json").at("peak_bytes"), 1e9 * gigabytes);
    } else {
      ++refused;
      EXPECT_EQ(outcome.status, 2) << outcome.errors;
      EXPECT_TRUE(has(outcome.errors, "GB"));
      EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    }
  }
  EXPECT_GE(made, 1);
  EXPECT_GE(refused, 1);
}

TEST_F(SynthPrediction, MemoryOfImpulsesIsMetFromBothSides) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  const std::string line = write("masked.json", kMaskedByGabor) + " -o out.ply --resolution 96";
  const auto predicted = figures(line + " --predict").at("predicted"), made = figures(line);
  EXPECT_LE(made.at("peak_bytes"), 1.2 * predicted.at("peak_bytes").get<double>());
  EXPECT_GE(made.at("peak_bytes"), 0.5 * predicted.at("peak_bytes").get<double>());
}

// A warp that folds the surface leaves many blocks that it might cross and does not, and sheets of surface
// that a coarse mesh does not show.
TEST_F(SynthPrediction, MemoryOfAFoldedSurfaceIsMetFromBothSides) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  write("r.json", R"({"format_version": 1, "length_unit": "m",
    "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]],
             "warp": {"amplitude": 0.5, "frequency": 2, "octaves": 3}}})");
  const std::string line = "r.json -o out.ply --resolution 240 --threads 1";
  const auto predicted = figures(line + " --predict").at("predicted"), made = figures(line);
  const double memory = predicted.at("peak_bytes").get<double>() / made.at("peak_bytes").get<double>();
  EXPECT_LE(memory, 1.2);
  EXPECT_GE(memory, 1.0 / 1.2);
  EXPECT_GE(predicted.at("triangles"), 0.8 * made.at("triangles").get<double>());
}

// An eroded mesh is held in memory, with its edges and verticals, beside the tiles of impulses.
TEST_F(SynthPrediction, MemoryOfErosionIsPredicted) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer's memory is not predicted";
  write("eroded.json",
        two_spheres_with(gabor_layer(0.007, 32), R"(, "erosion": {"talus_angle": 30, "iterations": 5})"));
  const std::string line = "eroded.json -o out.ply --resolution 20 --threads 1";
  const double predicted = figures(line + " --predict").at("predicted").at("peak_bytes");
  EXPECT_LE(figures(line).at("peak_bytes"), 1.2 * predicted);
}

// A block here needs tiles of 200 MB, many times what the cache keeps of them.
TEST_F(SynthPrediction, ThreadsHoldFewTilesOfImpulses) {
  if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer has memory of its own";
  write("dense.json", two_spheres_with(gabor_layer(0.02, 400)));
  EXPECT_LE(figures("dense.json -o out.ply --resolution 12 --threads 2").at("peak_bytes"), 120e6);
}

}  // namespace
}  // namespace astrolith
