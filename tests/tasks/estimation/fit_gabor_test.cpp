// fit_gabor: a photo becomes a layer of a recipe.
#include "tasks/estimation/fit_gabor.h"

#include <sys/stat.h>

#include <cmath>

#include "numerics/files/sha256.h"
#include "recipe/recipe_json.h"
#include "synthesis/picture/image_file.h"
#include "tests/support/data.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::has;

// rock.png is smooth noise.
class FitGabor : public testing::JobTest {
 protected:
  FitGabor() : JobTest("fit_gabor", testing::make_job(declare_photo_fit, fit_gabor)) {
    write("rock.png", testing::noise_png(64));
  }

  std::string fit(const std::string& output, const std::string& more = "") {
    succeed("rock.png -o " + output + " " + more);
    return text(output);
  }
  Recipe recipe() const { return read_recipe(folder_ / "rock.json"); }
  void expect_image_refused(const std::string& name, const std::string& content) {
    refuse(write(name, content) + " -o out.json", name);
  }
};

TEST_F(FitGabor, WritesARecipeOfOneLayer) {
  fit("rock.json");
  EXPECT_FALSE(recipe().body.has_value());
  ASSERT_EQ(recipe().layers.size(), 1u);
  EXPECT_FALSE(std::get<GaborLayer>(recipe().layers[0]).lobes.empty());
  EXPECT_EQ(recipe().provenance.input_name, "rock.png");
  EXPECT_EQ(recipe().provenance.input_sha256, file_sha256(folder_ / "rock.png"));
}

// Sixteen tiles are fitted as one, and so is a strip of them.
TEST_F(FitGabor, FitsOnePeriodOfAPhotoThatRepeatsItself) {
  const auto tiles = [](int across, int down) {
    constexpr int kSide = 48;
    std::vector<std::uint8_t> grey;
    for (int y = 0; y < down * kSide; ++y) {
      for (int x = 0; x < across * kSide; ++x) {
        float sum = 0;
        for (int k = 0; k < 16; ++k)
          sum += unit_float(hash_cell(5u, (x + k % 4) % kSide, (y + k / 4) % kSide, 0));
        grey.push_back(static_cast<std::uint8_t>(sum * 255 / 16));
      }
    }
    return testing::png(across * kSide, down * kSide, grey);
  };
  write("tiles.png", tiles(4, 4));
  write("strip.png", tiles(20, 1));
  const std::string said = succeed("tiles.png -o rock.json --summary s.json");
  EXPECT_TRUE(
      has(said, "tiles.png: repeats itself every 48 pixels along x and y; 48 x 48 pixels of it are fitted"));
  EXPECT_EQ(json("s.json")["period"]["x_px"], 48);
  EXPECT_TRUE(has(succeed("strip.png -o strip.json"),
                  "strip.png: repeats itself every 48 pixels along x; 48 x 48 pixels of it are fitted"));
  const auto fit_lobes = [&](const std::string& name) {
    return std::get<GaborLayer>(read_recipe(folder_ / name).layers[0]).lobes;
  };
  EXPECT_FALSE(fit_lobes("rock.json").empty());
  EXPECT_EQ(fit_lobes("rock.json").size(), fit_lobes("strip.json").size());
  EXPECT_FALSE(has(succeed("rock.png -o rock.json"), "repeats itself"));
}

// The exemplar's image lies beside the recipe, which names it; both have the same bytes for any threads.
TEST_F(FitGabor, WritesAnExemplarAndItsImage) {
  const std::string line = "--model exemplar --height-rms 0.5 --threads ";
  const std::string one = fit("rock.json", line + "1"), image = text("rock_exemplar.png");
  ASSERT_EQ(recipe().layers.size(), 1u);
  const ExemplarLayer layer = std::get<ExemplarLayer>(recipe().layers[0]);
  EXPECT_EQ(layer.image, "rock_exemplar.png");
  EXPECT_EQ(layer.image_sha256, file_sha256(folder_ / "rock_exemplar.png"));
  EXPECT_EQ(layer.height_rms, 0.5);
  EXPECT_EQ(recipe().provenance.input_name, "rock.png");
  EXPECT_EQ(fit("rock.json", line + "2").size(), one.size());
  EXPECT_EQ(text("rock_exemplar.png"), image);
}

TEST_F(FitGabor, WritesRandomPhasesAsAnExemplar) {
  fit("rock.json", "--model phase --channels pca --report report --summary s.json");
  const auto layer = std::get<ExemplarLayer>(recipe().layers[0]);
  EXPECT_TRUE(layer.color);
  EXPECT_EQ(layer.image_sha256, file_sha256(folder_ / "rock_exemplar.png"));
  const auto summary = json("s.json");
  EXPECT_EQ(summary["model"], "phase");
  EXPECT_NEAR(summary["variance_ratio_synthesized"], 1.0, 0.3);
  EXPECT_TRUE(summary.contains("gaussianity"));
  EXPECT_TRUE(exists("report/report.png"));
}

