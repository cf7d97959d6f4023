// synth, run as a user runs it: pictures and textures.
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

using SynthPicture = SynthTest;

TEST_F(SynthPicture, PicturesCanBeTakenFromElsewhere) {
  const auto picture = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"--preview", (folder_ / "p.png").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    synthesise("out.ply", arguments);
    return text_of(folder_ / "p.png");
  };
  const std::string one = picture({"--view", "1", "0", "0"});
  EXPECT_FALSE(one == picture({"--view", "1", "0", "0", "--view", "0", "0", "1"}));
  EXPECT_FALSE(one == picture({"--view", "1", "0", "0", "--sun", "0", "0", "1"}));
  std::filesystem::remove(folder_ / "p.png");
  const std::string recipe = folder_.write("r.json", kTwoSpheres), out = (folder_ / "x.ply").string();
  expect_refusal(folder_, kSynth, {recipe, "-o", out, "--sun", "1", "0", "0"}, "--preview");
  expect_refusal(folder_, kSynth,
                 {recipe, "-o", out, "--preview", (folder_ / "p.png").string(), "--sun", "0", "0", "0"},
                 "--sun");
}

TEST_F(SynthPicture, MapsAreOfAPicture) {
  const std::string recipe = folder_.write("r.json", kTwoSpheres), out = (folder_ / "x.ply").string();
  const std::string picture = (folder_ / "p.png").string(), maps = (folder_ / "p.npz").string();
  expect_refusal(folder_, kSynth, {recipe, "-o", out, "--preview-maps", maps},
                 "--preview-maps: is about a picture; add --preview FILE.png");
  expect_refusal(folder_, kSynth,
                 {recipe, "-o", out, "--preview", picture, "--preview-maps", (folder_ / "p.exr").string()},
                 "p.exr: is no .npz file");
  expect_refusal(
      folder_, kSynth,
      {recipe, "-o", out, "--preview", picture, "--preview-maps", (folder_ / "none" / "p.npz").string()},
      "none");
  expect_refusal(folder_, kSynth, {recipe, "-o", out, "--preview", picture, "--preview-maps", recipe},
                 "is the input itself");
}

TEST_F(SynthPicture, ErosionLeavesMapsWithoutLayers) {
  const std::string recipe = folder_.write("e.json", R"({"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}, "erosion": {"talus_angle": 30, "density": 2000, "rotation_period": 0}})");
  const std::string maps = (folder_ / "p.npz").string();
  const testing::Outcome outcome =
      run_program(kSynth, {recipe, "-o", (folder_ / "x.ply").string(), "--resolution", "24", "--preview",
                           (folder_ / "p.png").string(), "--preview-maps", maps});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("neither layer nor instance"), std::string::npos) << outcome.errors;
  const std::string bytes = text_of(maps);
  EXPECT_NE(bytes.find("depth.npy"), std::string::npos);
  EXPECT_EQ(bytes.find("instance.npy"), std::string::npos);
}

TEST_F(SynthPicture, ColouredLayersMakeAPicture) {
  const std::string recipe = folder_.write(
      "c.json",
      replaced(kTexture, "\"lobes\"",
               R"("exemplar_rms": 0.1, "color": {"axis": [1, 0, 0], "mean": [0.5, 0.25, 1]}, "lobes")"));
  const auto texture = [&](const std::string& name, std::vector<std::string> more) {
    const std::string file = (folder_ / name).string();
    std::vector<std::string> arguments{recipe, "--texture", "96x64", "-o", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kSynth, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  };
  const auto bits_and_type = [](const std::string& png) { return png.substr(24, 2); };
  EXPECT_EQ(bits_and_type(texture("c16.png", {})), "\x10\x02");
  EXPECT_EQ(bits_and_type(texture("c8.png", {"--bits", "8", "--tileable"})), "\x08\x02");
  EXPECT_EQ(bits_and_type(texture("h.png", {"--texture-of", "height"})), std::string("\x10\x00", 2));
  EXPECT_GT(texture("c.tif", {}).size(), 3u * 96u * 64u * 4u);
  const std::string grey = folder_.write("g.json", kTexture), output = (folder_ / "x.png").string();
  expect_refusal(folder_, kSynth, {grey, "--texture", "96x64", "-o", output, "--texture-of", "color"},
                 "g.json");
  expect_refusal(folder_, kSynth, {folder_.write("r.json", kTwoSpheres), "--tileable", "-o", output},
                 "--tileable");
}

TEST_F(SynthPicture, TextureIsDeterministicAndRefusesNonsense) {
  const std::string recipe = folder_.write("t.json", kTexture);
  const auto texture = [&](const std::string& name, const std::string& threads) {
    const std::string file = (folder_ / name).string();
    const testing::Outcome outcome =
        run_program(kSynth, {recipe, "--texture", "96x64", "-o", file, "--threads", threads});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  };
  const std::string one = texture("one.png", "1");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(one == texture("two.png", "2"));
  EXPECT_GT(texture("height.tif", "1").size(), 96u * 64u * 4u);
  const std::string output = (folder_ / "x.png").string();
  for (const char* size : {"96", "0x64", "96x-1", "ax64", "1000000x1000000"}) {
    expect_refusal(folder_, kSynth, {recipe, "--texture", size, "-o", output}, "texture");
  }
  expect_refusal(folder_, kSynth, {folder_.write("r.json", kTwoSpheres), "--texture", "8x8", "-o", output},
                 "r.json");
}

}  // namespace
}  // namespace astrolith
