// synth with exemplar layers, whose images lie beside the recipe, run as a user runs it.
#include <png.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "tests/apps/program_runner.h"
#include "tests/apps/synth_runner.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;

class SynthExemplar : public ::testing::Test {
 protected:
  // Writes a PNG of `channels` channels in one of libpng's formats: values from a hash of their place.
  void write_image(const std::string& name, int side, std::uint32_t format, int channels, bool flat = false) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<std::uint32_t>(side);
    image.height = static_cast<std::uint32_t>(side);
    image.format = format;
    const bool wide = (format & PNG_FORMAT_FLAG_LINEAR) != 0;
    std::vector<std::uint16_t> values(static_cast<std::size_t>(side * side * channels), 20000);
    std::uint32_t state = 1;
    for (std::uint16_t& value : values) {
      state = state * 1664525u + 1013904223u;
      if (!flat) value = static_cast<std::uint16_t>(state >> 16);
    }
    const std::vector<std::uint8_t> bytes(values.begin(), values.end());
    ASSERT_NE(
        png_image_write_to_file(&image, (folder_ / name).c_str(), 0,
                                wide ? static_cast<const void*>(values.data()) : bytes.data(), 0, nullptr),
        0);
  }
  std::string recipe_of(const std::string& image, const std::string& hash, bool with_body = true) const {
    const std::string body = R"("body": {"type": "metaballs", "spheres": [[0, 0, 0, 10]]},)";
    return folder_.write("r.json", R"({"format_version": 1, "length_unit": "m", )" + (with_body ? body : "") +
                                       R"("layers": [{"type": "exemplar", "image": ")" + image +
                                       R"(", "image_sha256": ")" + hash + R"(", "pixel_size": 0.05, )" +
                                       fields_ + R"(}]})");
  }
  std::string recipe_of(const std::string& image) const {
    return recipe_of(image, sha256_of_file(folder_ / image));
  }
  void make_mesh(const std::string& recipe, const std::string& mesh, const std::string& threads = "2") {
    const testing::Outcome outcome =
        run_program(kSynth, {recipe, "--resolution", "64", "--threads", threads, "-o", name(mesh)});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_NE(outcome.errors.find("closed, manifold"), std::string::npos) << outcome.errors;
  }
  std::string name(const std::string& file) const { return (folder_ / file).string(); }
  void refuse(const std::string& recipe, const std::string& culprit) {
    expect_refusal(folder_, kSynth, {recipe, "--resolution", "64", "-o", name("x.ply")}, culprit);
  }

  std::string fields_ = R"("height_rms": 0.05)";  // of the layer
  testing::WorkFolder folder_;
};

TEST_F(SynthExemplar, TakesGreyColourAlphaAndSixteenBits) {
  struct Kind {
    std::uint32_t format;
    int channels;
  };
  for (const Kind kind : {Kind{PNG_FORMAT_GRAY, 1}, Kind{PNG_FORMAT_RGB, 3}, Kind{PNG_FORMAT_RGBA, 4},
                          Kind{PNG_FORMAT_LINEAR_Y, 1}, Kind{PNG_FORMAT_GA, 2}}) {
    write_image("i.png", 64, kind.format, kind.channels);
    make_mesh(recipe_of("i.png"), "m.ply");
  }
}

TEST_F(SynthExemplar, HasTheSameBytesForOneThreadAndForTwo) {
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  const std::string recipe = recipe_of("i.png");
  make_mesh(recipe, "one.ply", "1");
  make_mesh(recipe, "two.ply", "2");
  EXPECT_EQ(text_of(name("one.ply")), text_of(name("two.ply")));
}

TEST_F(SynthExemplar, RefusesImagesThatAreNotWhatTheRecipeSays) {
  const std::string zeros(64, '0');
  refuse(recipe_of("absent.png", zeros), "layers[0].image: " + name("absent.png"));
  std::filesystem::create_directory(folder_ / "folder");
  refuse(recipe_of("folder", zeros), "is a folder");
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  refuse(recipe_of("i.png", zeros), "has changed since the recipe was written");
  folder_.write("text.png", "no image");
  refuse(recipe_of("text.png"), "is no PNG");
  folder_.write("half.png", text_of(name("i.png")).substr(0, 900));
  refuse(recipe_of("half.png"), "is damaged");
  write_image("small.png", 8, PNG_FORMAT_GRAY, 1);
  refuse(recipe_of("small.png"), "is 8 x 8 pixels");
  write_image("large.png", 8193, PNG_FORMAT_GRAY, 1, true);
  refuse(recipe_of("large.png"), "is 8193 x 8193 pixels");
  write_image("flat.png", 64, PNG_FORMAT_GRAY, 1, true);
  refuse(recipe_of("flat.png"), "has one grey value only");
}