// The layer, the report and the figures are those of the model that was taken.
TEST_F(FitGabor, AutoComparesAllModelsOnUnseenSquares) {
  const std::string said =
      succeed("rock.png -o rock.json --model auto --summary s.json --report report --spectrum s.npy");
  const auto summary = json("s.json");
  const std::string taken = summary["model"];
  EXPECT_TRUE(has(said, taken + " is taken"));
  for (const char* model : {"gabor", "phase", "exemplar"}) {
    EXPECT_TRUE(has(said, std::string(model) + " 0.")) << said;
    EXPECT_GT(summary["choice"]["models"][model]["values"].get<double>(), 0.0);
    EXPECT_GT(summary["choice"]["models"][model]["scatter"].get<double>(), 0.0);
    EXPECT_TRUE(has(text("report/index.html"), model));
  }
  EXPECT_EQ(summary["choice"]["side"], 32);
  EXPECT_EQ(std::holds_alternative<GaborLayer>(recipe().layers[0]), taken == "gabor");
  EXPECT_EQ(text("s.npy").size() % (64 * 64 * 8), 128u % (64 * 64 * 8));
}

TEST_F(FitGabor, AutoSaysThatAPhotoChangesFromPlaceToPlace) {
  constexpr int kSide = 96;
  std::vector<std::uint8_t> grey;
  for (int i = 0; i < kSide * kSide; ++i)
    grey.push_back(static_cast<std::uint8_t>((i % kSide < kSide / 2 ? 40 : 160) + 7919 * i % 61));
  write("halves.png", testing::png(kSide, kSide, grey));
  const std::string crop = "crop it to a part that looks alike";
  EXPECT_TRUE(has(succeed("halves.png -o halves.json --model auto"), crop));
  EXPECT_FALSE(has(succeed("rock.png -o rock.json --model auto"), crop));
}

TEST_F(FitGabor, AnExemplarKeepsColoursAndHasItsReport) {
  fit("rock.json", "--model exemplar --channels pca --height-rms 0.5 --report report --spectrum s.npy");
  const auto layer = std::get<ExemplarLayer>(recipe().layers[0]);
  EXPECT_TRUE(layer.color);
  EXPECT_EQ(layer.height_rms, 0.5);
  EXPECT_EQ(text("rock_exemplar.png")[25], '\2') << "colour type RGB";
  EXPECT_TRUE(exists("report/report.svg"));
  EXPECT_TRUE(has(text("report/index.html"), "The layer is the photo itself"));
  EXPECT_EQ(text("s.npy").size() % (64 * 64 * 8), 128u % (64 * 64 * 8));
}

TEST_F(FitGabor, RefusesPhotosThatMakeNoExemplar) {
  write("flat.png", testing::png(64, 64, std::vector<std::uint8_t>(4096, 9)));
  write("small.png", testing::noise_png(16));
  write("out_exemplar.png", testing::noise_png(64));
  for (const std::string model : {"exemplar", "phase"})
    refuse_all("-o out.json --model " + model + " ", {{"flat.png", "one grey value"},
                                                      {"small.png", "small.png"},
                                                      {"small.png --channels pca", "small.png"},
                                                      {"out_exemplar.png", "out_exemplar.png"}});
}

TEST_F(FitGabor, SameBytesForAnyThreadCount) {
  EXPECT_EQ(fit("one.json", "--threads 1"), fit("two.json", "--threads 2"));
}

TEST_F(FitGabor, SummaryHoldsTheFigures) {
  const auto summary = figures("rock.png -o rock.json");
  for (const char* field :
       {"lobes", "pursuit_gap", "pursuit_reached", "refinement_reached", "spectrum_distance",
        "spectrum_residual", "weak_above", "weak", "band_overlap", "variance_in_spectrum",
        "variance_ratio_synthesized", "gaussianity", "iterations", "seconds"}) {
    ASSERT_TRUE(summary.contains(field)) << field;
    EXPECT_FALSE(summary[field].is_null()) << field;  // NaN would become null
  }
  EXPECT_GE(summary["pursuit_gap"], 0.0);
  EXPECT_FALSE(summary.contains("variance_ratio"));  // 1 by construction
  EXPECT_FALSE(summary["weak"]);
  double photo = 0.0;
  for (const auto& band : summary["channels"][0]["bands"]) photo += band["photo"].get<double>();
  EXPECT_NEAR(photo, 1.0, 1e-6);
  EXPECT_NEAR(summary["variance_ratio_before_scaling"], 1.0, 0.1);
}

