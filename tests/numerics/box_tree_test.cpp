#include "numerics/box_tree.h"

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

Box random_box(CounterRandom& random, double largest) {
  const Vec3d corner{random.uniform(), random.uniform(), random.uniform()};
  return {corner, corner + Vec3d{largest * random.uniform(), largest * random.uniform(), 0.1 * largest}};
}

TEST(BoxTree, FindsWhatASearchOfAllFinds) {
  CounterRandom random(1);
  for (const int n : {0, 1, 4, 5, 37, 1000}) {
    std::vector<Box> boxes;
    for (int i = 0; i < n; ++i) boxes.push_back(random_box(random, i % 10 == 0 ? 0.5 : 0.05));
    if (n == 37) boxes.assign(37, boxes.front());  // all boxes in one place
    const BoxTree tree(boxes);
    for (int k = 0; k < 50; ++k) {
      const Box query = random_box(random, 0.3);
      std::vector<std::uint32_t> expected;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (boxes_touch(boxes[i], query)) expected.push_back(static_cast<std::uint32_t>(i));
      }
      ASSERT_EQ(tree.touching(query), expected);
      ASSERT_EQ(tree.any_touching(query), !expected.empty());
    }
  }
}

}  // namespace
}  // namespace astrolith
