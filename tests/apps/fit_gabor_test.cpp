// fit_gabor, run as a user runs it.
#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "tests/apps/inputs.h"
#include "tests/apps/program_runner.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;
using testing::WorkFolder;

const std::string kFitGabor = ASTROLITH_FIT_GABOR;

class FitGabor : public ::testing::Test {
 protected:
  std::string fit(const std::string& output, std::vector<std::string> more) {
    const std::string file = (folder_ / output).string();
    std::vector<std::string> arguments{folder_.write("rock.png", testing::noise_png(64)), "-o", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kFitGabor, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  }
  void expect_image_refused(const std::string& name, const std::string& content) {
    const std::string file = folder_.write(name, content);
    expect_refusal(folder_, kFitGabor, {file, "-o", (folder_ / "out.json").string()}, name);
  }

  WorkFolder folder_;
};

TEST_F(FitGabor, WritesARecipeOfOneLayer) {
  fit("rock.json", {});
  const Recipe recipe = read_recipe(folder_ / "rock.json");
  EXPECT_FALSE(recipe.body.has_value());
  ASSERT_EQ(recipe.layers.size(), 1u);
  EXPECT_FALSE(std::get<GaborLayer>(recipe.layers[0]).lobes.empty());
  EXPECT_EQ(recipe.provenance.input_name, "rock.png");
  EXPECT_EQ(recipe.provenance.input_sha256, sha256_of_file(folder_ / "rock.png"));
}

// The exemplar's image lies beside the recipe, which names it; both have the same bytes for any threads.
TEST_F(FitGabor, WritesAnExemplarAndItsImage) {
  const std::string one = fit("rock.json", {"--model", "exemplar", "--height-rms", "0.5", "--threads", "1"});
  const std::string image = text_of(folder_ / "rock_exemplar.png");
  const Recipe recipe = read_recipe(folder_ / "rock.json");
  ASSERT_EQ(recipe.layers.size(), 1u);
  const ExemplarLayer& layer = std::get<ExemplarLayer>(recipe.layers[0]);
  EXPECT_EQ(layer.image, "rock_exemplar.png");
  EXPECT_EQ(layer.image_sha256, sha256_of_file(folder_ / "rock_exemplar.png"));
  EXPECT_EQ(layer.height_rms, 0.5);
  EXPECT_EQ(recipe.provenance.input_name, "rock.png");
  EXPECT_EQ(fit("rock.json", {"--model", "exemplar", "--height-rms", "0.5", "--threads", "2"}).size(),
            one.size());
  EXPECT_EQ(text_of(folder_ / "rock_exemplar.png"), image);
}

TEST_F(FitGabor, AnExemplarKeepsColours) {
  fit("rock.json", {"--model", "exemplar", "--channels", "pca", "--height-rms", "0.5"});
  const auto layer = std::get<ExemplarLayer>(read_recipe(folder_ / "rock.json").layers[0]);
  EXPECT_TRUE(layer.color);
  EXPECT_EQ(layer.height_rms, 0.5);
  EXPECT_EQ(text_of(folder_ / "rock_exemplar.png")[25], '\2') << "colour type RGB";
}

TEST_F(FitGabor, AutoTakesTheNearerModelByItsScores) {
  fit("rock.json", {"--model", "auto", "--summary", (folder_ / "s.json").string()});
  const auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  const auto sum = [](const nlohmann::json& score) {
    return score["values"].get<double>() + score["filters"].get<double>();
  };
  const bool exemplar =
      sum(summary["variants"][summary["variant"].get<std::string>()]) < sum(summary["gabor"]);
  EXPECT_EQ(summary["model"], exemplar ? "exemplar" : "gabor");
  const Recipe recipe = read_recipe(folder_ / "rock.json");
  EXPECT_EQ(std::holds_alternative<ExemplarLayer>(recipe.layers[0]), exemplar);
}

TEST_F(FitGabor, RefusesPhotosThatMakeNoExemplar) {
  const std::string out = (folder_ / "out.json").string();
  const std::string flat =
      folder_.write("flat.png", testing::png(64, 64, std::vector<std::uint8_t>(4096, 9)));
  const std::string small = folder_.write("small.png", testing::noise_png(16));
  expect_refusal(folder_, kFitGabor, {flat, "--model", "exemplar", "-o", out}, "one grey value");
  expect_refusal(folder_, kFitGabor, {small, "--model", "exemplar", "-o", out}, "16 x 16 pixels");
  expect_refusal(folder_, kFitGabor, {small, "--model", "exemplar", "--channels", "pca", "-o", out},
                 "16 x 16 pixels");
  expect_refusal(folder_, kFitGabor,
                 {small, "--model", "exemplar", "--report", (folder_ / "report").string(), "-o", out},
                 "--report");
  const std::string own = folder_.write("out_exemplar.png", testing::noise_png(64));
  expect_refusal(folder_, kFitGabor, {own, "--model", "exemplar", "-o", out}, "out_exemplar.png");
}

TEST_F(FitGabor, SameBytesForAnyThreadCount) {
  EXPECT_EQ(fit("one.json", {"--threads", "1"}), fit("two.json", {"--threads", "2"}));
}

TEST_F(FitGabor, SummaryHoldsTheFigures) {
  fit("rock.json", {"--summary", (folder_ / "s.json").string()});
  const auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  for (const char* field :
       {"lobes", "pursuit_gap", "pursuit_reached", "refinement_reached", "spectrum_distance",
        "spectrum_residual", "weak_above", "weak", "band_overlap", "variance_in_spectrum",
        "variance_ratio_synthesized", "gaussianity", "iterations", "seconds"}) {
    ASSERT_TRUE(summary.contains(field)) << field;
    EXPECT_FALSE(summary[field].is_null()) << field;  // NaN would become null
  }
  EXPECT_GE(summary["pursuit_gap"].get<double>(), 0.0);
  EXPECT_FALSE(summary.contains("variance_ratio"));  // 1 by construction
  EXPECT_FALSE(summary["weak"].get<bool>());
  double photo = 0.0;
  for (const auto& band : summary["channels"][0]["bands"]) photo += band["photo"].get<double>();
  EXPECT_NEAR(photo, 1.0, 1e-6);
  EXPECT_NEAR(summary["variance_ratio_before_scaling"].get<double>(), 1.0, 0.1);
}

TEST_F(FitGabor, APhotoOfGravelKeepsItsVariance) {
  const auto photo = testing::package_file("gravel.png");
  ASTROLITH_SKIP_WITHOUT(photo);
  const std::string summary_file = (folder_ / "s.json").string();
  const testing::Outcome outcome =
      run_program(kFitGabor, {photo.string(), "-o", (folder_ / "gravel.json").string(), "--summary",
                              summary_file, "--report", (folder_ / "report").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto summary = nlohmann::json::parse(text_of(summary_file));
  EXPECT_GE(summary["pursuit_gap"].get<double>(), 0.0);
  EXPECT_LE(summary["pursuit_gap"].get<double>(), 1e-2);
  EXPECT_FALSE(summary["weak"].get<bool>());
  EXPECT_NEAR(summary["variance_ratio_synthesized"].get<double>(), 1.0, 0.02);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / "report.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / "index.html"));
}

// Two lobes are too few for the noise of the photo, and the program says what to do.
TEST_F(FitGabor, AWeakFitIsCalledWeak) {
  const auto photo = testing::package_file("gravel.png");
  ASTROLITH_SKIP_WITHOUT(photo);
  const testing::Outcome outcome =
      run_program(kFitGabor, {photo.string(), "-o", (folder_ / "gravel.json").string(), "--lobes", "1"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("note: weak fit"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("--lobes"), std::string::npos) << outcome.errors;
}

TEST_F(FitGabor, NumbersMustBeFinite) {
  const std::string image = folder_.write("rock.png", testing::noise_png(64));
  for (const char* option : {"--penalty", "--gap", "--height-rms", "--mm-per-px"}) {
    expect_refusal(folder_, kFitGabor, {image, "-o", (folder_ / "out.json").string(), option, "nan"}, option);
  }
}

TEST_F(FitGabor, APipeIsRefusedAtOnce) {
  const std::string pipe = (folder_ / "pipe.png").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_refusal(folder_, kFitGabor, {pipe, "-o", (folder_ / "out.json").string()}, "pipe.png");
}

TEST_F(FitGabor, TheInputIsNeverOverwritten) {
  const std::string image = folder_.write("rock.png", testing::noise_png(64));
  expect_refusal(folder_, kFitGabor, {image, "-o", image}, "rock.png");
}

TEST_F(FitGabor, BadImagesAreRefused) {
  expect_image_refused("text.png", "this is not an image\n");
  expect_image_refused("empty.png", "");
  expect_image_refused("one.png", testing::png(1, 1, {128}));
  expect_image_refused("row.png", testing::png(64, 1, std::vector<std::uint8_t>(64, 3)));
  expect_image_refused("constant.png", testing::png(64, 64, std::vector<std::uint8_t>(64 * 64, 77)));
  const std::string whole = testing::noise_png(64);
  expect_image_refused("cut.png", whole.substr(0, whole.size() / 2));
}

// The size in the header decides, whatever the options are. The message states the memory that the fit would
// take.
TEST_F(FitGabor, SizesThatMakeNoSenseAreRefused) {
  expect_image_refused("huge.png", testing::png_header(20000, 20000));
  expect_image_refused("negative.png", testing::png_header(0x80000000u, 4));
  expect_image_refused("none.png", testing::png_header(0, 0));
  expect_image_refused("below.png", testing::noise_png(31));
  const std::string huge = folder_.write("huge.png", testing::png_header(20000, 20000));
  const testing::Outcome outcome = run_program(kFitGabor, {huge, "-o", (folder_ / "out.json").string()});
  EXPECT_NE(outcome.errors.find("20000 x 20000 pixels would take 7 GB"), std::string::npos) << outcome.errors;
}

TEST_F(FitGabor, OneValueThatIsNotFiniteIsRefused) {
  std::vector<float> values(64 * 64);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 7919 % 1009);
  folder_.write("good.tif", testing::float_tiff(64, 64, values));
  EXPECT_EQ(
      run_program(kFitGabor, {(folder_ / "good.tif").string(), "-o", (folder_ / "g.json").string()}).status,
      0);
  values[5 * 64 + 9] = std::numeric_limits<float>::quiet_NaN();
  expect_image_refused("nan.tif", testing::float_tiff(64, 64, values));
  values[5 * 64 + 9] = std::numeric_limits<float>::infinity();
  expect_image_refused("infinite.tif", testing::float_tiff(64, 64, values));
}

TEST_F(FitGabor, OtherPicturesAndOddOptionsAreRefused) {
  expect_image_refused("moving.gif", std::string("GIF89a\x40\0\x40\0", 10) + std::string(100, '\0'));
  expect_image_refused("photo.webp", std::string("RIFF\x24\0\0\0WEBPVP8 ", 16) + std::string(100, '\0'));
  const std::string image = folder_.write("rock.png", testing::noise_png(64)),
                    out = (folder_ / "o.json").string();
  for (const std::vector<std::string>& odd : {std::vector<std::string>{"--channels", "rgb"},
                                              {"--detrend", "7"},
                                              {"--detrend-by", "hope"},
                                              {"--lobes", "0"},
                                              {"--max-memory", "0.001"}}) {
    std::vector<std::string> arguments{image, "-o", out};
    arguments.insert(arguments.end(), odd.begin(), odd.end());
    expect_refusal(folder_, kFitGabor, arguments, odd[0] == "--max-memory" ? "rock.png" : odd[0]);
  }
}

// A grey picture through every way in: colours of one axis, a trend taken out, all outputs.
TEST_F(FitGabor, EveryOutputIsWritten) {
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  fit("rock.json", {"--channels", "pca", "--detrend", "2", "--detrend-by", "division", "--spectrum",
                    path("s.npy"), "--report", path("report"), "--summary", path("s.json")});
  const Recipe recipe = read_recipe(folder_ / "rock.json");
  ASSERT_EQ(recipe.layers.size(), 1u);
  const auto& layer = std::get<GaborLayer>(recipe.layers[0]);
  ASSERT_TRUE(layer.color.has_value());
  EXPECT_NEAR(layer.color->axis.x, std::sqrt(1.0 / 3.0), 1e-6);
  EXPECT_EQ(text_of(folder_ / "s.npy").substr(1, 5), "NUMPY");
  EXPECT_EQ(text_of(folder_ / "s.npy").size() % (64 * 64 * 8), 128u % (64 * 64 * 8));
  for (const char* name : {"report.png", "report.svg", "exemplar.png", "synthesis.png",
                           "spectrum_exemplar.png", "spectrum_fitted.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / name)) << name;
  }
  EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "s.json"))["channels"].size(), 1u);
}

TEST_F(FitGabor, BadFilesAreRefused) {
  const std::string image = folder_.write("rock.png", testing::noise_png(64));
  std::filesystem::create_directory(folder_ / "folder");
  const auto refuse = [&](const std::string& input, const std::filesystem::path& output,
                          const std::string& culprit) {
    expect_refusal(folder_, kFitGabor, {input, "-o", output.string()}, culprit);
  };
  refuse((folder_ / "absent.png").string(), folder_ / "out.json", "absent.png");
  refuse((folder_ / "folder").string(), folder_ / "out.json", "folder");
  refuse(image, folder_ / "absent" / "out.json", "out.json");
  refuse(image, folder_ / "folder", "folder");
}

}  // namespace
}  // namespace astrolith
