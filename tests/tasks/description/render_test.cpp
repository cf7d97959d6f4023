// render: pictures of meshes, in the colours of a property.
#include "tasks/description/description_jobs.h"

#include <cmath>
#include <sstream>

#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

// v.ply is a tetrahedron with a property "age_s" of its vertices.
class Render : public testing::JobTest {
 protected:
  Render() : JobTest("render", declare_render) {
    write("v.ply",
          "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
          "property int age_s\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
          "0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  }
  std::string picture(const std::string& more) {
    succeed("v.ply -o p.png --picture-size 200x160 " + more);
    return text("p.png");
  }
};

TEST_F(Render, DrawsMeshesInTheColoursOfAProperty) {
  const std::string plain = picture("");
  EXPECT_FALSE(plain == picture("--color age_s"));
  EXPECT_FALSE(picture("--color age_s") == picture("--color age_s --range 0 100"));
  EXPECT_FALSE(picture("--color age_s") == picture("--color age_s --title Age"));
  EXPECT_FALSE(plain == picture("--color z"));
  EXPECT_TRUE(plain == picture("--threads 1"));
  EXPECT_EQ(figures("v.ply -o p.png --color age_s --range -1 5")["range"], nlohmann::json({-1, 5}));
  const std::string in_metres = picture("--unit m");
  EXPECT_FALSE(plain == in_metres);
  write("v.ply", text("v.ply").replace(0, 4, "ply\ncomment length unit: m\n"));
  EXPECT_TRUE(in_metres == picture(""));
}

TEST_F(Render, ShowsTheColoursOfThePly) {
  const std::string grey = picture("");
  std::string ply = text("v.ply");
  for (const char* end : {"1\n1", "2\n0", "3\n0", "9\n3"})
    ply.replace(ply.find(end), 1, std::string(1, end[0]) + " 200 40 40");
  ply.replace(ply.find("property int age_s\n"), 19,
              "property int age_s\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n");
  write("v.ply", ply);
  EXPECT_FALSE(grey == picture(""));
}

// A tetrahedron seen along +x shows the slanted facet: S is its area times m r.
TEST_F(Render, WritesRadianceAndCurves) {
  succeed("v.ply -o p.png --picture-size 200x160 --radiance p.tif --normal-albedo .5 --reflectance lambert");
  EXPECT_GT(text("p.tif").size(), 200u * 160u * 12u);
  const auto summary = figures(
      "v.ply --unit km --phase-curve phase.csv --light-curve light.csv --period 6 --normal-albedo .5 "
      "--reflectance lambert");
  EXPECT_GT(summary["light_curve_amplitude"], 0.0);
  std::istringstream phases(text("phase.csv")), light(text("light.csv"));
  std::string head, row;
  std::getline(phases, head);
  EXPECT_EQ(head.rfind("phase_deg,light,light_least,light_greatest,magnitude", 0), 0u);
  std::getline(light, head);
  std::getline(light, row);
  EXPECT_EQ(head, "rotation,hours,light,magnitude");
  const double exact = std::sqrt(0.75) * 0.5 / 3.0;  // area, albedo, the squared cosine
  EXPECT_NEAR(std::stod(row.substr(4)), exact, 1e-6) << row;
}

TEST_F(Render, RefusesWhatCannotBeDrawn) {
  write("o.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refuse("o.obj -o q.png --color age", "o.obj: has no properties of vertices; give a .ply");
  refuse("v.ply -o q.jpg", "q.jpg");
  refuse("v.ply", "--output: is required");
  refuse("v.ply --phase-curve c.csv --radiance r.tif", "--radiance: is of the picture");
  refuse_all("v.ply -o q.png ",
             {{"--color slope", "v.ply: the vertices have no property 'slope'; choose from x, y, z, age_s"},
              {"--color age_s --range 2 2", "--range"},
              {"--picture-size 0x0", "--picture-size"},
              {"--radiance r.png", ".tif"},
              {"--phase-curve r.txt", ".csv"},
              {"--normal-albedo 2", "--normal-albedo"},
              {"--normal-albedo .2", "add --radiance FILE.tif or a curve"},
              {"--period 2", "--period requires --light-curve"},
              {"--picture-size 1000000x1000000", "--picture-size"},
              {"--sun 0 0 0", "--sun"},
              {"--camera \"at .1 .1 .1 target 1 1 1 fov 30\"", "stands inside the body"}});
}

}  // namespace
}  // namespace astrolith
