// asteroid_experiment on three small bodies: what it writes, and that it knows them again.
#include <nlohmann/json.hpp>

#include "tests/apps/labelled_shapes.h"

namespace astrolith {
namespace {

using testing::LabelledShapes;
using testing::run_program;

const std::string kExperiment = ASTROLITH_ASTEROID_EXPERIMENT;

TEST(AsteroidExperiment, StatesItsProtocolAndKnowsBodiesAgain) {
  const LabelledShapes shapes;
  std::filesystem::copy(shapes.at("shapes/ring/0.ply"), shapes.at("ring_b.ply"));
  std::string texts[2];
  for (const int threads : {1, 2}) {
    const testing::Outcome outcome = run_program(
        kExperiment, {shapes.at("ball.obj"), shapes.at("box.obj"), shapes.at("ring.obj"), "-o",
                      shapes.at("r.json"), "--resamplings", "4", "--noise", "0.002", "0.02", "--trees", "20",
                      "--others", shapes.at("ring_b.ply"), "--threads", std::to_string(threads)});
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    texts[threads - 1] = testing::text_of(shapes.folder / "r.json");
  }
  EXPECT_EQ(texts[0], texts[1]);
  const auto result = nlohmann::json::parse(texts[0]);
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

TEST(AsteroidExperiment, RefusesByName) {
  const LabelledShapes shapes;
  const auto refused = [&](const std::vector<std::string>& given, const std::string& culprit) {
    testing::expect_refusal(shapes.folder, kExperiment, given, culprit);
  };
  refused({shapes.at("ball.obj"), shapes.at("ball.obj"), "-o", shapes.at("r.json")}, "second model of ball");
  refused({shapes.at("absent.obj"), "-o", shapes.at("r.json")}, "absent.obj");
  refused({shapes.at("ball.obj"), "-o", shapes.at("r.json"), "--others", shapes.at("ring.obj")},
          "no model of ring");
  refused({shapes.at("ball.obj"), "-o", shapes.at("r.json"), "--noise", "2"}, "--noise");
}

}  // namespace
}  // namespace astrolith
