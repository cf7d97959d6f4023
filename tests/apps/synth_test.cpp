// synth as a process: its memory, and the C library's code for other processors.
#include <algorithm>

#include "numerics/memory_use.h"
#include "tests/apps/program_runner.h"
#include "tests/tasks/synth/recipes.h"

namespace astrolith {
namespace {

using testing::has;

const std::string kDrawnCraters = ball_recipe("m", 100, R"(,
  "layers": [{"type": "simplex", "amplitude": 3, "frequency": 0.02, "octaves": 3},
    {"type": "craters", "population": {"count": 2000, "exponent": 1.7, "least_diameter": 6, "greatest_diameter": 60}}])");

// The C library has other code, with other last bits, for processors without fma. Its tunables choose that
// code here.
class SynthByProcessor : public testing::ProgramTest {
 protected:
  SynthByProcessor() : ProgramTest(ASTROLITH_SYNTH) { write("r.json", kDrawnCraters); }
  // What synth writes with the C library's code for this processor, or for one without wide vectors.
  std::string bytes(const std::string& tunables, const std::string& more) {
    ::setenv("GLIBC_TUNABLES", tunables.c_str(), 1);
    succeed("r.json -o mesh.ply --resolution 32 " + more);
    ::unsetenv("GLIBC_TUNABLES");
    return text("mesh.ply") + text("list.csv");
  }
  void expect_no_change(const std::string& more) {
    EXPECT_EQ(bytes("", more), bytes("glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4", more)) << more;
  }
};

TEST_F(SynthByProcessor, TheCLibrarysCodeChangesNothing) {
  expect_no_change("--feature-list list.csv");
  expect_no_change("--patch 100 0 0 20");
}

TEST_F(SynthByProcessor, TheCLibrarysCodeChangesNoVariationLong) { expect_no_change("--vary 0.9 --seed 3"); }

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

class SynthMemory : public testing::ProgramTest {
 protected:
  SynthMemory() : ProgramTest(ASTROLITH_SYNTH) {}
  void SetUp() override {
    if (!kMemoryIsTheProgramsOwn) GTEST_SKIP() << "a sanitizer has memory of its own";
  }
};

TEST_F(SynthMemory, MemoryStaysBelowWhatIsAllowed) {
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

TEST_F(SynthMemory, MemoryOfImpulsesIsMetFromBothSides) {
  const std::string line = write("masked.json", kMaskedByGabor) + " -o out.ply --resolution 96";
  const auto predicted = figures(line + " --predict").at("predicted"), made = figures(line);
  EXPECT_LE(made.at("peak_bytes"), 1.2 * predicted.at("peak_bytes").get<double>());
  EXPECT_GE(made.at("peak_bytes"), 0.5 * predicted.at("peak_bytes").get<double>());
}

// A warp that folds the surface leaves many blocks that it might cross and does not, and sheets of surface
// that a coarse mesh does not show.
TEST_F(SynthMemory, MemoryOfAFoldedSurfaceIsMetFromBothSides) {
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

// An eroded mesh is held in memory, with its edges and verticals, beside the bricks of impulses.
TEST_F(SynthMemory, MemoryOfErosionIsPredicted) {
  write("eroded.json",
        two_spheres_with(gabor_layer(0.007, 32), R"(, "erosion": {"talus_angle": 30, "iterations": 5})"));
  const std::string line = "eroded.json -o out.ply --resolution 20 --threads 1";
  const double predicted = figures(line + " --predict").at("predicted").at("peak_bytes");
  EXPECT_LE(figures(line).at("peak_bytes"), 1.2 * predicted);
}

// A block here needs bricks of 200 MB, many times what the cache keeps of them.
TEST_F(SynthMemory, ThreadsHoldFewBricksOfImpulses) {
  write("dense.json", two_spheres_with(gabor_layer(0.02, 400)));
  EXPECT_LE(figures("dense.json -o out.ply --resolution 12 --threads 2").at("peak_bytes"), 120e6);
}

}  // namespace
}  // namespace astrolith
