// compare, run as a user runs it.
#include <nlohmann/json.hpp>

#include "tests/apps/inputs.h"
#include "tests/apps/program_runner.h"

namespace astrolith {
namespace {

using testing::ellipsoid_obj;
using testing::expect_refusal;
using testing::Outcome;
using testing::run_program;
using testing::text_of;
using testing::WorkFolder;

const std::string kCompare = ASTROLITH_COMPARE;

class Compare : public ::testing::Test {
 protected:
  nlohmann::json compare(const std::string& a, const std::string& b, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{a, b, "--points", "1000", "--samples", "5000"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(kCompare, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }

  WorkFolder folder_;
  const std::string ball_ = folder_.write("ball.obj", ellipsoid_obj(1, 1, 1, 47, 96));
  const std::string bigger_ = folder_.write("bigger.obj", ellipsoid_obj(1.1, 1.1, 1.1, 47, 96));
  const std::string long_ = folder_.write("long.obj", ellipsoid_obj(3, 1, 1, 47, 96));
};

TEST_F(Compare, SpheresOfTwoSizesAreAlikeAndApart) {
  const auto same = compare(ball_, bigger_, {"--floor"});
  EXPECT_GT(same["similarity"].get<double>(), 0.9);
  EXPECT_GT(same["similarity_floor"]["a"].get<double>(), 0.9);
  EXPECT_GT(same["similarity_floor"]["b"].get<double>(), 0.9);
  const double diagonal = same["in_units_of_the_files"]["diagonal_of_a"].get<double>();
  EXPECT_NEAR(diagonal, std::sqrt(12.0), 0.01);
  for (const char* figure : {"mean", "p99", "max"}) {
    EXPECT_NEAR(same[std::string(figure) + "_distance"].get<double>() * diagonal, 0.1, 0.003);
    for (const char* way : {"both", "from_a_to_b", "from_b_to_a"}) {
      EXPECT_NEAR(same["in_units_of_the_files"][way][figure].get<double>(), 0.1, 0.003);
    }
  }
  const auto other = compare(ball_, long_);
  EXPECT_LT(other["similarity"].get<double>(), 0.5);
  EXPECT_FALSE(other.contains("similarity_floor"));
  for (const char* distance : {"l2", "chi_square", "jensen_shannon", "earth_movers"}) {
    EXPECT_GT(other[distance].get<double>(), 2 * same[distance].get<double>()) << distance;
  }
  EXPECT_NEAR(other["in_units_of_the_files"]["from_b_to_a"]["max"].get<double>(), 2, 0.02);
}

TEST_F(Compare, WritesAFileAndASummary) {
  const std::string file = (folder_ / "c.json").string();
  const Outcome outcome = run_program(kCompare, {ball_, long_, "-o", file, "--points", "300", "--samples",
                                                 "500", "--summary", (folder_ / "s.json").string()});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  EXPECT_TRUE(summary.at("seconds").is_number());
  summary.erase("seconds");
  EXPECT_EQ(summary, nlohmann::json::parse(text_of(file)));
}

TEST_F(Compare, SameOutputForAnyThreadCount) {
  EXPECT_EQ(compare(ball_, long_, {"--threads", "1"}), compare(ball_, long_, {"--threads", "2"}));
}

TEST_F(Compare, JudgesWhetherASurfacePasses) {
  const std::vector<std::string> realism{"--realism", "--places", "1500", "--unit", "km", "--floor"};
  const auto same = compare(ball_, bigger_, realism)["realism"];
  EXPECT_TRUE(same["passes"].get<bool>()) << same.dump();
  EXPECT_EQ(same["words"][0].get<std::string>(), "passes");
  EXPECT_GT(same["floor"]["p"].get<double>(), 0.05);
  EXPECT_FALSE(compare(ball_, bigger_).contains("realism"));
  expect_refusal(folder_, kCompare, {ball_, bigger_, "--unit", "km"}, "--realism");
}

TEST_F(Compare, BadFilesAreRefused) {
  const std::string index = folder_.write("index.obj", testing::kTetrahedron + "f 1 2 5\n");
  expect_refusal(folder_, kCompare, {ball_, index}, "index.obj");
  expect_refusal(folder_, kCompare, {index, ball_}, "index.obj");
  expect_refusal(folder_, kCompare, {ball_, (folder_ / "absent.ply").string()}, "absent.ply");
  const std::string flat = folder_.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  expect_refusal(folder_, kCompare, {ball_, flat}, "flat.obj");
  expect_refusal(folder_, kCompare, {ball_, long_, "-o", ball_}, "input itself");
  expect_refusal(folder_, kCompare, {ball_, long_, "--samples", "0"}, "--samples");
}

}  // namespace
}  // namespace astrolith