// One lobe is too few for the noise of the photo, and the program says what to do.
TEST_F(FitGabor, AWeakFitIsCalledWeak) {
  const auto photo = testing::package_file("gravel.png");
  ASTROLITH_SKIP_WITHOUT(photo);
  const std::string said = succeed(photo.string() + " -o gravel.json --lobes 1");
  EXPECT_TRUE(has(said, "note: weak fit"));
  EXPECT_TRUE(has(said, "--lobes"));
}

// The size in the header decides, and the message states the memory that the fit would take.
TEST_F(FitGabor, BadImagesAreRefused) {
  expect_image_refused("constant.png", testing::png(64, 64, std::vector<std::uint8_t>(64 * 64, 77)));
  expect_image_refused("cut.png", text("rock.png").substr(0, text("rock.png").size() / 2));
  refuse(write("huge.png", testing::png_header(20000, 20000)) + " -o out.json",
         "huge.png: 20000 x 20000 pixels would take 7 GB");
}

// A grey picture through every way in: colours of one axis, a trend taken out, all outputs.
TEST_F(FitGabor, EveryOutputIsWritten) {
  fit("rock.json",
      "--channels pca --detrend 2 --detrend-by division --spectrum s.npy --report report --summary s.json");
  ASSERT_EQ(recipe().layers.size(), 1u);
  const GaborLayer layer = std::get<GaborLayer>(recipe().layers[0]);
  ASSERT_TRUE(layer.color.has_value());
  EXPECT_NEAR(layer.color->axis.x, std::sqrt(1.0 / 3.0), 1e-6);
  EXPECT_EQ(text("s.npy").substr(1, 5), "NUMPY");
  EXPECT_EQ(text("s.npy").size() % (64 * 64 * 8), 128u % (64 * 64 * 8));
  for (const std::string name : {"report.png", "report.svg", "exemplar.png", "synthesis.png",
                                 "spectrum_exemplar.png", "spectrum_fitted.png"}) {
    EXPECT_TRUE(exists("report/" + name)) << name;
  }
  EXPECT_EQ(json("s.json")["channels"].size(), 1u);
}

// A height map of 64 x 64 pixels of 2 m, with waves of 3 m rms about -1850 m; its first columns may be
// missing.
std::vector<float> heights(int missing_columns) {
  std::vector<float> result;
  for (int i = 0; i < 64 * 64; ++i) {
    const int x = i % 64, y = i / 64;
    const double wave = std::sin(0.7 * x + 0.2 * y) + std::sin(1.1 * y - 0.3 * x) + std::sin(0.5 * (x + y));
    result.push_back(x < missing_columns ? std::nanf("")
                                         : static_cast<float>(-1850.0 + std::sqrt(6.0) * wave));
  }
  return result;
}

TEST_F(FitGabor, AHeightMapNeedsNoOptions) {
  write_geotiff(heights(0), 64, 64, 2.0, "", folder_ / "dem.tif");
  const std::string said = succeed("dem.tif -o rock.json");
  EXPECT_TRUE(has(said, "dem.tif: pixels of 2 m; heights in metres (no unit is stated) of rms 3"));
  EXPECT_FALSE(has(said, "white is a height"));
  GaborLayer layer = std::get<GaborLayer>(recipe().layers[0]);
  EXPECT_EQ(recipe().length_unit, "m");
  EXPECT_DOUBLE_EQ(layer.pixel_size, 2.0);
  EXPECT_NEAR(layer.height_rms, 3.0, 0.15);
  succeed("dem.tif -o rock.json --unit km");
  layer = std::get<GaborLayer>(recipe().layers[0]);
  EXPECT_DOUBLE_EQ(layer.pixel_size, 0.002);
  EXPECT_NEAR(layer.height_rms, 0.003, 0.00015);
}

TEST_F(FitGabor, OptionsWinOverTheFile) {
  write_geotiff(heights(0), 64, 64, 2.0, "", folder_ / "dem.tif");
  const std::string said = succeed("dem.tif -o rock.json --mm-per-px 1000 --height-rms 5");
  EXPECT_TRUE(has(said, "--mm-per-px 1000 counts, and not the file's pixels of 2 m"));
  EXPECT_TRUE(has(said, "where --height-rms 5 counts"));
  const GaborLayer layer = std::get<GaborLayer>(recipe().layers[0]);
  EXPECT_DOUBLE_EQ(layer.pixel_size, 1.0);
  EXPECT_DOUBLE_EQ(layer.height_rms, 5.0);
}

