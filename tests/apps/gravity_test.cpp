// gravity, run as a user runs it.
#include <signal.h>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "geometry/io/mesh_io.h"
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

const std::string kGravity = ASTROLITH_GRAVITY;
constexpr double kConstant = 6.67430e-11;

class Gravity : public ::testing::Test {
 protected:
  nlohmann::json gravity(std::vector<std::string> arguments) {
    const Outcome outcome = run_program(kGravity, std::move(arguments));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
  std::vector<std::vector<double>> rows_of(const std::string& name) {
    std::istringstream text(text_of(folder_ / name));
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
      rows.emplace_back();
      std::istringstream words(line);
      for (std::string word; std::getline(words, word, ',');) rows.back().push_back(std::stod(word));
    }
    return rows;
  }

  WorkFolder folder_;
  const std::string ball_ = folder_.write("ball.obj", ellipsoid_obj(1, 1, 1, 31, 64));
};

// A ball of 1 km, 2,000 kg/m3: mass and fields within the error of its polyhedron.
TEST_F(Gravity, OfABallThatTurns) {
  const double period = 5.0, turn = 2 * std::numbers::pi / (3600 * period), density = 2000.0;
  const auto result =
      gravity({ball_, "--density", "2000", "--period", "5", "-o", (folder_ / "b.csv").string()});
  const double mass = density * 4e9 * std::numbers::pi / 3;
  EXPECT_NEAR(result["body"]["mass_kg"].get<double>() / mass, 1, 0.01);
  EXPECT_NEAR(result["values"]["potential_J_kg"]["mean"].get<double>() / (-kConstant * mass / 1000), 1, 0.01);
  EXPECT_NEAR(result["values"]["escape_speed_m_s"]["mean"].get<double>(),
              std::sqrt(2 * kConstant * mass / 1000), 0.01);
  EXPECT_LE(result["achieved_error"]["largest"].get<double>(), 1e-6);
  EXPECT_NEAR(result["values"]["elevation_m"]["mean"].get<double>(), 0, 1e-9);
  const auto rows = rows_of("b.csv");
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
  const std::string points = folder_.write("p.csv", "x,y,z\n# far\n30,0,40\n\n0 0 0\n0, 0, 1, top\n");
  const auto result = gravity({ball_, "--density", "1000", "--unit", "m", "--points", points, "-o",
                               (folder_ / "p_out.csv").string()});
  const double mass = result["body"]["mass_kg"].get<double>();
  const auto rows = rows_of("p_out.csv");
  ASSERT_EQ(rows.size(), 3u);
  ASSERT_EQ(rows[0].size(), 9u);
  EXPECT_NEAR(rows[0][3] / (-kConstant * mass / 50), 1, 1e-4);
  EXPECT_NEAR(rows[0][4] / (-kConstant * mass / 2500 * 0.6), 1, 1e-3);
  EXPECT_NEAR(rows[1][3] / (-1.5 * kConstant * mass), 1, 0.01);
  EXPECT_NEAR(rows[2][8] / (kConstant * mass), 1, 0.01);
}

TEST_F(Gravity, WritesValuesOfVerticesThatReadersSkip) {
  const std::string ply = (folder_ / "v.ply").string(), npy = (folder_ / "v.npy").string();
  const auto result = gravity({ball_, "--density", "1000", "--at", "vertices", "-o", ply, "--preview",
                               (folder_ / "v.png").string(), "--summary", (folder_ / "s.json").string()});
  const TriangleMesh mesh = read_mesh(ply);
  EXPECT_EQ(mesh.vertices.size(), result["count"].get<std::size_t>());
  EXPECT_EQ(mesh.triangles.size(), result["facets"].get<std::size_t>());
  const std::string text = text_of(ply);
  for (const char* name : {"potential_J_kg", "slope_deg", "elevation_m"}) {
    EXPECT_NE(text.find(std::string("property float ") + name + "\n"), std::string::npos) << name;
  }
  // Nine floats a vertex before the slope: three of the place and six of gravity.
  const std::size_t start = text.find("end_header\n") + 11;
  float potential = 0;
  std::memcpy(&potential, text.data() + start + 12, sizeof potential);
  EXPECT_NEAR(potential, result["values"]["potential_J_kg"]["mean"].get<double>(), 1e-3);
  EXPECT_EQ(text_of(folder_ / "v.png").substr(1, 3), "PNG");
  auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  EXPECT_EQ(summary["values"], result["values"]);
  gravity({ball_, "--density", "1000", "-o", npy});
  EXPECT_NE(text_of(npy).find("'shape': (" + std::to_string(mesh.triangles.size()) + ", 11)"),
            std::string::npos);
}

