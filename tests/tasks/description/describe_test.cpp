// describe: histograms of shapes, and statistics of surfaces.
#include "tasks/description/description_jobs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <sstream>

#include "tests/support/data.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::has;

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

class Describe : public testing::JobTest {
 protected:
  Describe() : JobTest("describe", declare_describe) {
    write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24));
  }
  // Returns the messages.
  std::string describe(const std::string& input, const std::string& more = "") {
    return succeed(input + " -o h.npy --points 600 --device cpu " + more);
  }
  // The float64 numbers of h.npy, whose header must hold `shape`.
  std::vector<double> array(const std::string& shape) {
    const std::string bytes = text("h.npy");
    const std::size_t start = bytes.find('\n') + 1;
    EXPECT_TRUE(has(bytes.substr(0, start), "'shape': (" + shape + ")"));
    std::vector<double> values((bytes.size() - start) / sizeof(double));
    std::memcpy(values.data(), bytes.data() + start, values.size() * sizeof(double));
    return values;
  }

  const std::string closing_line_ = "h.npy: 600 points, 179700 pairs; computed on the CPU\n";
};

// Tests on a machine with a GPU and on one without.
TEST_F(Describe, TheDeviceChangesNothing) {
  describe("egg.obj");
  const std::string on_cpu = text("h.npy");
  EXPECT_TRUE(has(succeed("egg.obj -o h.npy --points 600 --device auto"), "; computed on "));
  EXPECT_EQ(text("h.npy"), on_cpu);
}

TEST_F(Describe, WritesFrequenciesOneAxisAFeature) {
  EXPECT_EQ(describe("egg.obj"), closing_line_);
  const std::vector<double> ahd = array("5, 5, 5, 5, 5, 5");
  EXPECT_EQ(ahd.size(), 15625u);
  EXPECT_NEAR(std::accumulate(ahd.begin(), ahd.end(), 0.0), 1, 1e-12);
  describe("egg.obj", "--features wahl");
  const std::vector<double> wahl = array("5, 5, 5, 5");
  for (std::size_t b = 0; b < wahl.size(); ++b) {
    double sum = 0;
    for (std::size_t l = 0; l < 25; ++l) sum += ahd[25 * b + l];
    ASSERT_NEAR(sum, wahl[b], 1e-4);
  }
  describe("egg.obj", "--features wahl --bins 3");
  EXPECT_EQ(array("3, 3, 3, 3").size(), 81u);
  describe("egg.obj", "--bins 4");
  EXPECT_EQ(array("4, 4, 4, 4, 4, 4").size(), 4096u);
}

TEST_F(Describe, SameBytesForAnyThreadCount) {
  describe("egg.obj", "--threads 1 --seed 3");
  const std::string one = text("h.npy");
  describe("egg.obj", "--threads 2 --seed 3");
  EXPECT_EQ(text("h.npy"), one);
  describe("egg.obj", "--seed 4");
  EXPECT_NE(text("h.npy"), one);
}

TEST_F(Describe, SummaryHoldsTheFigures) {
  const auto summary = figures("egg.obj -o h.npy --points 600 --device cpu");
  EXPECT_EQ(summary["points"], 600);
  EXPECT_EQ(summary["pairs"], 600 * 599 / 2);
  EXPECT_NEAR(summary["max_distance"], 3, 0.05);
  EXPECT_EQ(summary["vertices_left_out"], 0);
  EXPECT_TRUE(summary["seconds"].is_number());
}

TEST_F(Describe, MeasuresASurface) {
  write("fine.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 31, 64));
  const auto surface = [&](const std::string& output, const std::string& threads) {
    EXPECT_TRUE(has(succeed("fine.obj --surface --places 300 -o " + output + " --threads " + threads),
                    "300 places of 1984 points"));
    return text(output);
  };
  surface("s.json", "1");
  const auto figures = json("s.json");
  EXPECT_EQ(figures["places"], 300);
  EXPECT_EQ(figures["radii"][0]["edges"], 3);
  EXPECT_LT(figures["radii"][0]["roughness"]["mean"], -5);
  EXPECT_GT(figures["slopes"]["mean"], 1);
  const std::string table = surface("s.csv", "1");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 301);
  EXPECT_TRUE(table.starts_with("x,y,z,region,roughness_3,skewness_3,kurtosis_3,normals_3,roughness_6,"));
  EXPECT_EQ(surface("s.csv", "2"), table);
  refuse("fine.obj --surface -o s.npy", ".json");
  refuse("egg.obj --surface -o s.json", "egg.obj: surface statistics");
  refuse("fine.obj --places 300 -o s.json", "--surface");
}

