// gravity: of bodies and points, of parts of other densities, and landing sites.
#include "tasks/gravity/gravity_job.h"

#include <algorithm>
#include <cstring>
#include <numbers>
#include <sstream>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "tests/support/meshes.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::ellipsoid_obj;
using testing::has;
using testing::Outcome;

constexpr double kConstant = 6.67430e-11;

// ball.obj has radius 1.
class Gravity : public testing::JobTest {
 protected:
  Gravity() : JobTest("gravity", declare_gravity) { write("ball.obj", ellipsoid_obj(1, 1, 1, 31, 64)); }

  nlohmann::json gravity(const std::string& line) {
    const Outcome outcome = run(line + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
  std::vector<std::vector<double>> read_rows(const std::string& name) {
    std::istringstream table(text(name));
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(table, line);
    while (std::getline(table, line)) {
      rows.emplace_back();
      std::istringstream words(line);
      for (std::string word; std::getline(words, word, ',');) rows.back().push_back(std::stod(word));
    }
    return rows;
  }
};

TEST_F(Gravity, AsksBackWhereItMayBeMistaken) {
  write_mesh(testing::two_spheres(2, 1, 2.5), folder_ / "two.ply", {});
  write("metres.obj", ellipsoid_obj(2000, 2000, 1500, 31, 64));
  write("bennu_v20.obj", ellipsoid_obj(280, 270, 250, 31, 64));
  write("rock.obj", "# Units: mm\n" + ellipsoid_obj(40, 30, 30, 31, 64));
  write("long.obj", ellipsoid_obj(160, 150, 140, 31, 64));
  write("huge.obj", ellipsoid_obj(2e9, 2e9, 2e9, 31, 64));
  EXPECT_EQ(run("ball.obj --density 2670 --unit km").errors, "");
  EXPECT_EQ(run("rock.obj --density 2670").errors, "");
  EXPECT_EQ(run("long.obj --density 2670 --unit km").errors, "");
  EXPECT_EQ(run("metres.obj --density 2000 --unit m").errors, "");
  for (const auto& [line, words] : testing::Refusals{
           {"ball.obj --density 2.67",
            "a density of 2.67 kg/m^3 is that of no solid; for 2.67 g/cm^3 give 2670"},
           {"two.ply --density 2000", "two.ply: holds 2 bodies apart from one another, the largest is taken"},
           {"two.ply --density 2000 --all-parts",
            "two.ply: holds 2 bodies apart from one another, all are taken"},
           {"metres.obj --density 2000",
            "note: metres.obj: a mean radius of 1815 km is above that of any asteroid or comet; is --unit "
            "km"},
           {"ball.obj --density 2670",
            "note: ball.obj: states no unit and is taken in km; --unit says another"},
           {"long.obj --density 2000",
            "is taken in km, which makes its mean radius 149.6 km; in m it is 149.6 m: add --unit m or "
            "--unit km"},
           {"huge.obj --density 2000 --unit mm", "above that of any asteroid or comet; is --unit mm right"},
           {"bennu_v20.obj --density 1190", "km is not that of bennu (0.245 km); is --unit km"}})
    EXPECT_TRUE(has(succeed(line), words));
}

TEST_F(Gravity, TakesTheUnitThatAFileStates) {
  const auto compute_mass = [&](const std::string& line) {
    return gravity(line + " --density 2000 --degree 0")["body"]["mass_kg"].get<double>();
  };
  const double mass = compute_mass("ball.obj");
  write("metres.obj", "# length unit: m\n" + ellipsoid_obj(1000, 1000, 1000, 31, 64));
  EXPECT_NEAR(compute_mass("metres.obj"), mass, 1e-6 * mass);
  EXPECT_EQ(run("metres.obj --density 2000 --degree 0 --unit m").errors, "");
  const Outcome other = run("metres.obj --density 2000 --degree 0 --unit cm --json");
  EXPECT_TRUE(has(other.errors, "note: metres.obj: states its unit as m; taken in cm, as --unit says"));
  EXPECT_NEAR(nlohmann::json::parse(other.output)["body"]["mass_kg"].get<double>() * 1e6, mass, 1e-6 * mass);
  write("feet.obj", "# length unit: ft\n" + ellipsoid_obj(1, 1, 1, 31, 64));
  refuse("feet.obj --density 2000", "feet.obj: states its unit as ft, which is none of m, km, cm, mm");
  write("core.obj", ellipsoid_obj(500, 500, 500, 31, 64));  // states none: in the body's
  EXPECT_NEAR(
      gravity("metres.obj --density 2000 --density-of core.obj=4000")["body"]["mass_kg"].get<double>(),
      1.125 * mass, 1e-3 * mass);
}

// A ball of 1 km, 2,000 kg/m3: mass and fields within the error of its polyhedron.
TEST_F(Gravity, OfABallThatTurns) {
  const double period = 5.0, turn = 2 * std::numbers::pi / (3600 * period), density = 2000.0;
  const auto result = gravity("ball.obj --density 2000 --period 5 -o b.csv");
  const double mass = density * 4e9 * std::numbers::pi / 3;
  EXPECT_NEAR(result["body"]["mass_kg"].get<double>() / mass, 1, 0.01);
  EXPECT_NEAR(result["values"]["potential_J_kg"]["mean"].get<double>() / (-kConstant * mass / 1000), 1, 0.01);
  EXPECT_NEAR(result["values"]["escape_speed_m_s"]["mean"].get<double>(),
              std::sqrt(2 * kConstant * mass / 1000), 0.01);
  EXPECT_LE(result["achieved_error"]["largest"].get<double>(), 1e-6);
  EXPECT_NEAR(result["values"]["elevation_m"]["mean"].get<double>(), 0, 1e-9);
  const auto rows = read_rows("b.csv");
  ASSERT_EQ(rows.size(), result["facets"].get<std::size_t>());
  ASSERT_EQ(rows[0].size(), 11u);
  for (const auto& row : rows) {
    const double s = 1000 * std::hypot(row[0], row[1]);
    EXPECT_NEAR(row[7] - row[3], -0.5 * turn * turn * s * s, 1e-12);
    // On a ball the effective gravity leans towards the equator.
    const double g = kConstant * mass / 1e6, z = row[2] / std::hypot(row[0], row[1], row[2]);
    const double lean = turn * turn * 1000 * std::sqrt(1 - z * z) * z;
    const double slope =
        std::atan2(std::fabs(lean), g - turn * turn * 1000 * (1 - z * z)) * 180 / std::numbers::pi;
    EXPECT_NEAR(row[9], slope, 1.5);
  }
}

// A point far away, one at the centre, one on a vertex.
TEST_F(Gravity, AtPointsOfAFile) {
  write("p.csv", "x,y,z\n# far\n30,0,40\n\n0 0 0\n0, 0, 1\n");
  const auto result = gravity("ball.obj --density 1000 --unit m --points p.csv -o p_out.csv");
  const double mass = result["body"]["mass_kg"].get<double>();
  const auto rows = read_rows("p_out.csv");
  ASSERT_EQ(rows.size(), 3u);
  ASSERT_EQ(rows[0].size(), 9u);
  EXPECT_NEAR(rows[0][3] / (-kConstant * mass / 50), 1, 1e-4);
  EXPECT_NEAR(rows[0][4] / (-kConstant * mass / 2500 * 0.6), 1, 1e-3);
  EXPECT_NEAR(rows[1][3] / (-1.5 * kConstant * mass), 1, 0.01);
  EXPECT_NEAR(rows[2][8] / (kConstant * mass), 1, 0.01);
}

// Columns have names, and lengths a unit of their own.
TEST_F(Gravity, AtPointsOfNamedColumns) {
  write("named.csv", "id,x_km,y_km,z_km\n7,0.03,0,0.04\n8,0,0,0.001\n");
  write("plain.csv", "30 0 40\n0 0 1\n");
  write("wide.csv", "7,30,0,40\n");
  const std::string line = "ball.obj --density 1000 --unit m --points ";
  const std::string said = succeed(line + "named.csv -o named_out.csv");
  EXPECT_TRUE(
      has(said, "note: named.csv: columns 'x_km', 'y_km', 'z_km' are taken as x, y, z in km; left out: 'id'"))
      << said;
  succeed(line + "plain.csv -o plain_out.csv");
  const auto named = read_rows("named_out.csv"), plain = read_rows("plain_out.csv");
  ASSERT_EQ(named.size(), 2u);
  for (std::size_t k = 0; k < plain.size(); ++k) {
    for (std::size_t c = 0; c < 9; ++c) EXPECT_NEAR(named[k][c], plain[k][c], 1e-12 * std::fabs(plain[k][c]));
  }
  refuse(line + "wide.csv", "wide.csv: line 1: has 4 columns where 3 (x, y, z) are due; name the columns");
}

// A place 4.4e6 radii away has the gravity of a point, whatever stands beside it.
TEST_F(Gravity, OfAFarPlaceBesideANearOne) {
  write("both.txt", "1.5 0 0\n4400000 0 0\n");
  write("far.txt", "4400000 0 0\n");
  for (const std::string how : {"", " --exact"}) {
    const auto both = gravity("ball.obj --density 2000 --points both.txt -o both.csv" + how),
               alone = gravity("ball.obj --density 2000 --points far.txt -o far.csv" + how);
    const double truth = kConstant * both["body"]["mass_kg"].get<double>() / (4.4e9 * 4.4e9);
    EXPECT_NEAR(read_rows("both.csv")[1][8] / truth, 1.0, 1e-8);
    EXPECT_EQ(text("both.csv").substr(text("both.csv").find("\n4400000,")),
              text("far.csv").substr(text("far.csv").find("\n4400000,")));
    EXPECT_LE(alone["achieved_error"]["largest"], 1e-14);
    EXPECT_GT(both["achieved_error"]["largest"], 1e-16);
    EXPECT_LE(both["achieved_error"]["largest"], 1e-8);
    EXPECT_EQ(both["achieved_error"]["sample"], 2);
  }
}

TEST_F(Gravity, WritesValuesOfVerticesThatReadersSkip) {
  write("rod.obj", ellipsoid_obj(3, 0.5, 0.4, 31, 64));  // most of its picture is sky
  const auto result =
      gravity("rod.obj --density 1000 --at vertices -o v.ply --preview v.png --summary s.json");
  const TriangleMesh mesh = read_mesh(folder_ / "v.ply");
  EXPECT_EQ(mesh.vertices.size(), result["count"]);
  EXPECT_EQ(mesh.triangles.size(), result["facets"]);
  const std::string bytes = text("v.ply");
  for (const std::string name : {"potential_J_kg", "slope_deg", "elevation_m"}) {
    EXPECT_NE(bytes.find("property float " + name + "\n"), std::string::npos) << name;
  }
  // Nine floats a vertex before the slope: three of the place and six of gravity.
  const std::size_t start = bytes.find("end_header\n") + 11;
  float potential = 0;
  std::memcpy(&potential, bytes.data() + start + 12, sizeof potential);
  EXPECT_GE(potential, result["values"]["potential_J_kg"]["min"]);
  EXPECT_LE(potential, result["values"]["potential_J_kg"]["max"]);
  EXPECT_EQ(text("v.png").substr(1, 3), "PNG");
  EXPECT_EQ(json("s.json")["values"], result["values"]);
  gravity("rod.obj --density 1000 -o v.npy");
  EXPECT_NE(text("v.npy").find("'shape': (" + std::to_string(mesh.triangles.size()) + ", 11)"),
            std::string::npos);
}

// A .vtp has the values of facets, or of vertices, as doubles behind its header.
TEST_F(Gravity, WritesVtpOfFacetsAndVertices) {
  write("rod.obj", ellipsoid_obj(3, 0.5, 0.4, 9, 12));
  for (const std::string at : {"facets", "vertices"}) {
    gravity("rod.obj --density 1000 --at " + at + " -o v.vtp");
    gravity("rod.obj --density 1000 --at " + at + " -o v.csv");
    const std::string bytes = text("v.vtp"), table = text("v.csv");
    EXPECT_EQ(has(bytes, "<CellData>"), at == "facets");
    EXPECT_EQ(has(bytes, "<PointData>"), at == "vertices");
    const std::string mark = R"(Name="potential_J_kg" NumberOfComponents="1" format="appended" offset=")";
    const std::size_t offset = std::stoull(bytes.substr(bytes.find(mark) + mark.size()));
    const char* const array = bytes.data() + bytes.find("<AppendedData encoding=\"raw\">\n_") + 31 + offset;
    std::uint64_t length = 0;
    double first = 0.0;
    std::memcpy(&length, array, sizeof length);
    std::memcpy(&first, array + sizeof length, sizeof first);
    EXPECT_EQ(length / sizeof(double), std::count(table.begin(), table.end(), '\n') - 1);
    std::istringstream row(table.substr(table.find('\n') + 1));  // x, y, z, potential
    std::string cell;
    for (int k = 0; k < 4; ++k) std::getline(row, cell, ',');
    EXPECT_EQ(first, std::stod(cell));
  }
  EXPECT_EQ(run("rod.obj --density 1000 --points rod.obj -o v.vtp").status, 2);
}

// Both files hold the coefficients of the figures, as ICGEM and the Planetary Data System state them.
TEST_F(Gravity, WritesHarmonicsForOtherPrograms) {
  write("rod.obj", ellipsoid_obj(3, 0.5, 0.4, 9, 12));
  const auto figures = gravity("rod.obj --density 1000 --degree 3 --harmonics rod.gfc");
  gravity("rod.obj --density 1000 --degree 3 --harmonics rod.sha");
  const std::string gfc = text("rod.gfc");
  std::string shadr = text("rod.sha");
  EXPECT_TRUE(has(gfc, "modelname rod\n") && has(gfc, "max_degree 3\n") &&
              has(gfc, "norm fully_normalized\n"));
  const double gm = 6.67430e-11 * figures["body"]["mass_kg"].get<double>();
  EXPECT_NEAR(std::stod(gfc.substr(gfc.find("earth_gravity_constant ") + 23)) / gm, 1.0, 1e-15);
  std::replace(shadr.begin(), shadr.end(), ',', ' ');
  std::istringstream lines(gfc.substr(gfc.find("end_of_head\n") + 12)), table(shadr);
  double radius_km = 0.0, gm_km = 0.0, skipped = 0.0;
  table >> radius_km >> gm_km;
  for (int k = 0; k < 6; ++k) table >> skipped;
  EXPECT_NEAR(radius_km, figures["harmonics"]["reference_radius_m"].get<double>() / 1e3, 1e-12);
  EXPECT_NEAR(gm_km / gm, 1e-9, 1e-24);
  for (const auto& row : figures["harmonics"]["degree_order_c_s"]) {
    std::string key;
    int l = 0, m = 0;
    double c = 0.0, s = 0.0;
    ASSERT_TRUE(lines >> key >> l >> m >> c >> s);
    EXPECT_TRUE(l == row[0] && m == row[1] && c == row[2] && s == row[3]);
    if (l == 0) continue;
    ASSERT_TRUE(table >> l >> m >> c >> s >> skipped >> skipped);
    EXPECT_TRUE(l == row[0] && m == row[1] && c == row[2] && s == row[3]);
  }
  EXPECT_EQ(run("rod.obj --density 1000 --harmonics rod.txt").status, 2);
}

TEST_F(Gravity, TellsAPersonTenLines) {
  const Outcome outcome = run("ball.obj --density 2000 --period 5 --summary s.json --quiet");
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 10) << outcome.output;
  for (const char* part : {"mass 8.3", " kg at 2000 kg/m3", "turns once in 5 h", "facets (", "slope ",
                           "--json prints all figures\n"}) {
    EXPECT_TRUE(has(outcome.output, part)) << outcome.output;
  }
  nlohmann::json summary = json("s.json");
  summary.erase("seconds");
  EXPECT_EQ(summary, gravity("ball.obj --density 2000 --period 5"));
  write("p.csv", "0 0 3\n");
  const std::string at_points = run("ball.obj --density 2000 --points p.csv --sample 0").output;
  EXPECT_TRUE(has(at_points, "; at rest\n") && has(at_points, "points (1):\n")) << at_points;
  EXPECT_FALSE(has(at_points, "slope")) << at_points;
}

