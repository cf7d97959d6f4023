// classify: folders of meshes to a classifier, meshes to classes.
#include "tasks/description/description_jobs.h"

#include "geometry/io/mesh_io.h"
#include "numerics/hash_random.h"
#include "tests/support/meshes.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::has;
using testing::Outcome;

const std::string kTrain = "train shapes -o model.yml --points 500 --trees 40 --folds 3 ";

// A mesh of a class, stretched a little and with every vertex moved a little.
TriangleMesh make_shape(const std::string& kind, std::uint64_t seed) {
  TriangleMesh mesh = kind == "ball" ? testing::icosphere(3) : testing::torus(1, 0.4, 24, 12);
  if (kind == "box") {
    mesh = testing::cube(1.0);
    for (int i = 0; i < 3; ++i) mesh = testing::subdivided(mesh);
  }
  CounterRandom random(seed);
  const Vec3d stretch{random.uniform(0.9, 1.1), random.uniform(0.9, 1.1), random.uniform(0.9, 1.1)};
  for (Vec3d& p : mesh.vertices) {
    p = {p.x * stretch.x, p.y * stretch.y, p.z * stretch.z};
    p += 0.01 * Vec3d{random.normal(), random.normal(), random.normal()};
  }
  return mesh;
}

// shapes/ball, shapes/box and shapes/ring hold six meshes each. A fresh mesh of each class lies beside them.
class Classify : public testing::JobTest {
 protected:
  Classify() : JobTest("classify", declare_classify) {
    std::uint64_t seed = 0;
    for (const std::string kind : {"ball", "box", "ring"}) {
      const std::string folder = "shapes/" + kind + "/";
      std::filesystem::create_directories(folder_ / folder);
      for (int i = 0; i < 6; ++i)
        write_mesh(make_shape(kind, ++seed), folder_ / (folder + std::to_string(i) + ".ply"), {});
      write_mesh(make_shape(kind, ++seed), folder_ / (kind + ".obj"), {});
    }
  }
};

