// compare: similarity, distances and the verdict on two surfaces.
#include "tasks/description/description_jobs.h"

#include "geometry/io/mesh_io.h"
#include "tests/support/meshes.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::ellipsoid_obj;
using testing::has;

class Compare : public testing::JobTest {
 protected:
  Compare() : JobTest("compare", declare_compare) {
    write("ball.obj", ellipsoid_obj(1, 1, 1, 47, 96));
    write("bigger.obj", ellipsoid_obj(1.1, 1.1, 1.1, 47, 96));
    write("long.obj", ellipsoid_obj(3, 1, 1, 47, 96));
  }
  nlohmann::json compare(const std::string& line) {
    const testing::Outcome outcome = run(line + " --points 1000 --samples 5000");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
};

TEST_F(Compare, SpheresOfTwoSizesAreAlikeAndApart) {
  const auto same = compare("ball.obj bigger.obj");
  EXPECT_GT(same["similarity"], 0.9);
  EXPECT_GT(same["similarity_floor"]["a"], 0.9);
  EXPECT_GT(same["similarity_floor"]["b"], 0.9);
  const double diagonal = same["in_units_of_the_files"]["diagonal_of_a"];
  EXPECT_NEAR(diagonal, std::sqrt(12.0), 0.01);
  for (const char* figure : {"mean", "p99", "max"}) {
    EXPECT_NEAR(same[std::string(figure) + "_distance"].get<double>() * diagonal, 0.1, 0.003);
    for (const char* way : {"both", "from_a_to_b", "from_b_to_a"})
      EXPECT_NEAR(same["in_units_of_the_files"][way][figure], 0.1, 0.003);
  }
  const auto other = compare("ball.obj long.obj --threads 1");
  EXPECT_EQ(other, compare("ball.obj long.obj --threads 2"));
  EXPECT_LT(other["similarity"], 0.5);
  for (const char* distance : {"l2", "chi_square", "jensen_shannon", "earth_movers"})
    EXPECT_GT(other[distance], 2 * same[distance].get<double>()) << distance;
  EXPECT_NEAR(other["in_units_of_the_files"]["from_b_to_a"]["max"], 2, 0.02);
}

// A rough ball is nearly as like itself with sixteen times the triangles as two samplings of it are. A ball
// whose hills stand elsewhere is not.
TEST_F(Compare, OneSurfaceIsAlikeAtAnyResolution) {
  const auto rough = [&](int level, double phase) {
    TriangleMesh ball = testing::icosphere(level);
    for (Vec3d& p : ball.vertices)
      p *= 1.0 + 0.03 * std::sin(19 * p.x + phase) * std::sin(17 * p.y) + 0.05 * std::sin(5 * p.z + phase);
    return ball;
  };
  write_mesh(rough(4, 0.0), folder_ / "coarse.ply", {});
  write_mesh(rough(6, 0.0), folder_ / "fine.ply", {});
  write_mesh(rough(6, 2.0), folder_ / "other.ply", {});
  const auto below_floor = [&](const std::string& line) {
    const auto figures = nlohmann::json::parse(run(line + " --points 3000 --samples 500").output);
    return figures["similarity_floor"]["a"].get<double>() - figures["similarity"].get<double>();
  };
  const double same = below_floor("coarse.ply fine.ply"), other = below_floor("coarse.ply other.ply");
  EXPECT_LT(same, 0.03);
  EXPECT_GT(other, same + 0.02);
}

// One surface, however its facets are wound, and whether they share vertices.
TEST_F(Compare, WindingAndWeldsMakeNoDifference) {
  const TriangleMesh body = testing::subdivided(testing::torus(1.0, 0.4));
  TriangleMesh tenth = body, soup;
  for (std::size_t f = 0; f < tenth.triangles.size(); f += 10) {
    std::swap(tenth.triangles[f][1], tenth.triangles[f][2]);
  }
  for (const Triangle& t : body.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(body.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  write_mesh(body, folder_ / "body.obj", {});
  write_mesh(testing::reversed(body), folder_ / "inside_out.obj", {});
  write_mesh(tenth, folder_ / "tenth.obj", {});
  write_mesh(soup, folder_ / "soup.obj", {});
  for (const auto& [file, words] :
       testing::Refusals{{"inside_out.obj", "turned 9216 facets"},
                         {"tenth.obj", "turned 922 facets"},
                         {"soup.obj", "merged 23040 repeated or unused vertices"}}) {
    EXPECT_TRUE(has(succeed("body.obj " + file + " -o c.json --points 1000 --samples 5000"), words)) << file;
    EXPECT_GT(json("c.json")["similarity"], 0.94) << file;  // of two samplings of 1,000 points
  }
}

TEST_F(Compare, BringsBothToOneUnit) {
  write("km.obj", "# length unit: km\n" + ellipsoid_obj(1, 1, 1, 47, 96));
  write("m.obj", "# length unit: m\n" + ellipsoid_obj(1000, 1000, 1000, 47, 96));
  const auto same = compare("km.obj m.obj");
  EXPECT_EQ(same["length_unit"], "km");
  EXPECT_LT(same["mean_distance"], 1e-6);
  EXPECT_GT(compare("ball.obj m.obj")["mean_distance"], 1.0);
  EXPECT_TRUE(has(succeed("km.obj m.obj --points 300 --samples 500 --realism --places 300"),
                  "m.obj: from m to km, the unit of km.obj"));
}

TEST_F(Compare, SaysTheFactorOfSizes) {
  write("small.obj", testing::ellipsoid_obj(1, 2, 3, 15, 30));
  write("metres.obj", testing::ellipsoid_obj(1000, 2000, 3000, 15, 30));
  const std::string options = " -o c.json --points 300 --samples 500";
  EXPECT_TRUE(
      has(succeed("small.obj metres.obj" + options),
          "note: metres.obj: its length is 1000 times that of small.obj, as of meshes in metres and in "
          "kilometres; scale one"));
  EXPECT_TRUE(has(succeed("metres.obj small.obj" + options), "its length is 0.001 times that of metres.obj"));
}

TEST_F(Compare, ScalesNothingWhereAUnitIsUnknown) {
  for (const std::string unit : {"m", "ft", "km"})
    write(unit + ".obj", "# length unit: " + unit + "\n" + ellipsoid_obj(1, 1, 1, 47, 96));
  for (const std::string other : {"m.obj", "km.obj"}) {
    const std::string said = succeed("ft.obj " + other + " -o c.json --points 300 --samples 500");
    EXPECT_TRUE(has(said, "note: " + other + ": is in "));
    EXPECT_TRUE(has(said, ", and ft.obj in ft; nothing was scaled"));
    EXPECT_EQ(json("c.json")["length_unit"], "ft");
    EXPECT_LT(json("c.json")["mean_distance"], 1e-6);
  }
}

// A body without symmetry, turned by 169 degrees about an oblique axis and shifted. Its own motion undoes
// this.
TEST_F(Compare, MovesAndTurnsOneBodyOntoTheOther) {
  TriangleMesh body = testing::icosphere(4);
  for (Vec3d& p : body.vertices) p = {3.0 * p.x, 2.0 * p.y * (1.0 + 0.2 * p.x), p.z + 0.3 * p.x * p.x};
  write_mesh(body, folder_ / "body.ply", {});
  const auto turn = [](const Vec3d& p) {  // rows of thirds: a rotation
    return Vec3d{(-2 * p.x + p.y + 2 * p.z) / 3, (p.x - 2 * p.y + 2 * p.z) / 3,
                 (2 * p.x + 2 * p.y + p.z) / 3};
  };
  TriangleMesh other = body;
  for (Vec3d& p : other.vertices) p = turn(p) + Vec3d{20, -5, 7};
  write_mesh(other, folder_ / "other.ply", {});
  const auto apart = compare("body.ply other.ply"), aligned = compare("body.ply other.ply --align");
  EXPECT_GT(apart["mean_distance"], 1.0);
  EXPECT_LT(aligned["max_distance"], 1e-5);
  EXPECT_EQ(aligned["similarity"], apart["similarity"]);
  EXPECT_FALSE(apart.contains("alignment"));
  const auto& rows = aligned["alignment"]["rotation"];
  EXPECT_NEAR(rows[0][0], -2.0 / 3, 1e-5);
  EXPECT_NEAR(rows[2][1], 2.0 / 3, 1e-5);
  EXPECT_LT(compare("ball.obj ball.obj --align")["max_distance"], 1e-6);
}

TEST_F(Compare, WritesAFileAndASummary) {
  auto summary = figures("ball.obj long.obj -o c.json --points 300 --samples 500");
  EXPECT_TRUE(summary.at("seconds").is_number());
  summary.erase("seconds");
  EXPECT_EQ(summary, json("c.json"));
}

TEST_F(Compare, JudgesWhetherASurfacePassesAndSaysItInTenLines) {
  const auto same =
      compare("ball.obj bigger.obj --realism --json --places 1500 --unit km --floor")["realism"];
  EXPECT_TRUE(same["passes"]) << same.dump();
  EXPECT_EQ(same["words"][0], "passes");
  EXPECT_GT(same["floor"]["p"], 0.05);
  const auto without = compare("ball.obj bigger.obj --unit km");
  EXPECT_FALSE(without.contains("realism"));
  EXPECT_EQ(without["length_unit"], "km");

  const std::string line = "ball.obj bigger.obj --realism --places 500 --points 1000 --samples 1000";
  const testing::Outcome outcome = run(line + " -o c.json --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  EXPECT_LE(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 11) << outcome.output;
  for (const char* part :
       {"similarity", "surface: passes\n", "largest distance 0.", "relief over A's, by scale: "})
    EXPECT_TRUE(has(outcome.output, part));
  EXPECT_EQ(json("c.json")["realism"]["passes"], true);
  EXPECT_EQ(run(line + " --json -o c.json").output, "");
}

TEST_F(Compare, BadFilesAreRefused) {
  write("index.obj", testing::kTetrahedron + "f 1 2 5\n");
  write("flat.obj", testing::kFlatObj);
  refuse_all("", {{"ball.obj index.obj", "index.obj"},
                  {"index.obj ball.obj", "index.obj"},
                  {"ball.obj absent.ply", "absent.ply"},
                  {"ball.obj flat.obj", "flat.obj"},
                  {"ball.obj long.obj --samples 0", "--samples"}});
}

}  // namespace
}  // namespace astrolith