TEST_F(Gravity, OfARecipe) {
  write("r.json", R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres":
                 [[0, 0, 0, 10]]}})");
  EXPECT_EQ(gravity("r.json --density 2000 --resolution 24")["unit"], "m");
}

TEST_F(Gravity, SameOutputForAnyThreadCount) {
  gravity("ball.obj --density 2000 --period 5 -o a.csv --threads 1");
  gravity("ball.obj --density 2000 --period 5 -o b.csv --threads 2");
  EXPECT_EQ(text("a.csv"), text("b.csv"));
}

// The places of an OBJ's vertices, scaled and shifted.
std::string moved_obj(const std::string& obj, double scale, double x) {
  std::istringstream lines(obj);
  std::ostringstream text;
  text.precision(17);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    double p[3];
    if (words >> kind && kind == "v" && words >> p[0] >> p[1] >> p[2]) {
      text << "v " << scale * p[0] + x << " " << scale * p[1] << " " << scale * p[2] << "\n";
    } else {
      text << line << "\n";
    }
  }
  return text.str();
}

// A ball of 1 km and 2,000 kg/m3 with a ball of 0.3 km and 5,000 kg/m3 at x = 0.5 km, and a hollow of 0.2 km
// at x = -0.6 km. Mass, centre, moments, coefficients and fields are those of balls.
TEST_F(Gravity, PartsOfOtherDensities) {
  const std::string fine = ellipsoid_obj(1, 1, 1, 61, 120);
  write("fine.obj", fine);
  write("heavy.obj", moved_obj(fine, 0.3, 0.5));
  write("hollow.obj", moved_obj(fine, 0.2, -0.6));
  write("p.csv", "30 0 40\n0.5 0 0\n-0.6 0 0\n0 3 0\n");
  const auto result = gravity(
      "fine.obj --density 2000 --density-of heavy.obj=5000,hollow.obj=0 --points p.csv --degree 2 -o o.csv");
  struct Ball {
    double radius, x, surplus;
  };
  const Ball balls[] = {{1000, 0, 2000}, {300, 500, 3000}, {200, -600, -2000}};
  double mass = 0, first = 0, about_x = 0, about_z = 0;
  for (const Ball& b : balls) mass += b.surplus * 4 * std::numbers::pi / 3 * std::pow(b.radius, 3);
  for (const Ball& b : balls) first += b.surplus * 4 * std::numbers::pi / 3 * std::pow(b.radius, 3) * b.x;
  const double center = first / mass;
  for (const Ball& b : balls) {
    const double own = b.surplus * 4 * std::numbers::pi / 3 * std::pow(b.radius, 3);
    about_x += 0.4 * own * b.radius * b.radius;
    about_z += 0.4 * own * b.radius * b.radius + own * (b.x - center) * (b.x - center);
  }
  EXPECT_NEAR(result["body"]["mass_kg"].get<double>() / mass, 1, 3e-3);
  EXPECT_NEAR(result["body"]["volume_m3"].get<double>() / (4e9 * std::numbers::pi / 3), 1, 3e-3);
  EXPECT_NEAR(result["body"]["center_of_mass_m"][0].get<double>(), center, 0.02);
  EXPECT_NEAR(result["body"]["inertia_kg_m2"][0][0].get<double>() / about_x, 1, 4e-3);
  EXPECT_NEAR(result["body"]["inertia_kg_m2"][2][2].get<double>() / about_z, 1, 4e-3);
  EXPECT_EQ(result["parts"].size(), 2u);
  // C_20 sqrt(5) = (A + B - 2 C) / (2 M a^2) with moments A, B and C about x, y and z (MacCullagh).
  const double a = result["harmonics"]["reference_radius_m"].get<double>();
  const auto moment = [&](std::size_t i) { return result["body"]["inertia_kg_m2"][i][i].get<double>(); };
  const double c20 = (moment(0) + moment(1) - 2 * moment(2)) /
                     (2 * std::sqrt(5.0) * result["body"]["mass_kg"].get<double>() * a * a);
  for (const auto& row : result["harmonics"]["degree_order_c_s"]) {
    const int degree = row[0].get<int>(), order = row[1].get<int>();
    if (degree == 2 && order > 0) continue;
    EXPECT_NEAR(row[2].get<double>(), degree == 0 ? 1.0 : degree == 1 ? 0.0 : c20, 1e-12) << degree;
  }
  const auto rows = read_rows("o.csv");
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) {
    double potential = 0;
    for (const Ball& b : balls) {
      const double r = 1000 * std::hypot(row[0] - b.x / 1000, row[1], row[2]), s = b.radius;
      potential -= kConstant * b.surplus * 4 * std::numbers::pi / 3 *
                   (r > s ? s * s * s / r : (3 * s * s - r * r) / 2);
    }
    EXPECT_NEAR(row[3] / potential, 1, 3e-3) << row[0];
  }
}

