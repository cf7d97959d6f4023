// standard_set_experiment on three small classes: what it writes, and that it tells them apart.
#include <nlohmann/json.hpp>

#include "tests/apps/inputs.h"
#include "tests/apps/labelled_shapes.h"

namespace astrolith {
namespace {

using testing::LabelledShapes;
using testing::run_program;

const std::string kStandardSet = ASTROLITH_STANDARD_SET_EXPERIMENT;

std::vector<std::string> arguments(const LabelledShapes& shapes) {
  return {shapes.all,  "-o", shapes.at("r.json"), "--points", "400", "--trees", "20",
          "--repeats", "2",  "--folds",           "3"};
}

TEST(StandardSetExperiment, StatesItsProtocolAndTellsClassesApart) {
  const LabelledShapes shapes;
  // This mesh is no surface. Its spectrum comes from points.
  shapes.folder.write("shapes/box/fin.obj", testing::kTetrahedron + "v 2 2 2\nf 1 2 5\n");
  const testing::Outcome outcome = run_program(kStandardSet, arguments(shapes));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto result = nlohmann::json::parse(testing::text_of(shapes.folder / "r.json"));
  EXPECT_EQ(result["protocol"]["models"], 19);
  ASSERT_EQ(result["descriptors"].size(), 4u);
  for (const auto& d : result["descriptors"]) {
    EXPECT_EQ(d["shapes"], 19);
    EXPECT_GE(d["cross_validation"]["accuracy"]["mean"], 0.7) << d["features"];
    EXPECT_EQ(d["trained_on_few"].size(), 3u);  // forests trained on 1, 2 and 4 of the six models
    EXPECT_EQ(d["described_by_points"], d["features"]["kind"] == "shapedna" ? 1 : 0);
  }
}

TEST(StandardSetExperiment, NamesUnreadableFilesAndGoesOn) {
  const LabelledShapes shapes;
  shapes.folder.write("shapes/ball/broken.ply", testing::truncated_ply());
  const testing::Outcome outcome = run_program(kStandardSet, arguments(shapes));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.errors.find("broken.ply"), std::string::npos);
  testing::expect_refusal(shapes.folder, kStandardSet, {shapes.at("none"), "-o", shapes.at("r2.json")},
                          "none");
}

}  // namespace
}  // namespace astrolith