TEST_F(FitGabor, AGlobeWithoutAFrameMayBeInDegrees) {
  std::string grid = "ncols 72\nnrows 36\nxllcorner 0\nyllcorner -90\ncellsize 5\n";
  for (int k = 0; k < 72 * 36; ++k)
    grid += std::to_string(unit_float(hash_cell(5u, k, 0, 0))) + (k % 72 == 71 ? "\n" : " ");
  write("globe.asc", grid);
  refuse("globe.asc -o rock.json", "pixels of 5 may be degrees");
  succeed("globe.asc -o rock.json --mm-per-px 1e6");
}

TEST_F(FitGabor, SmallPixelsOfSteepGroundMayBeInDegrees) {
  std::string grid = "ncols 40\nnrows 40\nxllcorner 11.2\nyllcorner 46.1\ncellsize 0.0002777778\n";
  std::string flat = grid;
  for (int k = 0; k < 40 * 40; ++k) {
    const float height = unit_float(hash_cell(5u, k, 0, 0));
    grid += std::to_string(300.0F + height) + (k % 40 == 39 ? "\n" : " ");
    flat += std::to_string(2e-3F * height) + (k % 40 == 39 ? "\n" : " ");
  }
  write("dem.asc", grid);
  write("scan.asc", flat);
  refuse("dem.asc -o rock.json", "may be degrees");
  succeed("dem.asc -o rock.json --mm-per-px 30000");
  EXPECT_TRUE(has(succeed("scan.asc -o rock.json"), "pixels of 0.0002777778 m"));
}

TEST_F(FitGabor, PixelsBecomeSquare) {
  write_geotiff(heights(0), 64, 64, 2.0, "", folder_ / "dem.tif");
  EXPECT_TRUE(has(succeed("dem.tif -o rock.json --mm-per-px 2000 --mm-per-px-y 3000"),
                  "pixels of 2 x 3 m become square ones of 3 m, 42 x 64 of them"));
  EXPECT_DOUBLE_EQ(std::get<GaborLayer>(recipe().layers[0]).pixel_size, 3.0);
  refuse("dem.tif -o rock.json --mm-per-px-y 3000", "--mm-per-px");
}

TEST_F(FitGabor, HeightsHaveTheUnitThatIsGiven) {
  write_geotiff(heights(0), 64, 64, 2.0, "", folder_ / "dem.tif");
  EXPECT_TRUE(has(succeed("dem.tif -o rock.json --height-unit dm"), "heights in metres of rms 0.3"));
  refuse("dem.tif -o rock.json --height-unit parsec", "is no unit of length");
  refuse("dem.tif -o rock.json --raw-size 9", "--raw-size");
}

TEST_F(FitGabor, MissingGroundIsLeftOut) {
  write_geotiff(heights(0), 64, 64, 2.0, "", folder_ / "whole.tif");
  write_geotiff(heights(7), 64, 64, 2.0, "", folder_ / "dem.tif");
  succeed("whole.tif -o rock.json");
  const double whole = std::get<GaborLayer>(recipe().layers[0]).height_rms;
  EXPECT_TRUE(has(succeed("dem.tif -o rock.json"), "11 % of the pixels are missing"));
  EXPECT_NEAR(std::get<GaborLayer>(recipe().layers[0]).height_rms, whole, 0.02 * whole);
  EXPECT_TRUE(
      has(succeed("dem.tif -o rock.json --model exemplar"), "the largest part without gaps, 57 x 64"));
  write_geotiff(heights(40), 64, 64, 2.0, "", folder_ / "half.tif");
  refuse("half.tif -o rock.json", "62 % of the pixels have no value");
  write_geotiff(heights(31), 64, 64, 2.0, "", folder_ / "half.tif");
  succeed("half.tif -o rock.json --model phase");
}

TEST_F(FitGabor, BadFilesAndOddOptionsAreRefused) {
  std::filesystem::create_directory(folder_ / "folder");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  refuse_all("", {{"absent.png -o out.json", "absent.png"},
                  {"folder -o out.json", "folder"},
                  {"pipe.png -o out.json", "pipe.png"},
                  {"rock.png -o absent/out.json", "out.json"},
                  {"rock.png -o folder", "folder"}});
  refuse_all("rock.png -o o.json ", {{"--channels rgb", "--channels"},
                                     {"--detrend 7", "--detrend"},
                                     {"--detrend-by hope", "--detrend-by"},
                                     {"--lobes 0", "--lobes"},
                                     {"--model phase --lobes 5", "--lobes"},
                                     {"--penalty nan", "--penalty"},
                                     {"--gap nan", "--gap"},
                                     {"--height-rms nan", "--height-rms"},
                                     {"--mm-per-px nan", "--mm-per-px"},
                                     {"--max-memory 0.001", "rock.png"}});
}

}  // namespace
}  // namespace astrolith