// A ball that lacks a facet, one whose facets look inwards, and the ball itself have one mass.
TEST_F(Gravity, DamagedMeshesAreRepaired) {
  const std::string ball = ellipsoid_obj(1, 1, 1, 24, 36);
  write("whole.obj", ball);
  write("holed.obj", ball.substr(0, ball.rfind("f ")));
  const auto mass = [&](const std::string& file, const std::string& words) {
    const Outcome outcome = run(file + " --density 2000 --sample 0 --degree 0 --json");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(has(outcome.errors, words));
    return nlohmann::json::parse(outcome.output)["body"]["mass_kg"].get<double>();
  };
  const double whole = mass("whole.obj", "");
  EXPECT_NEAR(mass("holed.obj", "holed.obj: filled 1 hole (largest"), whole, 1e-9 * whole);
  // Facets that are there twice, in the same sense or in both.
  const std::string faces = ball.substr(ball.find("f "));
  write("doubled.obj", ball + faces);
  EXPECT_NEAR(mass("doubled.obj", "dropped"), whole, 1e-9 * whole);
  std::string turned;
  std::istringstream lines(faces);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(2));
    std::string first, others;
    words >> first;
    for (std::string corner; words >> corner;) others = " " + corner + others;
    turned += "f " + first + others + "\n";  // quads have the same diagonals
  }
  write("two_sided.obj", ball + turned);
  EXPECT_NEAR(mass("two_sided.obj", "dropped"), whole, 1e-9 * whole);
  refuse("holed.obj --density 2000 --strict", "holed.obj");
}

