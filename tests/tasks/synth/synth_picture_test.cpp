// synth: pictures and textures.
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

// rod.json is a long body, which covers a small part of a picture from its side.
class SynthPicture : public SynthTest {
 protected:
  SynthPicture() {
    write("rod.json",
          replaced(ball_recipe("km", 1), "]]", "], [1.5, 0, 0, 0.9], [3, 0, 0, 0.8], [4.5, 0, 0, 1]]"));
  }
};

TEST_F(SynthPicture, PicturesCanBeTakenFromElsewhere) {
  const auto picture = [&](const std::string& more) {
    succeed("rod.json -o out.ply --resolution 32 --preview p.png " + more);
    return text("p.png");
  };
  const std::string one = picture("--view 0 1 0");
  EXPECT_FALSE(one == picture("--view 0 1 0 --view 0 0 1"));
  EXPECT_FALSE(one == picture("--view 0 1 0 --sun 0 0 1"));
  std::filesystem::remove(folder_ / "p.png");
  EXPECT_FALSE(one == picture("--view 0 1 0 --sun-body 0 0 1"));
  EXPECT_FALSE(one == picture("--view 0 1 0 --phase 90 180"));
  EXPECT_FALSE(one == picture("--camera \"lat 0 lon 90 fov 40\""));
  EXPECT_TRUE(one == picture("--camera \"from 0 1 0\""));
}

TEST_F(SynthPicture, CamerasThatSeeNothingAreNamed) {
  const std::string line = "rod.json -o x.ply --resolution 32 --preview p.png --camera ";
  // The second stands just below the surface of the mesh, where a coarse mesh proves nothing.
  for (const char* camera : {"\"lat 20 lon 45 fov 30 radii .01\"", "\"at 0 0 .95 target 3 0 .95 fov 30\""}) {
    refuse(line + camera, "camera: it stands inside the body");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.ply"));
  }
  EXPECT_TRUE(has(succeed(line + "\"at 0 0 9 target 0 0 20 fov 30\" --camera \"lat 0 fov 30\""),
                  "note: p.png: the body covers no pixel of view 1"));
  EXPECT_TRUE(has(succeed(line + "\"lat 0 fov 30 radii 1e6\""), "covers no pixel of view 1"));
  EXPECT_FALSE(has(succeed(line + "\"lat 0 fov 30 radii 4\""), "no pixel"));
}

TEST_F(SynthPicture, SizesBitsAndBackgrounds) {
  const auto type = [&](const std::string& more) {
    succeed("r.json -o out.ply --resolution 16 --preview p.png --picture-size 64x64 " + more);
    return text("p.png").substr(24, 2);
  };
  EXPECT_EQ(type(""), "\x08\x02");
  EXPECT_EQ(type("--picture-bits 16"), "\x10\x02");
  EXPECT_EQ(type("--background transparent"), "\x08\x06");
  EXPECT_EQ(text("p.png").substr(16, 8), std::string("\0\0\0\x40\0\0\0\x40", 8));  // width and height
}

TEST_F(SynthPicture, ErosionLeavesMapsWithoutLayers) {
  write("e.json", replaced(text("rod.json"), "]]}",
                           R"(]]}, "erosion": {"talus_angle": 30, "density": 2000, "rotation_period": 0})"));
  EXPECT_TRUE(
      has(succeed("e.json -o x.ply --resolution 24 --preview p.png --view 0 1 0 --preview-maps p.npz"),
          "neither layer nor instance"));
  EXPECT_TRUE(has(text("p.npz"), "depth.npy"));
  EXPECT_FALSE(has(text("p.npz"), "instance.npy"));
}

TEST_F(SynthPicture, ColouredLayersMakeAPicture) {
  write("c.json",
        replaced(kTexture, "\"lobes\"",
                 R"("exemplar_rms": 0.1, "color": {"axis": [1, 0, 0], "mean": [0.5, 0.25, 1]}, "lobes")"));
  const auto texture = [&](const std::string& name, const std::string& more = "") {
    succeed("c.json --texture 96x64 -o " + name + " " + more);
    return text(name);
  };
  const auto bits_and_type = [](const std::string& png) { return png.substr(24, 2); };
  EXPECT_EQ(bits_and_type(texture("c16.png")), "\x10\x02");
  EXPECT_EQ(bits_and_type(texture("c8.png", "--bits 8 --tileable")), "\x08\x02");
  EXPECT_EQ(bits_and_type(texture("h.png", "--texture-of height")), std::string("\x10\x00", 2));
  EXPECT_GT(texture("c.tif").size(), 3u * 96u * 64u * 4u);
}

TEST_F(SynthPicture, TextureIsDeterministic) {
  write("t.json", kTexture);
  const auto texture = [&](const std::string& name, const std::string& threads) {
    succeed("t.json --texture 96x64 -o " + name + " --threads " + threads);
    return text(name);
  };
  const std::string one = texture("one.png", "1");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(one == texture("two.png", "2"));
  EXPECT_GT(texture("height.tif", "1").size(), 96u * 64u * 4u);
}

}  // namespace
}  // namespace astrolith
