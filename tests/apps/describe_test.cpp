// describe, run as a user runs it.
#include <nlohmann/json.hpp>

#include "tests/apps/inputs.h"
#include "tests/apps/program_runner.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::Outcome;
using testing::run_program;
using testing::text_of;
using testing::WorkFolder;

const std::string kDescribe = ASTROLITH_DESCRIBE;

// The numbers of a .npy file of float64 whose header holds `shape`.
std::vector<double> array_of(const std::filesystem::path& file, const std::string& shape) {
  const std::string bytes = text_of(file);
  EXPECT_NE(bytes.find("'shape': (" + shape + ")"), std::string::npos) << bytes.substr(0, 120);
  const std::size_t start = bytes.find('\n') + 1;
  std::vector<double> values((bytes.size() - start) / sizeof(double));
  std::memcpy(values.data(), bytes.data() + start, values.size() * sizeof(double));
  return values;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

// Points of a sphere on a golden spiral with their normals, as ascii PLY.
std::string sphere_points(int n, double normal_length = 1) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(n) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty "
                     "float ny\nproperty float nz\nend_header\n";
  for (int k = 0; k < n; ++k) {
    const double z = 1 - (2 * k + 1.0) / n, r = std::sqrt(1 - z * z), phi = 2.399963229728653 * k;
    const double p[] = {r * std::cos(phi), r * std::sin(phi), z};
    for (const double c : p) text += std::to_string(2 * c) + " ";
    for (const double c : p) text += std::to_string(normal_length * c) + " ";
    text += "\n";
  }
  return text;
}

class Describe : public ::testing::Test {
 protected:
  Outcome describe(const std::string& input, std::vector<std::string> more) {
    std::vector<std::string> arguments{input,      "-o", (folder_ / "h.npy").string(), "--points", "600",
                                       "--device", "cpu"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(kDescribe, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return outcome;
  }
  void expect_refused(const std::string& name, const std::string& content, const std::string& culprit) {
    const std::string file = folder_.write(name, content);
    expect_refusal(folder_, kDescribe, {file, "-o", (folder_ / "out.npy").string(), "--device", "cpu"},
                   culprit);
  }

  WorkFolder folder_;
  const std::string closing_line_ =
      (folder_ / "h.npy").string() + ": 600 points, 179700 pairs; computed on the CPU\n";
  const std::string egg_ = folder_.write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24));
};

