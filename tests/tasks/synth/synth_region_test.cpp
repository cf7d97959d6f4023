// synth: tiles, patches and height maps.
#include <cmath>
#include <cstring>
#include <map>

#include "geometry/io/mesh_io.h"
#include "tasks/gravity/gravity_job.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

using SynthRegion = SynthTest;

// A reader of numbers after TIFF 6.0 and GeoTIFF 1.1: the directory's entries are 12 bytes each.
class Tiff {
 public:
  explicit Tiff(std::string bytes) : bytes_(std::move(bytes)) {
    const std::size_t directory = number(4, 4);
    for (std::size_t k = 0; k < number(directory, 2); ++k) {
      entries_[number(directory + 2 + 12 * k, 2)] = directory + 2 + 12 * k;
    }
  }
  std::uint64_t number(std::size_t at, int count) const {
    std::uint64_t value = 0;
    for (int k = count - 1; k >= 0; --k) {
      value = value << 8 | static_cast<unsigned char>(bytes_.at(at + static_cast<std::size_t>(k)));
    }
    return value;
  }
  template <typename T>
  T real(std::size_t at) const {
    T value = 0;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }
  std::size_t entry(int tag) const { return entries_.at(static_cast<std::uint64_t>(tag)); }
  std::uint64_t short_at(int tag) const { return number(entry(tag) + 8, 2); }
  // Where the first strip begins.
  std::size_t first_pixel() const {
    return number(entry(273) + 4, 4) == 1 ? values_at(273) : number(values_at(273), 4);
  }
  // Where the values of a tag begin, which do not fit into its entry.
  std::size_t values_at(int tag) const { return number(entry(tag) + 8, 4); }

 private:
  std::string bytes_;
  std::map<std::uint64_t, std::size_t> entries_;
};

TEST_F(SynthRegion, HeightMapOfAPatch) {
  write("ball.json", ball_recipe("km", 1));
  succeed("ball.json -o p.ply --patch 0 0.6 0.8 0.1 --resolution 32 --height-map h.tif");
  const auto frame = json("h.json");
  EXPECT_EQ(frame["pixels"], 32);
  EXPECT_NEAR(frame["metres_per_pixel"], 100.0 / 32, 1e-9);
  EXPECT_NEAR(frame["up"][1], 0.6, 5e-3);
  EXPECT_NEAR(frame["up"][2], 0.8, 5e-3);
  ASSERT_EQ(text("h.tif").substr(0, 4), std::string("II*\0", 4));
  const Tiff tiff(text("h.tif"));
  EXPECT_EQ(tiff.short_at(256), 32u);
  EXPECT_EQ(tiff.short_at(258), 32u);
  EXPECT_EQ(tiff.short_at(339), 3u);  // floats
  EXPECT_NEAR(tiff.real<double>(tiff.values_at(33550)), 100.0 / 32, 1e-9);
  EXPECT_NEAR(tiff.real<double>(tiff.values_at(33922) + 24), -50.0, 1e-9);
  EXPECT_NEAR(tiff.real<double>(tiff.values_at(33922) + 32), 50.0, 1e-9);
  EXPECT_EQ(text("h.tif").substr(tiff.entry(42113) + 8, 3), "nan");
  // The pixel beside the middle lies 1 km from the ball's centre.
  const double height = tiff.real<float>(tiff.first_pixel() + 4 * (16 * 32 + 16));
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = [&](const char* name) { return frame[name][k].get<double>(); };
    const double p = axis("origin_m") + 0.5 * 3.125 * (axis("right") - axis("ahead")) + height * axis("up");
    square += p * p;
  }
  EXPECT_NEAR(std::sqrt(square), 1000.0, 0.1);
}

// The cube stands on a slope of the ball: a patch along the body's axes leaves pixels empty there.
TEST_F(SynthRegion, AnAlignedPatchFillsItsHeightMap) {
  write("ball.json", ball_recipe("km", 1));
  const std::string line = "ball.json -o p.ply --patch 0.36 0.48 0.8 0.2 --resolution 40 --height-map h.tif";
  succeed(line);
  EXPECT_GT(json("h.json")["pixels_without_data"], 50);
  succeed(line + " --aligned --summary s.json");
  EXPECT_EQ(json("h.json")["pixels_without_data"], 0);
  const auto axes = json("s.json").at("patch_axes");
  EXPECT_EQ(axes.at("up"), json("h.json").at("up"));
  const Vec3d up{axes["up"][0], axes["up"][1], axes["up"][2]};
  EXPECT_GT(dot(up, Vec3d{0.36, 0.48, 0.8}), 0.99999);
  for (const Vec3d& p : read_mesh(folder_ / "p.ply").vertices) {
    ASSERT_NEAR(norm(p + Vec3d{0.36, 0.48, 0.8}), 1.0, 1e-4);  // along the body's axes
  }
  const std::string bytes = text("p.ply");
  succeed(line + " --aligned --threads 1");
  EXPECT_TRUE(bytes == text("p.ply"));
  succeed(line + " --aligned --even");
}

