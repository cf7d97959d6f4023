// synth: what it refuses, and in which words.
#include <unistd.h>

#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

using SynthRefusal = SynthTest;

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

TEST_F(SynthRefusal, OptionsThatMakeNoSense) {
  write("ball.json", ball_recipe("km", 1));
  write("t.json", kTexture);
  refuse_all("r.json ",
             {{"", "--output: is required"},
              {"-o a.ply --resolution 0", "--resolution"},
              {"-o a.ply --resolution 1000000", "--resolution"},
              {"-o a.ply --resolution 64 --triangles 1000", "excludes"},
              {"-o a.ply --triangles 1e10", "--triangles"},
              {"-o a.ply --resolution 1024 --max-memory 0.1", "needs"},
              // Formats that do not hold what is asked for.
              {"-o a.obj --points", ".ply"},
              {"-o a.obj --labels", ".ply"},
              {"-o a.stl --uv", ".glb"},
              {"-o a.obj --gravity 2000 6", "a.obj"},
              {"-o a.icq --even", "leave out --even"},
              // Gravity.
              {"-o a.ply --gravity 0 6", "--gravity: the density"},
              {"-o a.ply --gravity 2000 -1", "--gravity: the period"},
              {"-o a.ply --gravity 2000 6 --points", "--gravity: is of the whole body or a patch"},
              {"-o a.ply --gravity 2000 6 --tile 1/2", "--gravity: is of the whole"},
              // Regions.
              {"-o a.ply --tile 0/3", "tile"},
              {"-o a.ply --tile 4/3", "tile"},
              {"-o a.ply --tile 1/0", "tile"},
              {"-o a.ply --tile 1/300", "tile"},
              {"-o a.ply --tile 2", "tile"},
              {"-o a.ply --tile 1/3x", "tile"},
              {"-o a.ply --patch -1 0 0 0", "--patch: has no centre or no side"},
              {"-o a.ply --patch -1 0 0", "--patch"},
              {"-o a.ply --patch -1 0 0 0.1 --tile 1/2", "--tile"},
              {"-o a.ply --resolution 16 --patch -1.5 0 0 0.1", "there is some near -"},
              // The field is flat there.
              {"-o a.ply --resolution 16 --patch -1000 0 0 0.1", "there is some near -1."},
              {"-o a.ply --aligned", "--aligned"},
              {"-o a.ply --resolution 32 --height-map h.tif", "--height-map"},
              // Pictures and their maps.
              {"-o a.ply --sun 1 0 0", "--preview"},
              {"-o a.ply --picture-size 64x64", "--picture-size: is about a picture; add --preview FILE.png"},
              {"-o a.ply --preview-maps p.npz", "--preview-maps: is about a picture; add --preview FILE.png"},
              // Textures.
              {"--tileable -o a.png", "--tileable"},
              {"--texture 8x8 -o a.png", "r.json"},
              {"--texture 64x64 -o a.png --even", "--even"},
              // Other bodies of the kind.
              {"-o a.ply --vary 1.5", "--vary"},
              {"-o a.ply --target ball.json", "--vary"},
              {"-o a.ply --finish itokawa", "--to"},
              {"-o a.ply --finish vesta --to 1", "--finish"},
              {"-o a.ply --finish eros --from 1 --to 2", "r.json: finish: sizes go from 1 down to 2"}});
  refuse("ball.json -o q.ply --resolution 32 --aligned --patch 0 0 0 4", "faces no direction");
  refuse("t.json --texture 96x64 -o x.png --texture-of color", "t.json");
  for (const std::string size : {"96", "0x64", "96x-1", "ax64", "1000000x1000000"})
    refuse("t.json --texture " + size + " -o x.png", "texture");
  refuse_all("r.json -o x.ply --preview p.png ",
             {{"--camera \"zoom 2\"", "--camera: \"zoom\" is no word of a camera"},
              {"--sun-body 0 0 0", "--sun-body"},
              {"--phase 200 0", "--phase"},
              {"--phase 20 0 --sun 0 0 1", "give one of them"},
              {"--sun 0 0 0", "--sun"},
              {"--picture-size 0x100",
               "--picture-size: \"0x100\" is not a size; write WxH with sides of 16 to 16384"},
              {"--picture-size 100000x100", "--picture-size"},
              {"--picture-size large", "--picture-size"},
              {"--maps-size 64x64", "--maps-size: is about maps"},
              {"--preview-maps p.npz --maps-size 1x1", "--maps-size"},
              {"--preview-maps p.exr", "p.exr: is no .npz file"},
              {"--preview-maps none/p.npz", "none"}});
}

