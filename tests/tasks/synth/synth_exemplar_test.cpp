// synth with exemplar layers, whose images lie beside the recipe.
#include <png.h>

#include <cstdint>

#include "numerics/files/sha256.h"
#include "recipe/recipe_json.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

using testing::has;

class SynthExemplar : public SynthTest {
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
  // Writes r.json, a ball (or nothing) under the image.
  std::string recipe_with_hash(const std::string& image, const std::string& hash, bool with_body = true) {
    const std::string layers = R"("layers": [{"type": "exemplar", "image": ")" + image +
                               R"(", "image_sha256": ")" + hash + R"(", "pixel_size": 0.05, )" + fields_ +
                               "}]";
    return write("r.json", with_body ? ball_recipe("m", 10, ", " + layers)
                                     : R"({"format_version": 1, "length_unit": "m", )" + layers + "}");
  }
  std::string make_recipe(const std::string& image, bool with_body = true) {
    return recipe_with_hash(image, file_sha256(folder_ / image), with_body);
  }
  std::string make_mesh(const std::string& recipe, const std::string& mesh,
                        const std::string& threads = "2") {
    EXPECT_TRUE(
        has(succeed(recipe + " --resolution 64 --threads " + threads + " -o " + mesh), "closed, manifold"));
    return text(mesh);
  }
  void refuse_recipe(const std::string& recipe, const std::string& culprit) {
    refuse(recipe + " --resolution 64 -o x.ply", culprit);
  }

  std::string fields_ = R"("height_rms": 0.05)";  // of the layer
};

TEST_F(SynthExemplar, TakesGreyColourAlphaAndSixteenBits) {
  for (const auto& [format, channels] : {std::pair{PNG_FORMAT_GRAY, 1},
                                         {PNG_FORMAT_RGB, 3},
                                         {PNG_FORMAT_RGBA, 4},
                                         {PNG_FORMAT_LINEAR_Y, 1},
                                         {PNG_FORMAT_GA, 2}}) {
    write_image("i.png", 64, static_cast<std::uint32_t>(format), channels);
    make_mesh(make_recipe("i.png"), "m.ply");
  }
}

TEST_F(SynthExemplar, RefusesImagesThatAreNotWhatTheRecipeSays) {
  const std::string zeros(64, '0');
  refuse_recipe(recipe_with_hash("absent.png", zeros), "layers[0].image: ");
  std::filesystem::create_directory(folder_ / "folder");
  refuse_recipe(recipe_with_hash("folder", zeros), "is a folder");
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  refuse_recipe(recipe_with_hash("i.png", zeros), "has changed since the recipe was written");
  write("text.png", "no image");
  refuse_recipe(make_recipe("text.png"), "is no PNG");
  write("half.png", text("i.png").substr(0, 900));
  refuse_recipe(make_recipe("half.png"), "is damaged");
  write_image("small.png", 8, PNG_FORMAT_GRAY, 1);
  refuse_recipe(make_recipe("small.png"), "is 8 x 8 pixels");
  write_image("large.png", 8193, PNG_FORMAT_GRAY, 1, true);
  refuse_recipe(make_recipe("large.png"), "is 8193 x 8193 pixels");
  write_image("flat.png", 64, PNG_FORMAT_GRAY, 1, true);
  refuse_recipe(make_recipe("flat.png"), "has one grey value only");
}

TEST_F(SynthExemplar, DrawsATexture) {
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  const std::string line = make_recipe("i.png", false) + " --texture 200x100 --tileable --threads ";
  succeed(line + "1 -o one.png");
  succeed(line + "2 -o two.png");
  EXPECT_EQ(text("one.png").substr(16, 8), std::string("\0\0\0\xC8\0\0\0\x64", 8));  // width and height
  EXPECT_TRUE(text("one.png") == text("two.png"));
  succeed(line + "2 --seed 9 -o other.png");
  EXPECT_FALSE(text("one.png") == text("other.png"));
}