// The map of a measured ground and that of the same ground with stones and grains have the same pixels.
TEST_F(SynthRegion, AFrameDoesNotFollowWhatIsAdded) {
  const std::string grains =
      R"({"type": "gabor", "pixel_size": 1, "height_rms": 0.3, "lobes": [[3, 0.1, 0.1, 1]]})";
  const std::string hills = R"({"type": "simplex", "amplitude": 9, "frequency": 0.01})";
  write("prior.json", ball_recipe("m", 300, ", \"layers\": [" + hills + "]"));
  write("truth.json", ball_recipe("m", 300, ", \"layers\": [" + hills + "," + grains + "]"));
  for (const std::string more : {"", " --aligned"}) {
    const std::string line = " -o p.ply --patch 0 180 240 40 --resolution 32 --height-map h.tif" + more;
    succeed("prior.json" + line);
    const auto frame = json("h.json");
    const std::string heights = text("h.tif");
    succeed("truth.json" + line + " --finish itokawa --from 12 --to 2");
    for (const char* field : {"metres_per_pixel", "origin_m", "right", "ahead", "up"})
      EXPECT_EQ(json("h.json")[field], frame[field]) << field << more;
    EXPECT_NE(text("h.tif"), heights);
  }
}

// A worm of 1 km: its patch has the mass of the whole, as `gravity` computes it from a mesh of other cells.
TEST_F(SynthRegion, APatchHasTheGravityOfTheWholeBodyLong) {
  std::string spheres = "[0, 0, 0, 0.06]";
  for (int k = -6; k <= 6; ++k) spheres += ", [" + std::to_string(0.07 * k) + ", 0, 0, 0.06]";
  write("worm.json",
        R"({"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "spheres": [)" + spheres +
            R"(]}, "layers": [{"type": "boulders", "boulders":
    [{"direction": [0.01, 0, 1], "axes": [0.004, 0.004, 0.004]}]}]})");
  const std::string line =
      "worm.json -o p.ply --patch 0 0 0.064 0.05 --aligned --resolution 25 --gravity 2000 5 --summary s.json";
  succeed(line + " --hazard-map hazards.tif --footprint 0.006");
  const auto patch_gravity = json("s.json")["gravity"];
  std::string points;
  for (const Vec3d& p : read_mesh(folder_ / "p.ply").vertices)
    points += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z + 0.064) + "\n";
  write("points.csv", points);
  testing::run_job(
      "gravity", declare_gravity,
      testing::split_words("worm.json --density 2000 --period 5 --resolution 200 --points points.csv "
                           "--sample 0 --degree 0 --summary g.json --quiet"),
      folder_.path());
  const auto body_values = json("g.json")["values"];
  for (const char* column : {"potential_J_kg", "effective_gravity_m_s2"}) {
    for (const char* end : {"min", "max"})
      EXPECT_NEAR(patch_gravity[column][end].get<double>() / body_values[column][end].get<double>(), 1.0,
                  5e-3)
          << column;
  }
  const auto hazards = json("s.json")["hazard_map"];
  EXPECT_NEAR(hazards["footprint_m"], 6.0, 1e-9);
  EXPECT_NEAR(hazards["largest"]["boulder_m"], 4.0, 1e-6);
  EXPECT_GT(hazards["largest"]["roughness_m"], 0.2);
  const Tiff tiff(text("hazards.tif"));
  EXPECT_EQ(tiff.short_at(277), 3u);                              // bands
  EXPECT_TRUE(std::isnan(tiff.real<float>(tiff.first_pixel())));  // a footprint that leaves the map
  refuse_all(line, {{" --hazard-map x.tif", "--footprint"},
                    {" --hazard-map x.tif --footprint 0.001", "--footprint: is less than 3 pixels"},
                    {" --hazard-map x.png --footprint 0.006", "x.png"}});
  refuse("worm.json -o p.ply --hazard-map x.tif --footprint 1 --gravity 2000 5", "--hazard-map");
}