// The rules of recipes and fields are tested in their rooms: here the file and the path are named.
TEST_F(SynthRefusal, BadRecipesAreRefused) {
  for (const auto& [from, to, culprit] :
       {std::tuple{"amplitude", "amplitud", "layers[0].amplitud: unknown field"},
        {"0.75", "-0.75", "body.spheres[1].radius"},
        {"\"spheres\"", "\"iso_value\": 100, \"spheres\"", "body.iso_value"},
        {"0.05", "1e9", "layers[0].amplitude: heights of up to"},
        {"\"km\"", "\"body\"", "length_unit: is \"body\""},
        // An intersection with a joint of 100 km lowers the whole surface of a body of 2 km by 50 km.
        {R"("octaves": 4}])", R"("octaves": 4}, {"type": "simplex", "amplitude": 0.001, "frequency": 2,
           "combine": {"type": "blend", "operator": "intersection", "width": 100}}])",
         "layers[1].combine.width: nothing of the body is left"}})
    expect_recipe_refused(replaced(kTwoSpheres, from, to), culprit);
}

TEST_F(SynthRefusal, AbsurdSizesAreRefused) {
  std::string lobes = "[1, 0.1, 0.2, 1]";
  for (int bandwidth = 2; bandwidth <= 12; ++bandwidth)
    lobes += ", [" + std::to_string(bandwidth) + ", 0.1, 0.2, 1]";
  const auto with_layer = [](const std::string& layer) {
    return ball_recipe("m", 100, R"(, "layers": [)" + layer + "]");
  };
  for (
      const auto& [layer, culprit] : testing::Refusals{
          {R"({"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 900}]})",
           "craters[0].diameter: is 900"},
          {R"({"type": "boulders", "boulders": [{"direction": [0, 0, 1], "axes": [900, 800, 700]}]})",
           "boulders[0].axes: is 900"},
          {R"({"type": "craters", "population": {"density": 1e5, "least_diameter": 1, "greatest_diameter": 2}})",
           "population.density: would draw"},
          {R"({"type": "spots", "density": 1e9})", "density: must be at most"},
          {R"({"type": "spots", "amplitude": 0.5, "size": 40, "cell_size": 40, "density": 60, "layers": 12,
                "gain": 4})",
           "density: these spots"},
          {R"({"type": "gabor", "pixel_size": 0.01, "height_rms": 0.01, "impulses_per_kernel": 1024, "lobes": [)" +
               lobes + "]}",
           "impulses_per_kernel: these impulses, with those of earlier layers, take 136584"},
          {R"({"type": "lava"})", "type: must be one of"},
      })
    expect_recipe_refused(with_layer(layer), "layers[0]." + culprit);
}

TEST_F(SynthRefusal, BadFilesAreRefused) {
  std::filesystem::create_directory(folder_ / "folder.ply");
  write("x.json", "\x89PNG\r\n\x1a\n");
  for (const std::string input : {"absent.json", "x.json"}) refuse(input + " -o out.ply", input);
  for (const std::string output : {"absent/out.ply", "folder.ply", "out.xyz"}) {
    refuse("r.json -o " + output, output);
  }
  if (::geteuid() == 0) return;  // the superuser may write everywhere
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms{0555});
  refuse("r.json -o locked/out.ply", "out.ply");
}

}  // namespace
}  // namespace astrolith