// A sphere of radius 2 with 2,450 vertices and a crater of diameter 1.2 at +x.
TEST_F(Describe, FindsCraters) {
  std::istringstream sphere(testing::ellipsoid_obj(2, 2, 2, 50, 100));
  std::string cratered, line;
  while (std::getline(sphere, line)) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
      const double t = std::sqrt((x - 2) * (x - 2) + y * y + z * z) / 0.6, left = (2.5 - t) / 1.5;
      const double height = t < 1 ? 0.156 * t * t - 0.12 : t < 2.5 ? 0.036 * left * left * left : 0;
      const double factor = 1 + height / 2;
      line = "v " + std::to_string(factor * x) + " " + std::to_string(factor * y) + " " +
             std::to_string(factor * z);
    }
    cratered += line + "\n";
  }
  write("bowl.obj", cratered);
  const auto summary = figures("bowl.obj --craters c.csv --craters-picture c.png");
  EXPECT_EQ(summary["craters"]["likely"], 1);
  EXPECT_NEAR(summary["craters"]["largest"], 1.2, 0.1);
  EXPECT_GT(summary["craters"]["sizes"][0]["number"], 0.5);
  EXPECT_NEAR(summary["craters"]["depth_over_diameter"][2], 0.1, 0.02);
  const std::string table = text("c.csv");
  EXPECT_TRUE(
      table.starts_with("kind,x,y,z,center_x,center_y,center_z,normal_x,normal_y,normal_z,diameter,depth,"
                        "rim_height,freshness,completeness,confidence,length_unit\ncrater,1.8"));
  EXPECT_TRUE(has(text("c.png"), "PNG"));
  succeed("bowl.obj --craters c.json");
  EXPECT_EQ(json("c.json")["features"][0]["kind"], "crater");
  refuse("bowl.obj", "name -o H.npy or --craters FILE.csv");
  refuse("bowl.obj --craters c.txt", "c.txt: is no .csv or .json file");
  refuse("bowl.obj -o h.npy --craters-picture c.png", "--craters");
  refuse("egg.obj --craters c.csv", "egg.obj: features: needs a mesh of 1000 triangles");
}

TEST_F(Describe, PointsWithNormalsWillDo) {
  EXPECT_EQ(describe(write("cloud.ply", sphere_points(700))), closing_line_);
  EXPECT_EQ(describe(write("long_normals.ply", sphere_points(700, 2.0))), closing_line_);
  // All of a sphere's points have eta = 0 and kappa = 1/2, the bins 0 and 3.
  const std::vector<double> h = array("5, 5, 5, 5, 5, 5");
  double local = 0;
  for (std::size_t b = 0; b < 625; ++b) local += h[25 * b + 3];
  EXPECT_NEAR(local, 1, 1e-12);
  EXPECT_TRUE(has(describe(write("few.ply", sphere_points(500))), "only 500 points, 600 were asked for"));
  std::string doubled = sphere_points(700);
  doubled += doubled.substr(doubled.find("end_header\n") + 11);
  doubled.replace(doubled.find("vertex 700"), 10, "vertex 1400");
  EXPECT_TRUE(has(describe(write("twice.ply", doubled)), "700 repeated points were left out"));
}

TEST_F(Describe, OpenMeshesAreDescribedWithARemark) {
  write("open.obj", testing::kTetrahedronVertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  EXPECT_TRUE(has(describe("open.obj", "--summary s.json"), "open.obj: 3 vertices"));
  EXPECT_EQ(json("s.json")["vertices_left_out"], 3);
  EXPECT_EQ(describe("open.obj", "--quiet"), "");
  // Three triangles at one edge.
  write("fins.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  EXPECT_TRUE(has(describe("fins.obj"), "5 vertices"));
}

TEST_F(Describe, BadFilesAreRefused) {
  const auto refuse_file = [&](const std::string& name, const std::string& content,
                               const std::string& culprit) {
    refuse(write(name, content) + " -o out.npy --device cpu", culprit);
  };
  refuse_file("cut.ply", testing::truncated_ply(), "cut.ply");
  refuse_file("points.obj", testing::kTetrahedronVertices, "normals");
  refuse_file("flat.obj", testing::kFlatObj, "flat.obj: ");
  refuse_file("one.ply", sphere_points(1), "one.ply: ");
  refuse("absent.obj -o out.npy", "absent.obj");
  refuse("egg.obj -o absent/o.npy", "o.npy");
  refuse_all("egg.obj -o o.npy ", {{"--bins 1", "--bins"},
                                   {"--bins 11", "--bins"},
                                   {"--points 1", "--points"},
                                   {"--features all", "--features"}});
}

TEST_F(Describe, ARealBodyWithOpenPoles) {
  const auto ida = testing::shared_shape("ida_thomas_32k_DEFECT_open_poles.ply");
  ASTROLITH_SKIP_WITHOUT(ida);
  EXPECT_TRUE(has(describe(ida.string(), "--summary s.json"), "stitched 360 edges, nothing moved"));
  EXPECT_EQ(json("s.json")["repair"]["stitched_edges"], 360);
  EXPECT_TRUE(has(describe(ida.string(), "--strict"), "720 vertices"));
}

}  // namespace
}  // namespace astrolith