// Its own coordinates have the digits; readers add the origin, and a .stl has no place for one.
TEST_F(SynthRegion, AWholeBodyStatesTheOriginOfItsRecipe) {
  write("far.json", replaced(ball_recipe("km", 0.5), "\"body\"", "\"origin\": [16.5, 0, -2], \"body\""));
  for (const std::string file : {"far.ply", "far.obj", "far.stl", "far.tab"}) {
    succeed("far.json --resolution 24 -o " + file + " --summary s.json");
    const Vec3d middle = read_mesh(folder_ / file).bounds().center();
    EXPECT_LT(norm(middle - Vec3d{16.5, 0, -2}), 1e-3) << file;
    EXPECT_EQ(json("s.json").at("origin"), nlohmann::json({16.5, 0.0, -2.0})) << file;
  }
  EXPECT_TRUE(
      has(text("far.ply"), "comment origin of the body, to be added to all coordinates: 16.5 0 -2\n"));
}

TEST_F(SynthRegion, PatchesAreOpenAndStateTheirOrigin) {
  const std::string bytes = synthesise("patch.ply", "--patch -1.05 0 0.125 0.3 --summary s.json");
  EXPECT_TRUE(has(bytes, "comment origin, to be added to all coordinates: -1.05 0 0.125\n"));
  const auto summary = json("s.json");
  EXPECT_FALSE(summary.at("closed"));
  EXPECT_EQ(summary.at("origin"), nlohmann::json({-1.05, 0.0, 0.125}));
  EXPECT_NEAR(summary.at("cell"), 0.3 / 32, 1e-12);
  const Box box = read_mesh(folder_ / "patch.ply").bounds();
  EXPECT_LE(box.max.x, 0.1501);
  EXPECT_GE(box.min.y, -0.1501);
  EXPECT_GT(box.extent().y, 0.299);
  EXPECT_TRUE(has(synthesise("patch.glb", "--patch -1.05 0 0.125 0.3"), "\"origin\":[-1050.0,0"));  // metres
}

TEST_F(SynthRegion, APatchBesideTheSurfaceIsMovedOntoIt) {
  EXPECT_TRUE(
      has(succeed("r.json -o moved.ply --resolution 16 --patch -0.99 -0.094 0 0.01"), "moved by 0.0"));
}

// A ball of 17 km under grains of millimetres: the whole mesh names the layer that it leaves out, and a patch
// has it.
TEST_F(SynthRegion, LayersLeftOutAreNamed) {
  write("big.json", ball_recipe("m", 8500, R"(,
    "layers": [{"type": "gabor", "name": "grains", "pixel_size": 0.004, "height_rms": 0.004,
                "lobes": [[1, 0.2, 0.1, 1], [10, 0.01, 0, 3]]}])"));
  const std::string line = "big.json -o out.ply --resolution 32 --device cpu --summary s.json";
  EXPECT_TRUE(has(succeed(line), "layers[0] \"grains\" (gabor, 25 % of its variance); a --patch shows it"));
  const auto whole = json("s.json").at("layers_left_out");
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].at("layer"), 0);
  EXPECT_EQ(whole[0].at("name"), "grains");
  EXPECT_EQ(whole[0].at("type"), "gabor");
  EXPECT_NEAR(whole[0].at("variance_share"), 0.25, 1e-6);
  EXPECT_FALSE(has(succeed(line + " --patch 8500 0 0 0.5"), "left out"));
  EXPECT_TRUE(json("s.json").at("layers_left_out").empty());
}

// Floats of the body's frame would show steps of a millimetre.
TEST_F(SynthRegion, APatchOfALargeBodyKeepsFineLayers) {
  write("big.json", ball_recipe("m", 8500, R"(,
    "layers": [{"type": "gabor", "pixel_size": 0.004, "height_rms": 0.004, "lobes": [[3, -0.05, 0.1, 1]]}])"));
  succeed("big.json -o out.ply --resolution 96 --device cpu --patch 8500 0 0 0.5");
  double squares = 0.0, sum = 0.0;
  const TriangleMesh mesh = read_mesh(folder_ / "out.ply");
  for (const Vec3d& p : mesh.vertices) {
    sum += p.x;
    squares += p.x * p.x;
  }
  const double n = static_cast<double>(mesh.vertices.size());
  EXPECT_NEAR(std::sqrt(squares / n - sum * sum / (n * n)), 0.004, 0.001);
}

}  // namespace
}  // namespace astrolith
