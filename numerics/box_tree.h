// A bounding-volume tree over axis-aligned boxes: finds those boxes that touch a given box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

//   const BoxTree tree(boxes);
//   for (std::uint32_t i : tree.touching(box)) ...
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes);

  // Numbers of the boxes that share a point with `box`, ascending.
  std::vector<std::uint32_t> touching(const Box& box) const;
  bool any_touching(const Box& box) const;
  // The smallest box that holds all boxes; empty where there are none.
  const Box& bounds() const { return bounds_; }

 private:
  struct Node {
    Box box;
    std::uint32_t first, count;  // a range of order_; count is 0 in an inner node
    std::uint32_t right;         // the left child follows its parent
  };
  void build(const std::vector<Box>& boxes, std::uint32_t first, std::uint32_t count);
  // Calls visit(number) for every box that touches `box`, until visit returns false.
  template <typename Visit>
  void visit_touching(const Box& box, const Visit& visit) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  // numbers of the boxes, leaf after leaf
  std::vector<Box> boxes_;            // in the order of order_
  Box bounds_;
};

}  // namespace astrolith
