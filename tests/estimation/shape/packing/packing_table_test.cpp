#include "estimation/shape/packing/packing_table.h"

#include <fstream>

#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

const std::vector<Sphere> kSpheres = {{{1, 2, 3}, 0.2}, {{-1, 0.5, 0}, 0.1}};

TEST(PackingTable, HoldsCentresAndRadii) {
  const testing::ScratchFolder folder;
  write_packing_table(kSpheres, {"two spheres", "km"}, folder / "p.csv");
  EXPECT_EQ(lines_of(folder / "p.csv"),
            (std::vector<std::string>{"# two spheres", "# lengths in km", "x,y,z,radius", "1,2,3,0.2",
                                      "-1,0.5,0,0.1"}));
}

TEST(PackingTable, MasconsWeighWhatTheBodyWeighs) {
  const testing::ScratchFolder folder;
  write_packing_table(kSpheres, {"two spheres", "km", 0.09, 2000.0}, folder / "p.csv");
  const std::vector<std::string> lines = lines_of(folder / "p.csv");
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[2], "x,y,z,radius,mass");
  const auto mass = [&](std::size_t line) {
    return std::stod(lines[line].substr(lines[line].rfind(',') + 1));
  };
  EXPECT_NEAR(mass(3) + mass(4), 1.8e11, 1e3);  // 0.09 km^3 of 2000 kg / m^3
  EXPECT_NEAR(mass(3) / mass(4), 8.0, 1e-6);
}

}  // namespace
}  // namespace astrolith
