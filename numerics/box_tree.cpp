#include "numerics/box_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace astrolith {
namespace {

constexpr std::uint32_t kLeafBoxes = 4;
// Halving 2^32 boxes gives at most 32 levels, and each level leaves one node pending.
constexpr std::size_t kMaxDepth = 64;

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (boxes.empty()) return;
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  for (const std::uint32_t i : order_) boxes_.push_back(boxes[i]);
  bounds_ = nodes_.front().box;
}

void BoxTree::build(const std::vector<Box>& boxes, std::uint32_t first, std::uint32_t count) {
  const std::size_t self = nodes_.size();
  nodes_.push_back({{}, first, count, 0});
  Box box, centers;
  for (std::uint32_t k = first; k < first + count; ++k) {
    box.extend(boxes[order_[k]].min);
    box.extend(boxes[order_[k]].max);
    centers.extend(boxes[order_[k]].center());
  }
  nodes_[self].box = box;
  if (count <= kLeafBoxes) return;
  double Vec3d::*const axis = longest_axis(centers.extent());
  const auto begin = order_.begin() + first, middle = begin + count / 2;
  std::nth_element(begin, middle, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double ca = boxes[a].center().*axis, cb = boxes[b].center().*axis;
    return ca != cb ? ca < cb : a < b;
  });
  nodes_[self].count = 0;
  build(boxes, first, count / 2);
  nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, first + count / 2, count - count / 2);
}

template <typename Visit>
void BoxTree::visit_touching(const Box& box, const Visit& visit) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kMaxDepth> pending;
  std::size_t depth = 0;
  pending[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t self = pending[--depth];
    const Node& node = nodes_[self];
    if (!boxes_touch(node.box, box)) continue;
    if (node.count == 0) {
      pending[depth++] = node.right;
      pending[depth++] = self + 1;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      if (boxes_touch(boxes_[k], box) && !visit(order_[k])) return;
    }
  }
}

std::vector<std::uint32_t> BoxTree::touching(const Box& box) const {
  std::vector<std::uint32_t> found;
  visit_touching(box, [&](std::uint32_t i) {
    found.push_back(i);
    return true;
  });
  std::sort(found.begin(), found.end());
  return found;
}

bool BoxTree::any_touching(const Box& box) const {
  bool any = false;
  visit_touching(box, [&](std::uint32_t) {
    any = true;
    return false;
  });
  return any;
}

}  // namespace astrolith
