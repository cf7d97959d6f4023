// Places rectangles in a square.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace astrolith {

struct RectangleSize {
  int width, height;
};
struct RectanglePlace {
  int x = 0, y = 0;  // of the corner next to (0, 0)
};

// (#sizes) Places that do not overlap in a square of `side`; none where the rectangles do not fit. The
// highest rectangles come first, each as low as the outline of those before it allows (a skyline, "bottom
// left"). The result depends on sizes and order alone.
std::optional<std::vector<RectanglePlace>> pack_rectangles(std::span<const RectangleSize> sizes, int side);

}  // namespace astrolith