// Two balls of radius 1 whose centres are 1 apart, and a core inside a ball.
TEST_F(Gravity, PartsThatOverlapAreSaidAndUnited) {
  write_mesh(testing::two_spheres(4, 1, 1), folder_ / "lobes.ply", {});
  write_mesh(testing::joined(testing::icosphere(3), testing::icosphere(2, 0.5)), folder_ / "core.ply", {});
  EXPECT_TRUE(
      has(succeed("lobes.ply --density 2000"), "1 part reaches into a larger one: rock counts twice"));
  EXPECT_TRUE(
      has(succeed("core.ply --density 2000"), "1 part lies in the rock of a larger one: rock counts"));
  const double ball = gravity("core.ply --density 2000 --union")["body"]["volume_m3"];
  EXPECT_NEAR(ball / (1e9 * volume(testing::icosphere(3))), 1.0, 1e-7);  // the file has floats
  const double both = gravity("lobes.ply --density 2000")["body"]["volume_m3"];
  const nlohmann::json united = gravity("lobes.ply --density 2000 --union");
  EXPECT_NEAR(united["body"]["volume_m3"].get<double>() / both, 27.0 / 32.0,
              2e-3);  // of the balls themselves
}

// Its mesh would have coordinates of few digits otherwise.
TEST_F(Gravity, ARecipeWithAnOriginGivesItsFrameBack) {
  write("far.json", R"({"format_version": 1, "length_unit": "km", "origin": [16.5, 0, -2], "body":
    {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 0.03]]}})");
  write("place.csv", "16.6 0 -2\n");
  const nlohmann::json figures =
      gravity("far.json --density 2000 --resolution 32 --points place.csv -o g.csv");
  EXPECT_NEAR(figures["body"]["center_of_mass_m"][0], 16500.0, 0.01);
  EXPECT_NEAR(figures["body"]["center_of_mass_m"][2], -2000.0, 0.01);
  const double mass = figures["body"]["mass_kg"];
  EXPECT_NEAR(read_rows("g.csv")[0][3] / (-kConstant * mass / 100.0), 1.0, 1e-3);
}

