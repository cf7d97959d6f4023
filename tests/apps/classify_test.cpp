// classify: folders of meshes to a classifier, meshes to classes, as a user runs it.
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/inputs.h"
#include "tests/apps/labelled_shapes.h"
#include "tests/apps/program_runner.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;
using testing::run_program;
using testing::WorkFolder;

const std::string kClassify = ASTROLITH_CLASSIFY;

struct Shapes : testing::LabelledShapes {
  std::vector<std::string> train(const std::vector<std::string>& more = {"--features", "wahl"}) const {
    std::vector<std::string> arguments{"train", all,       "-o", at("model.yml"), "--points",
                                       "500",   "--trees", "40", "--folds",       "3"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

std::vector<nlohmann::json> lines_of(const std::string& output) {
  std::vector<nlohmann::json> lines;
  std::istringstream text(output);
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

TEST(Classify, LearnsClassesAndNamesThem) {
  const Shapes shapes;
  const Outcome trained =
      run_program(kClassify, shapes.train({"--features", "wahl", "--summary", shapes.at("s.json")}));
  ASSERT_EQ(trained.status, 0) << trained.errors;
  EXPECT_EQ(trained.output, "");
  const auto summary = nlohmann::json::parse(testing::text_of(shapes.folder / "s.json"));
  EXPECT_EQ(summary["shapes"], 18);
  EXPECT_EQ(summary["class_names"], (std::vector<std::string>{"ball", "box", "ring"}));
  EXPECT_GE(summary["cross_validation"]["accuracy"], 0.9);
  EXPECT_EQ(summary["cross_validation"]["confusion"].size(), 3u);
  EXPECT_EQ(summary["cross_validation"]["classes"][0]["precision_at_recall"].size(),
            summary["cross_validation"]["recall_levels"].size());
  EXPECT_TRUE(summary["failed"].empty());

  const Outcome said =
      run_program(kClassify, {"predict", shapes.at("model.yml"), shapes.at("ball.obj"), shapes.at("box.obj"),
                              shapes.at("ring.obj"), shapes.at("shapes/box")});
  ASSERT_EQ(said.status, 0) << said.errors;
  const std::vector<nlohmann::json> lines = lines_of(said.output);
  ASSERT_EQ(lines.size(), 9u);
  EXPECT_EQ(lines[0]["mesh"], shapes.at("ball.obj"));
  EXPECT_EQ(lines[0]["class"], "ball");
  EXPECT_EQ(lines[1]["class"], "box");
  EXPECT_EQ(lines[2]["class"], "ring");
  double votes = 0;
  for (const auto& [name, share] : lines[2]["votes"].items()) votes += share.get<double>();
  EXPECT_NEAR(votes, 1, 1e-12);
  for (std::size_t i = 3; i < 9; ++i) EXPECT_EQ(lines[i]["class"], "box");
}

TEST(Classify, EveryFeatureKindAndComponents) {
  const Shapes shapes;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--features", "ahd", "--pca", "4"}, {"--features", "d2", "--bins", "32"}}) {
    const Outcome trained = run_program(kClassify, shapes.train(more));
    ASSERT_EQ(trained.status, 0) << trained.errors;
    EXPECT_EQ(
        lines_of(run_program(kClassify, {"predict", shapes.at("model.yml"), shapes.at("ring.obj")}).output)
            .at(0)["class"],
        "ring");
  }
  const Outcome spectra =
      run_program(kClassify, {"train", shapes.all, "-o", shapes.at("model.yml"), "--features", "shapedna",
                              "--eigenvalues", "8", "--trees", "20"});
  ASSERT_EQ(spectra.status, 0) << spectra.errors;
}

TEST(Classify, SameBytesForAnyThreadCount) {
  const Shapes shapes;
  std::string models[2], answers[2];
  for (const int threads : {1, 2}) {
    const std::string count = std::to_string(threads);
    ASSERT_EQ(
        run_program(kClassify, shapes.train({"--features", "wahl", "--threads", count, "--pca", "3"})).status,
        0);
    models[threads - 1] = testing::text_of(shapes.folder / "model.yml");
    answers[threads - 1] =
        run_program(kClassify, {"predict", shapes.at("model.yml"), shapes.all + "/ring", "--threads", count})
            .output;
  }
  EXPECT_EQ(models[0], models[1]);
  EXPECT_EQ(answers[0], answers[1]);
  ASSERT_EQ(run_program(kClassify, shapes.train({"--features", "wahl", "--seed", "2"})).status, 0);
  EXPECT_NE(testing::text_of(shapes.folder / "model.yml"), models[0]);
}

TEST(Classify, NamesUnreadableFilesAndGoesOn) {
  const Shapes shapes;
  shapes.folder.write("shapes/ball/broken.ply", testing::truncated_ply());
  shapes.folder.write("shapes/ring/empty.obj", "");
  shapes.folder.write("shapes/ring/notes.md", "no mesh");
  const Outcome trained =
      run_program(kClassify, shapes.train({"--features", "d2", "--quiet", "--summary", shapes.at("s.json")}));
  EXPECT_EQ(trained.status, 1);
  EXPECT_NE(trained.errors.find("ball/broken.ply"), std::string::npos) << trained.errors;
  EXPECT_NE(trained.errors.find("ring/empty.obj"), std::string::npos) << trained.errors;
  EXPECT_EQ(std::count(trained.errors.begin(), trained.errors.end(), '\n'), 2) << trained.errors;
  const auto summary = nlohmann::json::parse(testing::text_of(shapes.folder / "s.json"));
  EXPECT_EQ(summary["shapes"], 18);
  EXPECT_EQ(summary["failed"].size(), 2u);

  const Outcome said = run_program(
      kClassify, {"predict", shapes.at("model.yml"), shapes.at("absent.obj"), shapes.at("ring.obj")});
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.errors.find("absent.obj"), std::string::npos);
  EXPECT_EQ(lines_of(said.output).size(), 1u);
}

TEST(Classify, NamesFilesThatItSkipsAndOpenMeshesThatItTakes) {
  const Shapes shapes;
  shapes.folder.write("shapes/ring/notes.md", "no mesh");
  shapes.folder.write("shapes/ring/.hidden", "no mesh");
  shapes.folder.write("shapes/ball/open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome trained = run_program(kClassify, shapes.train({"--features", "wahl"}));
  EXPECT_EQ(trained.status, 0) << trained.errors;
  EXPECT_NE(trained.errors.find("notes.md: skipped"), std::string::npos) << trained.errors;
  EXPECT_EQ(trained.errors.find(".hidden"), std::string::npos) << trained.errors;
  EXPECT_NE(trained.errors.find("open.obj: open, 3 edges have one face only"), std::string::npos)
      << trained.errors;
  const Outcome said = run_program(kClassify, {"predict", shapes.at("model.yml"), shapes.all + "/ring"});
  EXPECT_NE(said.errors.find("notes.md: skipped"), std::string::npos) << said.errors;
}

TEST(Classify, RefusesByName) {
  const Shapes shapes;
  const std::string model = shapes.at("model.yml");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& culprit) {
    testing::expect_refusal(shapes.folder, kClassify, arguments, culprit);
  };
  refused({"train", shapes.at("nowhere"), "-o", model}, "nowhere: is no folder");
  refused({"train", shapes.folder.write("mesh.obj", testing::kTetrahedron), "-o", model},
          "mesh.obj: is no folder");
  refused({"train", shapes.all + "/ball", "-o", model, "--folds", "0", "--points", "50"}, "1 classes");
  refused({"train", shapes.all, "-o", shapes.at("no/such/model.yml")}, "model.yml");
  refused({"train", shapes.all, "-o", shapes.all + "/ball/0.ply", "--points", "50"}, "0.ply: is no .yml");
  refused(shapes.train({"--features", "shapedna"}), "--points");
  refused(shapes.train({"--eigenvalues", "5"}), "--eigenvalues");
  refused(shapes.train({"--bins", "64"}), "bins 64");
  refused(shapes.train({"--features", "d2", "--pca", "500"}), "500 of");
  fs::create_directories(shapes.folder / "shapes/dust");
  refused(shapes.train(), "dust: holds no meshes");
  shapes.folder.write("shapes/dust/broken.ply", testing::truncated_ply());
  EXPECT_EQ(run_program(kClassify, shapes.train()).status, 2);
  EXPECT_FALSE(fs::exists(model));

  refused({"predict", shapes.at("absent.yml"), shapes.at("ring.obj")}, "absent.yml");
  refused({"predict", shapes.folder.write("bad.yml", "%YAML:1.0\n---\n"), shapes.at("ring.obj")}, "bad.yml");
  refused({"predict", shapes.at("ring.obj"), shapes.at("ring.obj")}, "ring.obj");
}

TEST(Classify, WrongCommandLinesAreRefused) {
  const WorkFolder folder;
  testing::expect_refusal(folder, kClassify, {}, "required");
  testing::expect_refusal(folder, kClassify, {"train"}, "required");
  testing::expect_refusal(folder, kClassify, {"predict", "model.yml"}, "required");
  testing::expect_refusal(folder, kClassify, {"train", "in", "-o", "out", "--no-such-option"},
                          "--no-such-option");
  testing::expect_refusal(folder, kClassify, {"train", "in", "-o", "out", "--trees", "0"}, "--trees");
  testing::expect_refusal(folder, kClassify, {"predict", "in", "out", "--threads", "many"}, "--threads");
  const Outcome version = run_program(kClassify, {"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.output.rfind("classify ", 0), 0u);
  for (const std::string command : {"train", "predict"}) {
    const Outcome help = run_program(kClassify, {command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.errors, "");
    EXPECT_EQ(help.output.find("[]"), std::string::npos) << help.output;
  }
}

}  // namespace
}  // namespace astrolith
