#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "recipe/compact/number_table.h"
#include "recipe/recipe_json.h"
#include "tests/recipe/recipe_examples.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

Recipe reread(const Recipe& recipe) { return parse_recipe(recipe_to_compact(recipe), "r.astro"); }

void expect_equal_after_compact(const Recipe& recipe) {
  EXPECT_EQ(recipe_to_json(reread(recipe)), recipe_to_json(recipe));
}

Sphere sphere_on_grid(CounterRandom& random, double step) {
  const auto on_grid = [&](double low, double high) {
    return std::round(random.uniform(low, high) / step) * step;
  };
  const double x = on_grid(-1000, 1000), y = on_grid(-400, 400), z = on_grid(-400, 400);
  return {{x, y, z}, on_grid(10, 200)};
}

Recipe make_body(std::vector<Sphere> spheres) {
  Recipe recipe;
  recipe.body.emplace().spheres = std::move(spheres);
  return recipe;
}

// A body of 200 metaballs on a grid, in the order in which they take the fewest bytes.
Recipe body_on_grid(double step) {
  CounterRandom random(7);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 200; ++i) spheres.push_back(sphere_on_grid(random, step));
  NumberTable table{4, {}};
  for (const Sphere& s : spheres)
    table.values.insert(table.values.end(), {s.center.x, s.center.y, s.center.z, s.radius});
  std::vector<Sphere> ordered;
  for (const std::size_t i : spatial_order(table)) ordered.push_back(spheres[i]);
  return make_body(ordered);
}

std::string error_for_bytes(const std::string& bytes) {
  return testing::refusal_text([&] { parse_recipe(bytes, "r.astro"); });
}

TEST(CompactRecipe, HoldsEveryField) {
  expect_equal_after_compact(parse_recipe(testing::kCompleteRecipe, "r"));
}

TEST(CompactRecipe, HoldsNumbersToTheLastBit) {
  CounterRandom random(3);
  std::vector<Sphere> spheres = {{{0.1 + 0.2, -0.0, 1e-300}, 1e-12}, {{1e12, -1e12, 1.0 / 3.0}, 1e12}};
  for (int i = 0; i < 50; ++i) spheres.push_back({{random.normal(), random.normal(), random.normal()}, 1.0});
  const Recipe recipe = make_body(spheres), read = reread(recipe);
  expect_equal_after_compact(recipe);
  EXPECT_TRUE(std::signbit(read.body->spheres[0].center.y));
}

TEST(CompactRecipe, HoldsOneSphereAndManyEqualOnes) {
  expect_equal_after_compact(make_body({{{1, 2, 3}, 4}}));
  expect_equal_after_compact(make_body(std::vector<Sphere>(300, {{1, 2, 3}, 4})));
}

TEST(CompactRecipe, KeepsTheOrderOfMetaballs) {
  Recipe recipe = body_on_grid(1.0);
  std::swap(recipe.body->spheres.front(), recipe.body->spheres.back());
  expect_equal_after_compact(recipe);
}

// 200 metaballs of 11 + 10 + 10 + 8 bits are 975 bytes; their order holds log2(200!) bits, which are 156
// bytes.
TEST(CompactRecipe, SpendsNoBytesOnTheOrderOfMetaballs) {
  const Recipe recipe = body_on_grid(1.0);
  expect_equal_after_compact(recipe);
  EXPECT_LT(recipe_to_compact(recipe).size(), 975u - 156u + 60u);
}

TEST(CompactRecipe, KnowsTheTextOfABareBody) {
  EXPECT_LT(recipe_to_compact(make_body({{{1, 2, 3}, 4}})).size(), 60u);
}

// The model of the text and the coder may not change while the version is 1.
TEST(CompactRecipe, KeepsTheBytesOfItsVersion) {
  const unsigned char bytes[] = {0x41, 0x53, 0x54, 0x01, 0x0c, 0xc6, 0x24, 0xd6, 0x29, 0x51, 0x58,
                                 0x4f, 0xe6, 0x09, 0x0d, 0xc8, 0x18, 0x76, 0x83, 0x6f, 0x1e, 0x51,
                                 0x76, 0xb2, 0xd6, 0xd7, 0x69, 0xa2, 0x0e, 0x7a, 0x1b, 0x46, 0xeb,
                                 0x62, 0x1d, 0xd0, 0xb1, 0x89, 0xf0, 0xf1, 0x6a, 0x81, 0xdd, 0x61,
                                 0xaa, 0x66, 0x86, 0xc2, 0xf0, 0xac, 0x00, 0x18, 0x75, 0x40};
  EXPECT_EQ(recipe_to_compact(make_body({{{1, 2, 3}, 4}})), std::string(std::begin(bytes), std::end(bytes)));
}

TEST(CompactRecipe, IsAFileLikeOthers) {
  const testing::ScratchFolder folder;
  const Recipe recipe = body_on_grid(0.25);
  write_recipe(recipe, folder / "r.astro");
  EXPECT_LT(std::filesystem::file_size(folder / "r.astro"), 1300u);
  EXPECT_EQ(recipe_to_json(read_recipe(folder / "r.astro")), recipe_to_json(recipe));
}

