// standard_set_experiment on three small classes: what it writes, and that it tells them apart.
#include "tests/apps/inputs.h"
#include "tests/apps/labelled_shapes.h"

namespace astrolith {
namespace {

const std::string kLine = "shapes -o r.json --points 400 --trees 20 --repeats 2 --folds 3";

class StandardSetExperiment : public testing::LabelledShapesTest {
 protected:
  StandardSetExperiment() : LabelledShapesTest(ASTROLITH_STANDARD_SET_EXPERIMENT) {}
};

TEST_F(StandardSetExperiment, StatesItsProtocolTellsClassesApartAndNamesUnreadableFiles) {
  // This mesh is no surface. Its spectrum comes from points.
  write("shapes/box/fin.obj", testing::kTetrahedron + "v 2 2 2\nf 1 2 5\n");
  write("shapes/ball/broken.ply", testing::truncated_ply());
  const testing::Outcome outcome = run(kLine);
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  EXPECT_TRUE(testing::has(outcome.errors, "broken.ply"));
  const auto result = json("r.json");
  EXPECT_EQ(result["protocol"]["models"], 20);  // the unreadable one too
  ASSERT_EQ(result["descriptors"].size(), 4u);
  for (const auto& d : result["descriptors"]) {
    EXPECT_EQ(d["shapes"], 19);
    EXPECT_GE(d["cross_validation"]["accuracy"]["mean"], 0.7) << d["features"];
    EXPECT_EQ(d["trained_on_few"].size(), 3u);  // forests trained on 1, 2 and 4 of the six models
    EXPECT_EQ(d["described_by_points"], d["features"]["kind"] == "shapedna" ? 1 : 0);
  }
  refuse("none -o r2.json", "none");
}

}  // namespace
}  // namespace astrolith