// The written recipe names the image from its own folder.
TEST_F(SynthExemplar, WrittenRecipesFindTheirImages) {
  write_image("i.png", 64, PNG_FORMAT_GRAY, 1);
  const std::string recipe = make_recipe("i.png");
  std::filesystem::create_directory(folder_ / "deep");
  succeed(recipe + " --write-recipe deep/w.json");
  EXPECT_EQ(std::get<ExemplarLayer>(read_recipe(folder_ / "deep/w.json").layers[0]).image, "../i.png");
  EXPECT_EQ(make_mesh(recipe, "a.ply"), make_mesh("deep/w.json", "b.ply"));
  // Through a link the system leads .. to the folder around the linked one.
  std::filesystem::create_directory(folder_ / "deep/deeper");
  std::filesystem::create_directory_symlink("deep/deeper", folder_ / "link");
  succeed(recipe + " --write-recipe link/w.json");
  EXPECT_EQ(std::get<ExemplarLayer>(read_recipe(folder_ / "link/w.json").layers[0]).image, "../../i.png");
  EXPECT_EQ(make_mesh(recipe, "a.ply"), make_mesh("link/w.json", "b.ply"));
}

// Vertices have colours in .ply and .glb, and other formats say that they have none.
TEST_F(SynthExemplar, PaintsVerticesWithTheSameBytesForAnyThreads) {
  write_image("i.png", 64, PNG_FORMAT_RGB, 3);
  EXPECT_FALSE(has(make_mesh(make_recipe("i.png"), "plain.ply"), "property uchar red"));
  fields_ = R"("height_rms": 0.05, "color": true)";
  const std::string recipe = make_recipe("i.png"), bytes = make_mesh(recipe, "one.ply", "1");
  EXPECT_EQ(make_mesh(recipe, "two.ply", "2"), bytes);
  EXPECT_NE(bytes.find("property uchar red"), std::string::npos);
  EXPECT_NE(make_mesh(recipe, "m.glb").find("COLOR_0"), std::string::npos);
  EXPECT_TRUE(has(succeed(recipe + " --resolution 64 -o m.stl --summary s.json"), ".stl holds no colours"));
  EXPECT_TRUE(has(text("s.json"), "\"vertex_colors\": false"));
}

TEST_F(SynthExemplar, WritesMaterials) {
  write_image("i.png", 64, PNG_FORMAT_RGB, 3);
  const auto draw = [&](const std::string& output) {
    return run(make_recipe("i.png", false) + " --texture 100x80 --texture-of material --tileable -o " +
               output + " --summary s.json");
  };
  EXPECT_EQ(draw("grey.png").status, 0);
  EXPECT_FALSE(exists("grey_color.png"));
  fields_ = R"("height_range": 0.1, "color": true)";
  EXPECT_EQ(draw("rock.png").status, 0);
  for (const char* file : {"rock_height.tif", "rock_color.png", "rock_normal.png", "rock_occlusion.png"}) {
    EXPECT_TRUE(exists(file)) << file;
  }
  EXPECT_FALSE(exists("rock.png"));
  const auto summary = json("s.json");
  EXPECT_EQ(summary["content"], "material");
  EXPECT_EQ(summary["normal_convention"], "OpenGL");
  EXPECT_EQ(summary["pixel_size"], 0.05);
  EXPECT_EQ(summary["files"]["color"], "rock_color.png");
  fields_ = R"("color": true)";
  const testing::Outcome flat = draw("flat.png");
  EXPECT_EQ(flat.status, 2);
  EXPECT_TRUE(has(flat.errors, "layers[0].height_rms: is 0"));
  EXPECT_FALSE(exists("flat_normal.png"));
}

// A map of a material must not destroy the image that it is made from.
TEST_F(SynthExemplar, RefusesMaterialsOverTheirImage) {
  write_image("rock_color.png", 64, PNG_FORMAT_RGB, 3);
  const std::string before = text("rock_color.png");
  refuse(make_recipe("rock_color.png", false) + " --texture 100x80 --texture-of material -o rock.png",
         "rock_color.png");
  EXPECT_EQ(text("rock_color.png"), before);
}

}  // namespace
}  // namespace astrolith
