// What takes the place of instructions and library functions whose results differ between machines.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "numerics/emulated_fma.h"
#include "numerics/split_at_rank.h"

namespace astrolith {
namespace {

std::uint32_t to_bits(float x) { return std::bit_cast<std::uint32_t>(x); }

void expect_fma(float a, float b, float c) {
  const float right = std::fma(a, b, c), got = emulated_fma(a, b, c);
  if (std::isnan(right) && std::isnan(got)) return;
  EXPECT_EQ(to_bits(got), to_bits(right)) << a << " * " << b << " + " << c;
}

TEST(EmulatedFma, RoundsOnceForAnyBits) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000000; ++i) {
    expect_fma(std::bit_cast<float>(static_cast<std::uint32_t>(random())),
               std::bit_cast<float>(static_cast<std::uint32_t>(random())),
               std::bit_cast<float>(static_cast<std::uint32_t>(random())));
  }
}

// Products of short numbers and addends far below them, whose sums lie beside the middle of two floats.
TEST(EmulatedFma, RoundsOnceBesideTies) {
  std::mt19937 random(2);
  for (int i = 0; i < 300000; ++i) {
    const float a = static_cast<float>(1 + (random() & 0xfff)),
                b = static_cast<float>(1 + (random() & 0x1fff) * 2);
    const float c = std::ldexp(random() % 2 == 0 ? 1.0f : -1.0f, -static_cast<int>(random() % 80));
    expect_fma(a, b, c);
    expect_fma(-a, b, c);
    expect_fma(std::ldexp(a, -140), b, std::ldexp(c, -60));
  }
}

TEST(EmulatedFma, KeepsInfinities) {
  const float infinity = std::numeric_limits<float>::infinity(), most = std::numeric_limits<float>::max();
  for (const float a : {infinity, -infinity, most, 0.0f, -0.0f, 1.0f}) {
    for (const float b : {infinity, most, 0.0f, -1.0f}) {
      for (const float c : {infinity, -infinity, -most, 0.0f, -0.0f}) expect_fma(a, b, c);
    }
  }
}

TEST(SplitAtRank, PutsTheRightElementAndSplits) {
  std::mt19937 random(3);
  for (int count = 1; count < 300; ++count) {
    std::vector<int> numbers(static_cast<std::size_t>(count));
    for (int& n : numbers) n = static_cast<int>(random() % 50);
    std::vector<int> sorted = numbers;
    std::ranges::sort(sorted);
    const auto nth = static_cast<std::ptrdiff_t>(random() % static_cast<unsigned>(count));
    split_at_rank(numbers.begin(), numbers.begin() + nth, numbers.end(), std::less<>());
    EXPECT_EQ(numbers[static_cast<std::size_t>(nth)], sorted[static_cast<std::size_t>(nth)]);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const int n = numbers[static_cast<std::size_t>(i)], pivot = sorted[static_cast<std::size_t>(nth)];
      EXPECT_TRUE(i < nth ? n <= pivot : n >= pivot);
    }
  }
}

// Numbers that an adversary chooses while they are compared, so that quickselect makes no headway (McIlroy,
// "A killer adversary for quicksort", 1999). What is left of them is sorted, whose order libraries agree on.
TEST(SplitAtRank, SortsWhatTakesLongInTheOrderOfEveryLibrary) {
  constexpr int kCount = 2000, kGas = kCount;
  std::vector<int> values(kCount, kGas), places(kCount);
  std::iota(places.begin(), places.end(), 0);
  int solid = 0, candidate = 0;
  const auto adversary = [&](int a, int b) {
    int &x = values[static_cast<std::size_t>(a)], &y = values[static_cast<std::size_t>(b)];
    if (x == kGas && y == kGas) (a == candidate ? x : y) = solid++;
    if (x == kGas) candidate = a;
    if (y == kGas) candidate = b;
    return x < y;
  };
  split_at_rank(places.begin(), places.begin() + kCount / 2, places.end(), adversary);
  // Four neighbours are equal now.
  std::iota(places.begin(), places.end(), 0);
  const auto key = [&](int place) { return values[static_cast<std::size_t>(place)] / 4; };
  split_at_rank(places.begin(), places.begin() + kCount / 2, places.end(),
                [&](int a, int b) { return key(a) < key(b); });
  std::uint64_t order = 0;
  for (const int place : places) order = order * 6364136223846793005u + static_cast<std::uint64_t>(place) + 1;
  EXPECT_EQ(order, 16105118811123389360u);
}

#ifdef __GLIBCXX__
// Sums over trees were in this order before, and keep their bits.
TEST(SplitAtRank, LeavesTheOrderOfLibstdcxx) {
  struct Item {
    int key, place;
    bool operator==(const Item&) const = default;
  };
  const auto less = [](const Item& a, const Item& b) { return a.key < b.key; };
  std::mt19937 random(4);
  for (int count = 1; count < 500; ++count) {
    std::vector<Item> mine;
    for (int i = 0; i < count; ++i) mine.push_back({static_cast<int>(random() % 200), i});
    std::vector<Item> theirs = mine;
    split_at_rank(mine.begin(), mine.begin() + count / 2, mine.end(), less);
    std::nth_element(theirs.begin(), theirs.begin() + count / 2, theirs.end(), less);
    EXPECT_TRUE(mine == theirs) << count;
  }
}
#endif

}  // namespace
}  // namespace astrolith