TEST_F(Gravity, BadInputIsRefused) {
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("empty.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  write("turned.obj", testing::kInsideOut);
  write("beside.obj", moved_obj(ellipsoid_obj(1, 1, 1, 9, 12), 1.0, 0.5));
  write("nan.csv", "1 2 3\n1 nan 3\n");
  write("few.csv", "1 2 3\n1 2\n");
  write("none.csv", "# nothing\n");
  refuse("ball.obj", "--density");
  refuse_all("ball.obj --density ", {{"0", "--density"}, {"-5", "--density"}, {"nan", "--density"}});
  refuse_all("--density 2000 ", {{"ball.obj --period 0", "--period"},
                                 {"ball.obj --period -3", "--period"},
                                 {"ball.obj --axis 0 0 0", "--axis"},
                                 {"ball.obj -o x.ply", "--at vertices"},
                                 {"ball.obj -o x.obj", "x.obj"},
                                 {"open.obj", "open.obj"},
                                 {"empty.obj", "empty.obj"},
                                 {"turned.obj --strict", "turned.obj"},
                                 {"turned.obj --strict --wrap", "--wrap"},
                                 {"ball.obj --density-of ball.obj", "--density-of"},
                                 {"ball.obj --density-of ball.obj=-1", "0 to 1e6"},
                                 {"ball.obj --density-of ball.obj=1e3x", "0 to 1e6"},
                                 {"ball.obj --density-of open.obj=1000", "open.obj"},
                                 {"ball.obj --density-of ball.obj=0", "no mass"},
                                 {"ball.obj --density-of beside.obj=1000", "leaves the body"},
                                 {"ball.obj --points nan.csv", "nan.csv: line 2"},
                                 {"ball.obj --points few.csv", "few.csv: line 2"},
                                 {"ball.obj --points none.csv", "none.csv"}});
}

TEST_F(Gravity, SitesOfABodyThatTurnsTooFast) {
  const std::string said = succeed("ball.obj --density 2000 --period 1 --sites 3 --site-size 0.4");
  EXPECT_TRUE(has(said, "note: slopes exceed 90 degrees on ")) << said;
  EXPECT_TRUE(has(said, "% of the ground: at this period nothing stays there")) << said;
}

// A ball at rest is level everywhere, but its ground below z = .4 is wavy here. A square of side L on a ball
// has a roughness of sqrt(8 / 45) (L / 2)^2 / (2 R): heights are -(x^2 + y^2) / (2 R).
TEST_F(Gravity, SitesAreLevelGroundApartFromOneAnother) {
  TriangleMesh mesh = read_mesh(folder_ / "ball.obj");
  for (Vec3d& p : mesh.vertices) p *= p.z < 0.4 ? 1.0 + 0.02 * std::sin(20.0 * p.x) : 1.0;
  write_mesh(mesh, folder_ / "wavy.ply", {});
  const std::string line = "wavy.ply --density 2000 --sites 2 --site-size 0.4";
  const Outcome outcome = run(line + " --site-list s.csv --preview s.png --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto sites = nlohmann::json::parse(outcome.output)["sites"];
  ASSERT_EQ(sites.size(), 2u);
  std::vector<Vec3d> centers;
  for (const auto& site : sites) {
    const Vec3d center{site["center"][0], site["center"][1], site["center"][2]};
    const Vec3d normal{site["normal"][0], site["normal"][1], site["normal"][2]};
    EXPECT_GT(dot(normal, normalized(center)), 0.99);
    EXPECT_GT(center.z, 0.4);
    EXPECT_NEAR(site["roughness_m"], 8.43, 0.3);
    EXPECT_LT(site["mean_slope_deg"], 1.5);  // of facets on a round body
    EXPECT_NEAR(site["latitude_deg"].get<double>(),
                180 / std::numbers::pi * std::asin(center.z / norm(center)), 1e-9);
    EXPECT_LE(site["mean_slope_deg"], site["largest_slope_deg"]);
    centers.push_back(center);
  }
  EXPECT_GE(norm(centers[0] - centers[1]), 0.8);
  EXPECT_EQ(read_rows("s.csv").size(), 2u);
  EXPECT_TRUE(has(outcome.errors, "site 1: slope "));
  EXPECT_TRUE(has(outcome.errors, "synth RECIPE.json --patch " + sites[0]["patch"].get<std::string>()));
  EXPECT_EQ(gravity(line + " --threads 1")["sites"], sites);
  EXPECT_TRUE(has(run(line + " --site-distance 5").errors, "the body has 1 sites"));
  refuse_all("wavy.ply --density 2000 ", {{"--sites 2", "--site-size"},
                                          {"--sites 2 --site-size 0.01", "is less than 4 edges"},
                                          {"--sites 2 --site-size 3", "more than a quarter"},
                                          {"--sites 0 --site-size 0.3", "--sites"},
                                          {"--sites 2 --site-size 0.3 --at vertices", "slopes of facets"},
                                          {"--site-size 0.3", "--sites"}});
}

}  // namespace
}  // namespace astrolith