TEST_F(Gravity, OfARecipe) {
  const std::string recipe = folder_.write(
      "r.json", R"({"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres":
                 [[0, 0, 0, 10]]}})");
  const Outcome outcome = run_program(kGravity, {recipe, "--density", "2000", "--resolution", "24"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(nlohmann::json::parse(outcome.output)["unit"], "m");
}

TEST_F(Gravity, SameOutputForAnyThreadCount) {
  const std::string a = (folder_ / "a.csv").string(), b = (folder_ / "b.csv").string();
  gravity({ball_, "--density", "2000", "--period", "5", "-o", a, "--threads", "1"});
  gravity({ball_, "--density", "2000", "--period", "5", "-o", b, "--threads", "2"});
  EXPECT_EQ(text_of(a), text_of(b));
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
  const std::string ball = folder_.write("fine.obj", fine);
  const std::string heavy = folder_.write("heavy.obj", moved_obj(fine, 0.3, 0.5)),
                    hollow = folder_.write("hollow.obj", moved_obj(fine, 0.2, -0.6));
  const std::string points = folder_.write("p.csv", "30 0 40\n0.5 0 0\n-0.6 0 0\n0 3 0\n");
  const auto result = gravity({ball, "--density", "2000", "--density-of", heavy + "=5000," + hollow + "=0",
                               "--points", points, "--degree", "2", "-o", (folder_ / "o.csv").string()});
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
  const auto rows = rows_of("o.csv");
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

// Ctrl-C after the program has begun its longest work.
TEST_F(Gravity, CtrlCStopsItWithinASecondAndLeavesNoFile) {
  using Clock = std::chrono::steady_clock;
  const std::string fine = folder_.write("fine.obj", ellipsoid_obj(3, 2, 1, 101, 200));
  const std::string point = folder_.write("point.csv", "9 0 0\n");
  const std::set<std::string> before = folder_.files();
  const std::vector<std::string> harmonics{"--points", point, "--degree", "50"}, exact{"--exact"};
  for (const std::vector<std::string>& longest : {harmonics, exact}) {
    std::vector<std::string> words{kGravity,   fine, "--density", "2000", "-o", folder_ / "fine.csv",
                                   "--sample", "0",  "--quiet"};
    words.insert(words.end(), longest.begin(), longest.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    ASSERT_EQ(::posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ), 0);
    std::this_thread::sleep_for(std::chrono::seconds(4));
    ASSERT_EQ(::waitpid(child, nullptr, WNOHANG), 0) << longest[0] << " ended before it could be stopped";
    const auto pressed = Clock::now();
    ::kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - pressed).count(), 1.0) << longest[0];
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << longest[0];
    EXPECT_EQ(folder_.files(), before) << longest[0];
  }
}

TEST_F(Gravity, BadInputIsRefused) {
  const auto refuse = [&](std::vector<std::string> arguments, const std::string& culprit) {
    expect_refusal(folder_, kGravity, arguments, culprit);
  };
  refuse({ball_}, "--density");
  refuse({ball_, "--density", "0"}, "--density");
  refuse({ball_, "--density", "-5"}, "--density");
  refuse({ball_, "--density", "nan"}, "--density");
  refuse({ball_, "--density", "2000", "--period", "0"}, "--period");
  refuse({ball_, "--density", "2000", "--period", "-3"}, "--period");
  refuse({ball_, "--density", "2000", "--axis", "0", "0", "0"}, "--axis");
  refuse({ball_, "--density", "2000", "-o", (folder_ / "x.ply").string()}, "--at vertices");
  refuse({ball_, "--density", "2000", "-o", (folder_ / "x.obj").string()}, "x.obj");
  refuse({ball_, "--density", "2000", "-o", ball_}, "ball.obj");
  const std::string open = folder_.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refuse({open, "--density", "2000"}, "open.obj");
  const std::string empty = folder_.write("empty.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  refuse({empty, "--density", "2000"}, "empty.obj");
  const std::string inside_out =
      folder_.write("turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  refuse({inside_out, "--density", "2000"}, "turned.obj");
  refuse({ball_, "--density", "2000", "--density-of", ball_}, "--density-of");
  refuse({ball_, "--density", "2000", "--density-of", ball_ + "=-1"}, "0 to 1e6");
  refuse({ball_, "--density", "2000", "--density-of", ball_ + "=1e3x"}, "0 to 1e6");
  refuse({ball_, "--density", "2000", "--density-of", open + "=1000"}, "open.obj");
  refuse({ball_, "--density", "2000", "--density-of", ball_ + "=0"}, "no mass");
  const std::string beside = folder_.write("beside.obj", moved_obj(ellipsoid_obj(1, 1, 1, 9, 12), 1.0, 0.5));
  refuse({ball_, "--density", "2000", "--density-of", beside + "=1000"}, "leaves the body");
  const std::string nan = folder_.write("nan.csv", "1 2 3\n1 nan 3\n");
  refuse({ball_, "--density", "2000", "--points", nan}, "nan.csv: line 2");
  const std::string few = folder_.write("few.csv", "1 2 3\n1 2\n");
  refuse({ball_, "--density", "2000", "--points", few}, "few.csv: line 2");
  const std::string none = folder_.write("none.csv", "# nothing\n");
  refuse({ball_, "--density", "2000", "--points", none}, "none.csv");
}

}  // namespace
}  // namespace astrolith