TEST_F(SynthExemplar, DrawsATexture) {
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  const std::string hash = sha256_of_file(folder_ / "i.png");
  const testing::Outcome outcome = run_program(
      kSynth, {recipe_of("i.png", hash, false), "--texture", "200x100", "--tileable", "-o", name("t.png")});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
}

// The written recipe names the image from its own folder.
TEST_F(SynthExemplar, WrittenRecipesFindTheirImages) {
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  const std::string recipe = recipe_of("i.png");
  std::filesystem::create_directory(folder_ / "deep");
  const std::string written = name("deep/w.json");
  ASSERT_EQ(run_program(kSynth, {recipe, "--write-recipe", written}).status, 0);
  EXPECT_EQ(std::get<ExemplarLayer>(read_recipe(written).layers[0]).image, "../i.png");
  make_mesh(recipe, "a.ply");
  make_mesh(written, "b.ply");
  EXPECT_EQ(text_of(name("a.ply")), text_of(name("b.ply")));
}

// Vertices have colours in .ply and .glb, and other formats say that they have none.
TEST_F(SynthExemplar, PaintsVertices) {
  write_image("i.png", 64, PNG_FORMAT_RGB, 3);
  const std::string plain = recipe_of("i.png");
  make_mesh(plain, "plain.ply");
  fields_ = R"("height_rms": 0.05, "color": true)";
  const std::string recipe = recipe_of("i.png");
  make_mesh(recipe, "one.ply", "1");
  make_mesh(recipe, "two.ply", "2");
  const std::string bytes = text_of(name("one.ply"));
  EXPECT_EQ(bytes, text_of(name("two.ply")));
  EXPECT_NE(bytes.find("property uchar red"), std::string::npos);
  EXPECT_EQ(text_of(name("plain.ply")).find("property uchar red"), std::string::npos);
  make_mesh(recipe, "m.glb");
  EXPECT_NE(text_of(name("m.glb")).find("COLOR_0"), std::string::npos);
  const testing::Outcome stl =
      run_program(kSynth, {recipe, "--resolution", "64", "-o", name("m.stl"), "--summary", name("s.json")});
  EXPECT_EQ(stl.status, 0) << stl.errors;
  EXPECT_NE(stl.errors.find(".stl holds no colours"), std::string::npos) << stl.errors;
  EXPECT_NE(text_of(name("s.json")).find("\"vertex_colors\": false"), std::string::npos);
}

TEST_F(SynthExemplar, WritesMaterials) {
  write_image("i.png", 64, PNG_FORMAT_RGB, 3);
  const std::string hash = sha256_of_file(folder_ / "i.png");
  const auto draw = [&](const std::string& output) {
    return run_program(kSynth, {recipe_of("i.png", hash, false), "--texture", "100x80", "--texture-of",
                                "material", "--tileable", "-o", name(output), "--summary", name("s.json")});
  };
  EXPECT_EQ(draw("grey.png").status, 0);
  EXPECT_FALSE(std::filesystem::exists(name("grey_color.png")));
  fields_ = R"("height_range": 0.1, "color": true)";
  const testing::Outcome outcome = draw("rock.png");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  for (const char* file : {"rock_height.tif", "rock_color.png", "rock_normal.png", "rock_occlusion.png"}) {
    EXPECT_TRUE(std::filesystem::exists(name(file))) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(name("rock.png")));
  const auto summary = nlohmann::json::parse(text_of(name("s.json")));
  EXPECT_EQ(summary["content"], "material");
  EXPECT_EQ(summary["normal_convention"], "OpenGL");
  EXPECT_EQ(summary["pixel_size"], 0.05);
  EXPECT_EQ(summary["files"]["color"], name("rock_color.png"));
  fields_ = R"("color": true)";
  const testing::Outcome flat = draw("flat.png");
  EXPECT_EQ(flat.status, 2);
  EXPECT_NE(flat.errors.find("layers[0].height_rms: is 0"), std::string::npos) << flat.errors;
  EXPECT_FALSE(std::filesystem::exists(name("flat_normal.png")));
}

// A map of a material must not destroy the image that it is made from.
TEST_F(SynthExemplar, RefusesMaterialsOverTheirImage) {
  write_image("rock_color.png", 64, PNG_FORMAT_RGB, 3);
  const std::string before = text_of(name("rock_color.png"));
  const testing::Outcome outcome =
      run_program(kSynth, {recipe_of("rock_color.png", sha256_of_file(folder_ / "rock_color.png"), false),
                           "--texture", "100x80", "--texture-of", "material", "-o", name("rock.png")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(text_of(name("rock_color.png")), before);
}

}  // namespace
}  // namespace astrolith
