// compare, run as a user runs it.
#include <algorithm>

#include "tests/apps/inputs.h"
#include "tests/apps/program_runner.h"

namespace astrolith {
namespace {

class Compare : public testing::ProgramTest {
 protected:
  Compare() : ProgramTest(ASTROLITH_COMPARE) {
    write("ball.obj", testing::ellipsoid_obj(1, 1, 1, 47, 96));
    write("bigger.obj", testing::ellipsoid_obj(1.1, 1.1, 1.1, 47, 96));
    write("long.obj", testing::ellipsoid_obj(3, 1, 1, 47, 96));
  }
  nlohmann::json compare(const std::string& line) {
    const testing::Outcome outcome = run(line + " --points 1000 --samples 5000");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
};

TEST_F(Compare, SpheresOfTwoSizesAreAlikeAndApart) {
  const auto same = compare("ball.obj bigger.obj --floor");
  EXPECT_GT(same["similarity"], 0.9);
  EXPECT_GT(same["similarity_floor"]["a"], 0.9);
  EXPECT_GT(same["similarity_floor"]["b"], 0.9);
  const double diagonal = same["in_units_of_the_files"]["diagonal_of_a"];
  EXPECT_NEAR(diagonal, std::sqrt(12.0), 0.01);
  for (const char* figure : {"mean", "p99", "max"}) {
    EXPECT_NEAR(same[std::string(figure) + "_distance"].get<double>() * diagonal, 0.1, 0.003);
    for (const char* way : {"both", "from_a_to_b", "from_b_to_a"}) {
      EXPECT_NEAR(same["in_units_of_the_files"][way][figure], 0.1, 0.003);
    }
  }
  const auto other = compare("ball.obj long.obj --threads 1");
  EXPECT_EQ(other, compare("ball.obj long.obj --threads 2"));
  EXPECT_LT(other["similarity"], 0.5);
  EXPECT_FALSE(other.contains("similarity_floor"));
  for (const char* distance : {"l2", "chi_square", "jensen_shannon", "earth_movers"}) {
    EXPECT_GT(other[distance], 2 * same[distance].get<double>()) << distance;
  }
  EXPECT_NEAR(other["in_units_of_the_files"]["from_b_to_a"]["max"], 2, 0.02);
}

TEST_F(Compare, BringsBothToOneUnit) {
  write("km.obj", "# length unit: km\n" + testing::ellipsoid_obj(1, 1, 1, 47, 96));
  write("m.obj", "# length unit: m\n" + testing::ellipsoid_obj(1000, 1000, 1000, 47, 96));
  const auto same = compare("km.obj m.obj");
  EXPECT_EQ(same["length_unit"], "km");
  EXPECT_LT(same["mean_distance"], 1e-6);
  EXPECT_GT(compare("ball.obj m.obj")["mean_distance"], 1.0);
  const std::string said = succeed("km.obj m.obj --points 300 --samples 500 --realism --places 300");
  EXPECT_TRUE(testing::has(said, "m.obj: from m to km, the unit of km.obj")) << said;
}

TEST_F(Compare, ScalesNothingWhereAUnitIsUnknown) {
  write("m.obj", "# length unit: m\n" + testing::ellipsoid_obj(1, 1, 1, 47, 96));
  write("ft.obj", "# length unit: ft\n" + testing::ellipsoid_obj(1, 1, 1, 47, 96));
  write("km.obj", "# length unit: km\n" + testing::ellipsoid_obj(1, 1, 1, 47, 96));
  for (const std::string other : {"m.obj", "km.obj"}) {
    const std::string said = succeed("ft.obj " + other + " -o c.json --points 300 --samples 500");
    EXPECT_TRUE(testing::has(said, "note: " + other + ": is in ")) << said;
    EXPECT_TRUE(testing::has(said, ", and ft.obj in ft; nothing was scaled")) << said;
    EXPECT_EQ(json("c.json")["length_unit"], "ft");
    EXPECT_LT(json("c.json")["mean_distance"], 1e-6);
  }
}

TEST_F(Compare, WritesAFileAndASummary) {
  const testing::Outcome outcome =
      run("ball.obj long.obj -o c.json --points 300 --samples 500 --summary s.json");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  auto summary = json("s.json");
  EXPECT_TRUE(summary.at("seconds").is_number());
  summary.erase("seconds");
  EXPECT_EQ(summary, json("c.json"));
}

TEST_F(Compare, JudgesWhetherASurfacePasses) {
  const auto same =
      compare("ball.obj bigger.obj --realism --json --places 1500 --unit km --floor")["realism"];
  EXPECT_TRUE(same["passes"]) << same.dump();
  EXPECT_EQ(same["words"][0], "passes");
  EXPECT_GT(same["floor"]["p"], 0.05);
  EXPECT_FALSE(compare("ball.obj bigger.obj").contains("realism"));
  EXPECT_EQ(compare("ball.obj bigger.obj --unit km")["length_unit"], "km");
}

TEST_F(Compare, SaysTheVerdictInTenLines) {
  const std::string line = "ball.obj bigger.obj --realism --places 500 --points 1000 --samples 1000";
  const testing::Outcome outcome = run(line + " -o c.json --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  EXPECT_LE(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 11) << outcome.output;
  for (const char* part :
       {"similarity", "surface: passes\n", "largest distance 0.", "relief over A's, by scale: "}) {
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\n" << outcome.output;
  }
  EXPECT_EQ(json("c.json")["realism"]["passes"], true);
  EXPECT_EQ(run(line + " --json -o c.json").output, "");
}

TEST_F(Compare, BadFilesAreRefused) {
  write("index.obj", testing::kTetrahedron + "f 1 2 5\n");
  write("flat.obj", testing::kFlatObj);
  for (const auto& [words, culprit] : {std::pair{"ball.obj index.obj", "index.obj"},
                                       {"index.obj ball.obj", "index.obj"},
                                       {"ball.obj absent.ply", "absent.ply"},
                                       {"ball.obj flat.obj", "flat.obj"},
                                       {"ball.obj long.obj -o ball.obj", "input itself"},
                                       {"ball.obj long.obj --samples 0", "--samples"}}) {
    refuse(words, culprit);
  }
}

}  // namespace
}  // namespace astrolith
