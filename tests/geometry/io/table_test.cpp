// Tables: lists of points, and shape models as radii on a grid of latitudes and longitudes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

class Tables : public ::testing::Test {
 protected:
  PointTable points(const std::string& text, const std::string& unit = "",
                    const std::string& name = "p.csv") {
    return read_point_table(folder_.write(name, text), unit);
  }
  void expect_points(const std::string& text, const std::string& unit = "km", double scale = 1.0) {
    const std::vector<Vec3d> read = points(text, unit).points;
    ASSERT_EQ(read.size(), 2u) << text;
    EXPECT_LT(norm(read[0] - scale * Vec3d{3, 0, 0}), 1e-12 * scale) << text;
    EXPECT_LT(norm(read[1] - scale * Vec3d{0, 4, 0}), 1e-12 * scale) << text;
  }
  void expect_refused(const std::string& text, const std::string& words, const std::string& name = "p.csv") {
    const std::string message = testing::refusal_text([&] { points(text, "km", name); });
    EXPECT_NE(message.find(words), message.npos) << message;
  }
  testing::ScratchFolder folder_;
};

TEST_F(Tables, PointsByTheNamesOfTheirColumns) {
  expect_points("3 0 0\n0 4 0\n");
  expect_points("x,y,z\n3,0,0\n0,4,0\n");
  expect_points("id,x_km,y_km,z_km\n1,3,0,0\n2,0,4,0\n");
  expect_points("# z x y\n0 3 0\n0 0 4\n");
  expect_points("# made by hand\n% name  X [km] Y [km]  Z [km]\na 3 0 0\nb 0 4 0\n", "km");
  expect_points("name;\"x (m)\";\"y (m)\";\"z (m)\"\nCrater A;3000;0;0\nRidge;0;4000;0\n");
  expect_points("3 0 0 # far\n0 4 0\n");
  expect_points("# Columns: z x y\n0 3 0\n0 0 4\n");
  expect_points("z/km\tx/km\ty/km\n0\t3\t0\n0\t0\t4\n", "m", 1000);
  expect_points("lat,lon,radius\n0,0,3\n0,90,4\n");
  expect_points("Longitude (deg), Latitude (deg), Radius (m)\n0,0,3000\n90,0,4000\n");
  expect_points("lon_w,lat,r_km\n0,0,3\n270,0,4\n");
  for (const char* west :
       {"deg W", "\xc2\xb0W", "degrees west", "degrees_west", "Positive West", "deg) (west"})
    expect_points("lat (deg N),lon (" + std::string(west) + "),r_km\n0,0,3\n0,270,4\n");
  expect_points("lat [degrees north] lon [degrees east] r\n0 0 3\n0 90 4\n");
  expect_points("lat_rad lon_rad r\n0 0 3\n0 1.5707963267948966 4\n");
  expect_points("i pos_x pos_y pos_z\n1 3 0 0\n2 0 4 0\n");
  expect_points("x,y,z,potential_J_kg,acceleration_x_m_s2\n3,0,0,-1,2\n0,4,0,-1,2\n");
  expect_points("\"x\",\"y\",\"z\"\n\"3\",\"0\",\"0\"\n0,4,0\n");
  expect_points("\"name\",\"x\",\"y\",\"z\"\n\"far, bright; old\",3,0,0\n\"12\"\" rock\",0,4,0\n");
  expect_points("name;x;y;z\n \"a, b\";3;0;0\n12\" rock;0;4;0\n");
  expect_points("\"Points:0\",\"Points:1\",\"Points:2\",\"id\"\n3,0,0,1\n0,4,0,2\n");
  EXPECT_EQ(points("id,x_km,y_km,z_km\n1,3,0,0\n", "m").words,
            "columns 'x_km', 'y_km', 'z_km' are taken as x, y, z in km; left out: 'id'");
  EXPECT_EQ(points("3 0 0 255 0 0\n", "", "cloud.xyz").points.size(), 1u);
}