std::vector<nlohmann::json> read_lines(const std::string& output) {
  std::vector<nlohmann::json> lines;
  std::istringstream text(output);
  for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

TEST_F(Classify, LearnsClassesAndNamesThem) {
  const Outcome trained = run(kTrain + "--features wahl --summary s.json");
  ASSERT_EQ(trained.status, 0) << trained.errors;
  EXPECT_EQ(trained.output, "");
  const auto summary = json("s.json");
  EXPECT_EQ(summary["shapes"], 18);
  EXPECT_EQ(summary["class_names"], (std::vector<std::string>{"ball", "box", "ring"}));
  EXPECT_GE(summary["cross_validation"]["accuracy"], 0.9);
  EXPECT_EQ(summary["cross_validation"]["confusion"].size(), 3u);
  EXPECT_EQ(summary["cross_validation"]["classes"][0]["precision_at_recall"].size(),
            summary["cross_validation"]["recall_levels"].size());
  EXPECT_GE(summary["retrieval"]["mean_average_precision"], 0.7);
  EXPECT_EQ(summary["retrieval"]["precision_at_recall"].size(), summary["retrieval"]["recall_levels"].size());
  EXPECT_TRUE(summary["failed"].empty());

  const Outcome said = run("predict model.yml ball.obj box.obj ring.obj shapes/box");
  ASSERT_EQ(said.status, 0) << said.errors;
  const std::vector<nlohmann::json> lines = read_lines(said.output);
  ASSERT_EQ(lines.size(), 9u);
  EXPECT_EQ(lines[0]["mesh"], "ball.obj");
  EXPECT_EQ(lines[0]["class"], "ball");
  EXPECT_EQ(lines[1]["class"], "box");
  EXPECT_EQ(lines[2]["class"], "ring");
  double votes = 0;
  for (const auto& [name, share] : lines[2]["votes"].items()) votes += share.get<double>();
  EXPECT_NEAR(votes, 1, 1e-12);
  for (std::size_t i = 3; i < 9; ++i) EXPECT_EQ(lines[i]["class"], "box");
}

TEST_F(Classify, EveryFeatureKindAndComponents) {
  for (const std::string kind : {"--features ahd --pca 4", "--features d2 --bins 32"}) {
    succeed(kTrain + kind);
    EXPECT_EQ(read_lines(run("predict model.yml ring.obj").output).at(0)["class"], "ring");
  }
  succeed("train shapes -o model.yml --features shapedna --eigenvalues 8 --trees 20");
}

TEST_F(Classify, SameBytesForAnyThreadCount) {
  std::string models[2], answers[2];
  for (const int threads : {1, 2}) {
    const std::string words = " --threads " + std::to_string(threads);
    succeed(kTrain + "--features wahl --pca 3" + words);
    models[threads - 1] = text("model.yml");
    answers[threads - 1] = run("predict model.yml shapes/ring" + words).output;
  }
  EXPECT_EQ(models[0], models[1]);
  EXPECT_EQ(answers[0], answers[1]);
  succeed(kTrain + "--features wahl --seed 2");
  EXPECT_NE(text("model.yml"), models[0]);
}

TEST_F(Classify, NamesUnreadableFilesAndGoesOn) {
  write("shapes/ball/broken.ply", testing::truncated_ply());
  write("shapes/ring/empty.obj", "");
  write("shapes/ring/notes.md", "no mesh");
  const Outcome trained = run(kTrain + "--features d2 --quiet --summary s.json");
  EXPECT_EQ(trained.status, 1);
  EXPECT_TRUE(has(trained.errors, "ball/broken.ply"));
  EXPECT_TRUE(has(trained.errors, "ring/empty.obj"));
  EXPECT_EQ(std::count(trained.errors.begin(), trained.errors.end(), '\n'), 2) << trained.errors;
  EXPECT_EQ(json("s.json")["shapes"], 18);
  EXPECT_EQ(json("s.json")["failed"].size(), 2u);

  const Outcome said = run("predict model.yml absent.obj ring.obj");
  EXPECT_EQ(said.status, 1);
  EXPECT_TRUE(has(said.errors, "absent.obj"));
  EXPECT_EQ(read_lines(said.output).size(), 1u);
}

TEST_F(Classify, NamesFilesThatItSkipsAndOpenMeshesThatItTakes) {
  write("shapes/ring/notes.md", "no mesh");
  write("shapes/ring/.hidden", "no mesh");
  write("shapes/ball/open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string said = succeed(kTrain + "--features wahl");
  EXPECT_TRUE(has(said, "notes.md: skipped"));
  EXPECT_FALSE(has(said, ".hidden"));
  EXPECT_TRUE(has(said, "open.obj: open, 3 edges have one face only"));
  EXPECT_TRUE(has(succeed("predict model.yml shapes/ring"), "notes.md: skipped"));
}

TEST_F(Classify, RefusesByName) {
  write("mesh.obj", testing::kTetrahedron);
  write("bad.yml", "%YAML:1.0\n---\n");
  refuse_all("", {{"train nowhere -o model.yml", "nowhere: is no folder"},
                  {"train mesh.obj -o model.yml", "mesh.obj: is no folder"},
                  {"train shapes/ball -o model.yml --folds 0 --points 50", "1 classes"},
                  {"train shapes -o no/such/model.yml", "model.yml"},
                  {"train shapes -o shapes/ball/0.ply --points 50", "0.ply: is no .yml"},
                  {kTrain + "--features shapedna", "--points"},
                  {kTrain + "--eigenvalues 5", "--eigenvalues"},
                  {kTrain + "--bins 64", "bins 64"},
                  {kTrain + "--features d2 --pca 500", "500 of"},
                  {"predict absent.yml ring.obj", "absent.yml"},
                  {"predict bad.yml ring.obj", "bad.yml"},
                  {"predict ring.obj ring.obj", "ring.obj"}});
  std::filesystem::create_directories(folder_ / "shapes/dust");
  refuse(kTrain + "--features wahl", "dust: holds no meshes");
  write("shapes/dust/broken.ply", testing::truncated_ply());
  EXPECT_EQ(run(kTrain + "--features wahl").status, 2);
  EXPECT_FALSE(exists("model.yml"));
}

TEST_F(Classify, WrongCommandLinesAreRefused) {
  refuse_all("", {{"", "required"},
                  {"train", "required"},
                  {"predict model.yml", "required"},
                  {"train in -o out --no-such-option", "--no-such-option"},
                  {"train in -o out --trees 0", "--trees"},
                  {"predict in out --threads many", "--threads"}});
  EXPECT_EQ(run("--version").output.rfind("classify ", 0), 0u);
  for (const std::string command : {"train", "predict"}) {
    const Outcome help = run(command + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.errors, "");
    EXPECT_FALSE(has(help.output, "[]"));
  }
}

}  // namespace
}  // namespace astrolith
