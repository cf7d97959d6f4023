#include "geometry/atlas/chart_packing.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace astrolith {
namespace {

// The outline of what has been placed: steps from left to right, each up to where the next begins.
class Skyline {
 public:
  explicit Skyline(int side) : side_(side), steps_{{0, 0}} {}

  std::optional<RectanglePlace> place(const RectangleSize& size) {
    std::size_t best = steps_.size();
    RectanglePlace at;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (steps_[i].x + size.width > side_) break;
      const int y = top_over(i, size.width);
      if (y + size.height > side_ || (best < steps_.size() && y >= at.y)) continue;
      best = i, at = {steps_[i].x, y};
    }
    if (best == steps_.size()) return std::nullopt;
    raise(best, at, size);
    return at;
  }

 private:
  struct Step {
    int x, y;
  };

  int end_of(std::size_t i) const { return i + 1 < steps_.size() ? steps_[i + 1].x : side_; }

  int top_over(std::size_t first, int width) const {
    int top = 0;
    const int end = steps_[first].x + width;
    for (std::size_t i = first; i < steps_.size() && steps_[i].x < end; ++i) top = std::max(top, steps_[i].y);
    return top;
  }

  void raise(std::size_t first, const RectanglePlace& at, const RectangleSize& size) {
    const int end = at.x + size.width;
    std::size_t last = first;  // the first step that reaches beyond the rectangle
    while (last < steps_.size() && end_of(last) <= end) ++last;
    std::vector<Step> made{{at.x, at.y + size.height}};
    if (last < steps_.size()) made.push_back({end, steps_[last].y});
    const auto from = steps_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto to = steps_.begin() + static_cast<std::ptrdiff_t>(std::min(last + 1, steps_.size()));
    steps_.insert(steps_.erase(from, to), made.begin(), made.end());
  }

  int side_;
  std::vector<Step> steps_;
};

}  // namespace

std::optional<std::vector<RectanglePlace>> pack_rectangles(std::span<const RectangleSize> sizes, int side) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a].height != sizes[b].height ? sizes[a].height > sizes[b].height
                                              : sizes[a].width > sizes[b].width;
  });
  Skyline skyline(side);
  std::vector<RectanglePlace> places(sizes.size());
  for (const std::size_t i : order) {
    const std::optional<RectanglePlace> place = skyline.place(sizes[i]);
    if (!place) return std::nullopt;
    places[i] = *place;
  }
  return places;
}

}  // namespace astrolith