TEST(CompactRecipe, OtherVersionIsRefused) {
  std::string bytes = recipe_to_compact(body_on_grid(1.0));
  bytes[3] = 2;
  EXPECT_EQ(error_for_bytes(bytes),
            "r.astro: is a compact recipe of version 2, this program reads 1; use the program version that "
            "wrote the file");
}

TEST(CompactRecipe, DamagedBytesAreRefused) {
  const std::string bytes = recipe_to_compact(body_on_grid(1.0));
  const std::string damaged = "r.astro: is a damaged compact recipe; copy it or write it again";
  for (std::size_t size = 3; size < bytes.size(); ++size)
    EXPECT_EQ(error_for_bytes(bytes.substr(0, size)), damaged) << size;
  for (std::size_t i = 4; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    EXPECT_EQ(error_for_bytes(changed), damaged) << i;
  }
}

// CRC-16 of the format, so that hostile streams pass the check.
std::string with_valid_check(std::string bytes) {
  std::uint32_t check = 0xffff;
  for (std::size_t i = 6; i < bytes.size(); ++i) {
    check ^= std::uint32_t{static_cast<unsigned char>(bytes[i])} << 8;
    for (int bit = 0; bit < 8; ++bit)
      check = ((check << 1) ^ ((check & 0x8000) != 0 ? 0x1021u : 0u)) & 0xffff;
  }
  bytes[4] = static_cast<char>(check >> 8);
  bytes[5] = static_cast<char>(check & 0xff);
  return bytes;
}

TEST(CompactRecipe, HostileStreamsEndInOneLineOrInARecipe) {
  const std::string bytes = recipe_to_compact(parse_recipe(testing::kCompleteRecipe, "r"));
  const std::string body = recipe_to_compact(body_on_grid(1.0));
  CounterRandom random(11);
  for (int i = 0; i < 400; ++i) {
    std::string changed = i % 2 == 0 ? body : bytes;
    for (int k = 0; k < 3; ++k) {
      const auto at =
          6 + static_cast<std::size_t>(random.uniform() * static_cast<double>(changed.size() - 6));
      changed[at] = static_cast<char>(static_cast<unsigned char>(random.uniform() * 256.0));
    }
    const std::string error = error_for_bytes(with_valid_check(changed));
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

TEST(CompactRecipe, SizesBeyondTheLimitsAreRefusedBeforeTheyAreAllocated) {
  RangeEncoder encoder;
  encoder.encode_number(std::uint64_t{1} << 40);
  const std::string error =
      error_for_bytes(with_valid_check("AST\x01" + std::string(2, ' ') + encoder.finish()));
  EXPECT_NE(error.find("damaged"), std::string::npos) << error;
  RangeEncoder rows;
  rows.encode_number(std::uint64_t{1} << 31);
  rows.encode_uniform(3, kMostTableColumns);
  const std::string stream = rows.finish();
  RangeDecoder decoder(stream);
  EXPECT_THROW(TableDecoder(decoder).decode(8'000'000), DamagedStream);
}

TEST(CompactRecipe, AFewBytesHoldAFewThings) {
  RangeEncoder text;
  text.encode_number(std::uint64_t{1} << 23);  // bytes of text, of which none follows
  const std::string error =
      error_for_bytes(with_valid_check("AST\x01" + std::string(2, ' ') + text.finish()));
  EXPECT_NE(error.find("damaged"), std::string::npos) << error;
}

TEST(CompactRecipe, EqualRowsThatWouldCostNothingAreRefused) {
  const NumberTable table{2, std::vector<double>(2 * (kMostEqualRows + 1), 3.0)};
  RangeEncoder encoder;
  TableEncoder(encoder).encode(table);
  const std::string stream = encoder.finish();
  RangeDecoder decoder(stream);
  EXPECT_THROW(TableDecoder(decoder).decode(1000), DamagedStream);
}

TEST(CompactRecipe, HoldsPointsThatStandManyTimes) {
  std::vector<Sphere> spheres(100, Sphere{{1, 2, 3}, 4});
  spheres.push_back({{5, 6, 7}, 8});
  expect_equal_after_compact(make_body(spheres));
  expect_equal_after_compact(make_body(std::vector<Sphere>(1000, Sphere{{1, 2, 3}, 4})));
}

TEST(NumberLattice, IsTheCoarsestThatHoldsAll) {
  const std::vector<double> numbers = {0.25, -1.5, 0.0, 12.75};
  const auto found = find_lattice(numbers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->lattice, (NumberLattice{2, 25}));
  EXPECT_EQ(found->integers, (std::vector<std::int64_t>{1, -6, 0, 51}));
  const std::vector<double> large = {3e15, -6e15};
  EXPECT_EQ(find_lattice(large)->lattice, (NumberLattice{-15, 3}));
  const std::vector<double> apart = {1e12, 1e-12}, thirds = {1.0 / 3.0}, zero = {-0.0};
  EXPECT_FALSE(find_lattice(apart));
  EXPECT_FALSE(find_lattice(zero));
  EXPECT_FALSE(find_lattice(std::vector<double>{std::numeric_limits<double>::infinity()}));
  const auto third = find_lattice(thirds);
  ASSERT_TRUE(third);
  EXPECT_EQ(lattice_number(third->lattice, third->integers[0]), 1.0 / 3.0);
}

}  // namespace
}  // namespace astrolith