TEST_F(Tables, CloudsOfPointsHaveMoreColumnsAndHeaders) {
  const auto cloud = [&](const std::string& name, const std::string& text) {
    return read_cloud(folder_.write(name, text));
  };
  const auto expect_cloud = [&](const std::string& name, const std::string& text) {
    const TriangleMesh read = cloud(name, text);
    ASSERT_EQ(read.vertices.size(), 2u) << text;
    EXPECT_EQ(read.vertices[0], (Vec3d{3, 0, 0})) << text;
    EXPECT_EQ(read.vertices[1], (Vec3d{0, 4, 0})) << text;
    EXPECT_TRUE(read.triangles.empty());
  };
  expect_cloud("a.xyz", "//X Y Z\n3 0 0\n0 4 0\n");
  expect_cloud("a.asc", "//X Y Z R G B Nx Ny Nz\n3 0 0 9 9 9 1 0 0\n0 4 0 9 9 9 0 1 0\n");
  expect_cloud("a.asc", "//Y X Z\n0 3 0\n4 0 0\n");
  expect_cloud("a.pts", "2\n3 0 0 -1203 10 20 30\n0 4 0 -1100 10 20 30\n");
  expect_cloud("a.xyzn", "3 0 0 1 0 0\n0 4 0 0 1 0\n");
  expect_cloud("a.xyzrgb", "3 0 0 1 .5 0\n0 4 0 0 1 0\n");
  expect_cloud("a.csv", "X,Y,Z,Intensity\n3,0,0,7\n0,4,0,8\n");
  expect_cloud("a.txt", "3 0 0\n0 4 0\n");
  expect_cloud("a.txt", "3 0 0 1 0 0\n0 4 0 0 1 0\n");
  expect_cloud("a.obj", "v 3 0 0\nv 0 4 0\n");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
  expect_cloud("a.ply", ply + "end_header\n3 0 0\n0 4 0\n");
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\nend_header\n";
  EXPECT_EQ(cloud("a.ply", ply + normals + "3 0 0 2 0 0\n0 4 0 0 .5 0\n").normals,
            (std::vector<Vec3d>{{1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(cloud("a.ply", ply + normals + "3 0 0 0 0 0\n0 4 0 0 1 0\n").normals.empty());
  const auto refused = [&](const std::string& name, const std::string& text) {
    return testing::refusal_text([&] { cloud(name, text); });
  };
  EXPECT_NE(refused("a.txt", "1 3 0 0\n2 0 4 0\n").find("counts the lines"), std::string::npos);
  EXPECT_NE(refused("a.las", "LASF").find("read_points"), std::string::npos);
}

TEST_F(Tables, OtherColumnsAreRefused) {
  expect_refused("1,3,0,0\n2,0,4,0\n", "line 1: has 4 columns where 3 (x, y, z) are due; name the columns");
  expect_refused("3,0\n", "has 2 columns where 3 (x, y, z) are due; complete the line");
  expect_refused("id,x,y,z\n1,3,0\n", "line 2: has 3 columns where 4 are named");
  expect_refused("a,b,c\n1,2,3\n", "names no x, y, z and no latitude");
  expect_refused("lat,lon,height\n1,2,3\n", "names no x, y, z and no latitude");
  expect_refused("Crater A,1,2,3\n", "names no x, y, z");
  expect_refused("x (ft),y (ft),z (ft)\n1,2,3\n", "the columns state lengths in 'ft'; convert them");
  expect_refused("x_ft y_ft z_ft\n1 2 3\n", "the columns state lengths in 'ft'");
  expect_refused("x_m,y_m,z_km\n1,2,3\n", "'several units'");
  expect_refused("lat,lon,r\n91,2,3\n", "beyond a pole");
  expect_refused("lat,lon (gon),r\n1,2,3\n",
                 "line 1: the names of the columns state an angle in 'gon'; state deg");
  expect_refused("lat (deg S),lon,r\n1,2,3\n", "state an angle in 'deg s'");
  expect_refused("# id x y z\n1 2 3\n",
                 "line 2: has 3 columns where 4 are named; complete the line or correct");
  expect_refused("1,5;2,5;3,5\n", "the number '1,5' has a decimal comma");
  expect_refused("x y z\n1,5 2,5 3,5\n", "line 2: the number '1,5' has a decimal comma");
  expect_refused("PK\x03\x04......", "save its table as .csv", "p.xlsx");
  expect_refused("\x93NUMPY", "the content is a NumPy array", "p.npy");
  expect_refused("{\"x\": 1}", "the content is JSON; give lines of x, y and z", "p.json");
  expect_refused("x,y,z\n1,2,nan\n", "line 2: z is 'nan'");
}

// An ellipsoid-like body as rows of the places of a grid.
struct GridStyle {
  double first = -90.0, step = 10.0;  // of latitudes, as many as fit
  double from = 0.0;                  // longitudes
  bool seam = false, lon_first = false, count = false, one_row_at_poles = false;
  const char* header = "";
};

std::string grid_table(const GridStyle& style) {
  std::string text = style.header;
  for (double lat = style.first; lat <= 90.0; lat += style.step) {
    for (double lon = style.from; lon < style.from + 360.0 + (style.seam ? 1.0 : 0.0); lon += style.step) {
      const double a = lat * std::numbers::pi / 180, b = lon * std::numbers::pi / 180;
      const double r = 5 + std::cos(a) * std::cos(a) * std::cos(2 * b);
      char row[100];
      std::snprintf(row, sizeof row, "%8.1f %8.1f %10.6f%s\r\n", style.lon_first ? lon : lat,
                    style.lon_first ? lat : lon, r, style.count ? "  17" : "");
      text += row;
      if (style.one_row_at_poles && std::fabs(lat) == 90.0) break;
    }
  }
  return text;
}

TEST_F(Tables, RadiiOnAGridBecomeABody) {
  const double sound = volume(read_mesh(folder_.write("a.tab", grid_table({}))));
  EXPECT_NEAR(sound, 4 * std::numbers::pi / 3 * 130, 40);
  for (const GridStyle& style :
       {GridStyle{}, GridStyle{.seam = true}, GridStyle{.lon_first = true},
        GridStyle{.seam = true, .lon_first = true}, GridStyle{.one_row_at_poles = true},
        GridStyle{.from = -180, .seam = true},
        GridStyle{.first = -85, .from = 5, .lon_first = true, .count = true},
        GridStyle{.header = "Latitude,Longitude,Radius\n"}, GridStyle{.header = "# lat lon radius_km\n"},
        GridStyle{.lon_first = true, .header = "LONGITUDE LATITUDE RADIUS\n"}}) {
    for (const char* name : {"body.tab", "body.txt", "body.csv", "body"}) {
      const TriangleMesh mesh = read_mesh(folder_.write(name, grid_table(style)));
      const MeshTopology topology = analyze_topology(mesh);
      EXPECT_TRUE(topology.closed && topology.oriented && topology.genus == 0) << name;
      EXPECT_NEAR(volume(mesh), sound, 0.02 * sound) << style.header;
    }
  }
}

TEST_F(Tables, GridsThatAreNone) {
  const auto refusal = [&](const std::string& text) {
    return testing::refusal_text([&] { read_mesh(folder_.write("a.tab", text)); });
  };
  const std::string half = grid_table({.first = 0, .header = "lat lon radius\n"});
  EXPECT_NE(refusal(half).find("no regular grid from pole to pole"), std::string::npos) << refusal(half);
  for (const char* header : {"", "colatitude lon radius\n", "lat lon elevation\n"}) {
    const std::string words = refusal(grid_table({.first = 0, .header = header}));
    EXPECT_NE(words.find("name its columns"), std::string::npos) << words;
  }
  std::string gap = grid_table({.header = "lat lon radius\n"});
  gap.erase(gap.size() / 2 / 32 * 32, 32);
  EXPECT_FALSE(refusal(gap).empty());
  std::string diagonal;  // its grid would take 80 GB
  for (int i = 1; i < 100000; ++i)
    diagonal += std::to_string(i * 0.0018 - 90) + " " + std::to_string(i * 0.0036) + " 5\n";
  EXPECT_FALSE(refusal(diagonal).empty());
  EXPECT_NE(refusal("lat lon radius\n" + diagonal).find("no regular grid"), std::string::npos);
}

const std::string kLabel =
    "PDS_VERSION_ID = PDS3\r\nRECORD_BYTES = 32\r\n^TABLE = 12\r\nOBJECT = TABLE\r\nEND_OBJECT = "
    "TABLE\r\nEND\r\n    \r\n";

TEST_F(Tables, LabelsBeforeATableArePassedOver) {
  const std::string tab = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n4\n1 1 3 2\n2 1 2 4\n3 1 4 3\n4 2 3 4\n";
  EXPECT_EQ(read_mesh(folder_.write("a.tab", kLabel + tab)).triangles.size(), 4u);
  EXPECT_GT(volume(read_mesh(folder_.write("b.tab", kLabel + grid_table({})))), 0);
  EXPECT_EQ(points(kLabel + "1,2,3\n").points.size(), 1u);
  std::string detached = kLabel;
  detached.replace(detached.find("12"), 2, "\"EROS.TAB\"");
  const std::string message = testing::refusal_text([&] { read_mesh(folder_.write("a.lbl", detached)); });
  EXPECT_NE(message.find("is a PDS3 label without its data; give 'EROS.TAB'"), message.npos) << message;
  const std::string late = testing::refusal_text([&] { points(kLabel + "1,2\n"); });
  EXPECT_NE(late.find("line 8: has 2 columns"), late.npos) << late;
}

// Longitudes to the west, as in most tables of the PDS: by a column's name, or by a label.
TEST_F(Tables, LongitudesToTheWest) {
  std::string rows;
  for (int lat = -90; lat <= 90; lat += 30) {
    for (int lon = 0; lon < 360; lon += 30)
      rows += std::to_string(lat) + " " + std::to_string(lon) + (lon == 90 && lat == 0 ? " 7\n" : " 5\n");
  }
  std::string commas = rows;
  std::replace(commas.begin(), commas.end(), ' ', ',');
  const auto lowest_y = [&](const std::string& name, const std::string& text) {
    const TriangleMesh mesh = read_mesh(folder_.write(name, text));
    EXPECT_GT(volume(mesh), 0);
    return mesh.bounds().min.y;
  };
  EXPECT_NEAR(lowest_y("a.tab", rows), -5, 1e-9);
  EXPECT_NEAR(lowest_y("a.tab", "lat west_longitude r\n" + rows), -7, 1e-9);
  const std::string west =
      "PDS_VERSION_ID = PDS3\n^TABLE = \"B.TAB\"\nPOSITIVE_LONGITUDE_DIRECTION = \"WEST\"\nEND\n";
  EXPECT_NEAR(lowest_y("c.tab", west + rows), -7, 1e-9);
  folder_.write("b.lbl", west);
  EXPECT_NEAR(lowest_y("b.tab", rows), -7, 1e-9);
  EXPECT_NEAR(lowest_y("d.csv", "lat (deg), lon (deg W), r (km)\n" + commas), -7, 1e-9);
  const std::string east =
      "PDS_VERSION_ID = PDS3\n^TABLE = \"E.TAB\"\nPOSITIVE_LONGITUDE_DIRECTION = EAST\n"
      "WESTERNMOST_LONGITUDE = 0\nDESCRIPTION = \"Not west longitude\"\nEND\n";
  EXPECT_NEAR(lowest_y("e.tab", east + rows), -5, 1e-9);
  folder_.write(
      "f.xml",
      "<file_name>f.tab</file_name><cart:longitude_direction>Positive West</cart:longitude_direction>");
  EXPECT_NEAR(lowest_y("f.tab", rows), -7, 1e-9);
}

}  // namespace
}  // namespace astrolith
