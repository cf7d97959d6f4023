// asteroid_experiment on three small bodies: what it writes, and that it knows them again.
#include "tests/apps/labelled_shapes.h"

namespace astrolith {
namespace {

class AsteroidExperiment : public testing::LabelledShapesTest {
 protected:
  AsteroidExperiment() : LabelledShapesTest(ASTROLITH_ASTEROID_EXPERIMENT) {}
};

TEST_F(AsteroidExperiment, StatesItsProtocolAndKnowsBodiesAgain) {
  std::filesystem::copy(folder_ / "shapes/ring/0.ply", folder_ / "ring_b.ply");
  std::string texts[2];
  for (const int threads : {1, 2}) {
    succeed(
        "ball.obj box.obj ring.obj -o r.json --resamplings 4 --noise 0.002 0.02 --trees 20 --others "
        "ring_b.ply --threads " +
        std::to_string(threads));
    texts[threads - 1] = text("r.json");
  }
  EXPECT_EQ(texts[0], texts[1]);
  const auto result = json("r.json");
  EXPECT_EQ(result["protocol"]["bodies"].size(), 3u);
  EXPECT_EQ(result["protocol"]["bodies"][2]["body"], "ring");
  ASSERT_EQ(result["descriptors"].size(), 4u);
  for (const auto& d : result["descriptors"]) {
    ASSERT_EQ(d["levels"].size(), 2u);
    EXPECT_EQ(d["levels"][0]["forest"]["shapes"], 6);
    EXPECT_GE(d["levels"][0]["retrieval"]["mean_average_precision"], 0.5) << d["features"];
    EXPECT_EQ(d["levels"][1]["retrieval"]["precision_at_recall"].size(), result["recall_levels"].size());
    EXPECT_EQ(d["transfer"]["accuracy"][1].size(), 2u);
    EXPECT_EQ(d["other_models"][0]["shapes"], 4);
    EXPECT_EQ(d["projection"].size(), 12u);
  }
}

TEST_F(AsteroidExperiment, RefusesByName) {
  refuse("ball.obj ball.obj -o r.json", "second model of ball");
  refuse("absent.obj -o r.json", "absent.obj");
  refuse("ball.obj -o r.json --others ring.obj", "no model of ring");
  refuse("ball.obj -o r.json --noise 2", "--noise");
}

}  // namespace
}  // namespace astrolith