// Tests on a machine with a GPU and on one without.
TEST_F(Describe, TheDeviceChangesNothing) {
  describe(egg_, {});
  const std::string on_cpu = text_of(folder_ / "h.npy");
  const Outcome outcome = run_program(
      kDescribe, {egg_, "-o", (folder_ / "h.npy").string(), "--points", "600", "--device", "auto"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(text_of(folder_ / "h.npy"), on_cpu);
  EXPECT_NE(outcome.errors.find("; computed on "), std::string::npos) << outcome.errors;
}

TEST_F(Describe, WritesFrequenciesOneAxisAFeature) {
  EXPECT_EQ(describe(egg_, {}).errors, closing_line_);
  const std::vector<double> ahd = array_of(folder_ / "h.npy", "5, 5, 5, 5, 5, 5");
  EXPECT_EQ(ahd.size(), 15625u);
  EXPECT_NEAR(sum_of(ahd), 1, 1e-12);
  describe(egg_, {"--features", "wahl"});
  const std::vector<double> wahl = array_of(folder_ / "h.npy", "5, 5, 5, 5");
  for (std::size_t b = 0; b < wahl.size(); ++b) {
    double sum = 0;
    for (std::size_t l = 0; l < 25; ++l) sum += ahd[25 * b + l];
    ASSERT_NEAR(sum, wahl[b], 1e-4);
  }
  describe(egg_, {"--features", "wahl", "--bins", "3"});
  EXPECT_EQ(array_of(folder_ / "h.npy", "3, 3, 3, 3").size(), 81u);
  describe(egg_, {"--bins", "4"});
  EXPECT_EQ(array_of(folder_ / "h.npy", "4, 4, 4, 4, 4, 4").size(), 4096u);
}

TEST_F(Describe, SameBytesForAnyThreadCount) {
  describe(egg_, {"--threads", "1", "--seed", "3"});
  const std::string one = text_of(folder_ / "h.npy");
  describe(egg_, {"--threads", "2", "--seed", "3"});
  EXPECT_EQ(text_of(folder_ / "h.npy"), one);
  describe(egg_, {"--seed", "4"});
  EXPECT_NE(text_of(folder_ / "h.npy"), one);
}

TEST_F(Describe, SummaryHoldsTheFigures) {
  describe(egg_, {"--summary", (folder_ / "s.json").string()});
  const auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  EXPECT_EQ(summary["points"].get<int>(), 600);
  EXPECT_EQ(summary["pairs"].get<int>(), 600 * 599 / 2);
  EXPECT_NEAR(summary["max_distance"].get<double>(), 3, 0.05);
  EXPECT_EQ(summary["vertices_left_out"].get<int>(), 0);
  EXPECT_TRUE(summary["seconds"].is_number());
}

TEST_F(Describe, MeasuresASurface) {
  const std::string fine = folder_.write("fine.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 31, 64));
  const std::string json = (folder_ / "s.json").string(), csv = (folder_ / "s.csv").string();
  const auto surface = [&](const std::string& output, const std::string& threads) {
    const Outcome outcome =
        run_program(kDescribe, {fine, "--surface", "-o", output, "--places", "300", "--threads", threads});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_NE(outcome.errors.find("300 places of 1984 points"), std::string::npos) << outcome.errors;
    return text_of(output);
  };
  const auto figures = nlohmann::json::parse(surface(json, "1"));
  EXPECT_EQ(figures["places"].get<int>(), 300);
  EXPECT_EQ(figures["radii"][0]["edges"].get<double>(), 3);
  EXPECT_LT(figures["radii"][0]["roughness"]["mean"].get<double>(), -5);
  EXPECT_GT(figures["slopes"]["mean"].get<double>(), 1);
  const std::string table = surface(csv, "1");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 301);
  EXPECT_TRUE(table.starts_with("x,y,z,region,roughness_3,skewness_3,kurtosis_3,normals_3,roughness_6,"));
  EXPECT_EQ(surface(csv, "2"), table);
  expect_refusal(folder_, kDescribe, {fine, "--surface", "-o", (folder_ / "s.npy").string()}, ".json");
  expect_refusal(folder_, kDescribe, {egg_, "--surface", "-o", json}, "egg.obj: surface statistics");
  expect_refusal(folder_, kDescribe, {fine, "--places", "300", "-o", json}, "--surface");
}

TEST_F(Describe, PointsWithNormalsWillDo) {
  const std::string cloud = folder_.write("cloud.ply", sphere_points(700));
  EXPECT_EQ(describe(cloud, {}).errors, closing_line_);
  // All of a sphere's points have eta = 0 and kappa = 1/2, the bins 0 and 3.
  const std::vector<double> h = array_of(folder_ / "h.npy", "5, 5, 5, 5, 5, 5");
  double local = 0;
  for (std::size_t b = 0; b < 625; ++b) local += h[25 * b + 3];
  EXPECT_NEAR(local, 1, 1e-12);
  const std::string few = describe(folder_.write("few.ply", sphere_points(500)), {}).errors;
  EXPECT_NE(few.find("only 500 points, 600 were asked for"), std::string::npos) << few;
  std::string doubled = sphere_points(700);
  const std::size_t body = doubled.find("end_header\n") + 11;
  doubled += doubled.substr(body);
  doubled.replace(doubled.find("vertex 700"), 10, "vertex 1400");
  const std::string repeated = describe(folder_.write("twice.ply", doubled), {}).errors;
  EXPECT_NE(repeated.find("700 repeated points were left out"), std::string::npos) << repeated;
}

TEST_F(Describe, OpenMeshesAreDescribedWithARemark) {
  const std::string vertices = testing::kTetrahedron.substr(0, testing::kTetrahedron.find('f'));
  const std::string file = folder_.write("open.obj", vertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const std::string words = describe(file, {"--summary", (folder_ / "s.json").string()}).errors;
  EXPECT_NE(words.find("open.obj: 3 vertices"), std::string::npos) << words;
  EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "s.json"))["vertices_left_out"].get<int>(), 3);
  EXPECT_EQ(describe(file, {"--quiet"}).errors, "");
  // Three triangles at one edge.
  const std::string fins =
      folder_.write("fins.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  EXPECT_NE(describe(fins, {}).errors.find("5 vertices"), std::string::npos);
}

TEST_F(Describe, BadFilesAreRefused) {
  const std::string vertices = testing::kTetrahedron.substr(0, testing::kTetrahedron.find('f'));
  expect_refused("cut.ply", testing::truncated_ply(), "cut.ply");
  expect_refused("points.obj", vertices, "normals");
  expect_refused("long_normals.ply", sphere_points(50, 2.0), "unit normals");
  expect_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "flat.obj: ");
  expect_refused("nan.obj", "v nan 0 0\n" + testing::kTetrahedron, "nan.obj");
  expect_refused("empty.ply", "", "empty.ply");
  expect_refused("one.ply", sphere_points(1), "one.ply: ");
  expect_refusal(folder_, kDescribe, {egg_, "-o", egg_}, "input itself");
  expect_refusal(folder_, kDescribe, {(folder_ / "absent.obj").string(), "-o", (folder_ / "o.npy").string()},
                 "absent.obj");
  expect_refusal(folder_, kDescribe, {egg_, "-o", (folder_ / "absent" / "o.npy").string()}, "o.npy");
  for (const auto& [option, value] : std::vector<std::pair<std::string, std::string>>{
           {"--bins", "1"}, {"--bins", "11"}, {"--points", "1"}, {"--features", "all"}}) {
    expect_refusal(folder_, kDescribe, {egg_, "-o", (folder_ / "o.npy").string(), option, value}, option);
  }
}

TEST_F(Describe, ARealBodyWithOpenPoles) {
  const auto ida = testing::shared_shape("ida_thomas_32k_DEFECT_open_poles.ply");
  ASTROLITH_SKIP_WITHOUT(ida);
  EXPECT_NE(describe(ida.string(), {}).errors.find("720 vertices"), std::string::npos);
}

}  // namespace
}  // namespace astrolith
