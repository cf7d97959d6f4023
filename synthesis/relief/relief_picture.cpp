#include "synthesis/relief/relief_picture.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "numerics/errors.h"
#include "recipe/compact/height_picture.h"

namespace astrolith {
namespace {

// The lines of one axis that hold places.
struct LineRange {
  std::int32_t low_u = std::numeric_limits<std::int32_t>::max(),
               high_u = std::numeric_limits<std::int32_t>::min();
  std::int32_t low_v = low_u, high_v = high_u;

  void extend(const ReliefPlace& p) {
    low_u = std::min(low_u, p.u), high_u = std::max(high_u, p.u);
    low_v = std::min(low_v, p.v), high_v = std::max(high_v, p.v);
  }
  int columns() const { return high_u < low_u ? 0 : high_u - low_u + 1; }
  int rows() const { return high_v < low_v ? 0 : high_v - low_v + 1; }
};

}  // namespace

ReliefLayout relief_layout(const std::vector<ReliefPlace>& places) {
  std::array<LineRange, 3> lines;
  std::vector<int> rank(places.size());        // how many places of the side lie before it, from outside
  std::array<std::array<int, 2>, 3> panels{};  // of each axis and side: the number of panels
  for (std::size_t first = 0; first < places.size();) {
    std::size_t end = first;
    while (end < places.size() && places[end].axis == places[first].axis &&
           places[end].u == places[first].u && places[end].v == places[first].v) {
      ++end;
    }
    const auto axis = static_cast<std::size_t>(places[first].axis);
    lines[axis].extend(places[first]);
    int low = 0, high = 0;  // places ascend along the line: the outermost of the upper side is the last one
    for (std::size_t i = first; i < end; ++i) {
      if (places[i].normal.x < 0.0f) rank[i] = low++;
    }
    for (std::size_t i = end; i-- > first;) {
      if (places[i].normal.x >= 0.0f) rank[i] = high++;
    }
    panels[axis][0] = std::max(panels[axis][0], low);
    panels[axis][1] = std::max(panels[axis][1], high);
    first = end;
  }
  ReliefLayout layout;
  std::array<int, 3> top{};
  for (std::size_t a = 0; a < 3; ++a) {
    top[a] = layout.height;
    layout.height += lines[a].rows();
    layout.width = std::max(layout.width, lines[a].columns() * (panels[a][0] + panels[a][1]));
  }
  layout.pixels.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ReliefPlace& p = places[i];
    const auto a = static_cast<std::size_t>(p.axis);
    const int panel = rank[i] + (p.normal.x < 0.0f ? 0 : panels[a][0]);
    const std::size_t row = static_cast<std::size_t>(top[a] + p.v - lines[a].low_v);
    const std::size_t column = static_cast<std::size_t>(panel * lines[a].columns() + p.u - lines[a].low_u);
    layout.pixels[i] = static_cast<std::uint32_t>(row * static_cast<std::size_t>(layout.width) + column);
  }
  return layout;
}

std::shared_ptr<ExemplarImage> relief_image(const ReliefLayer& layer, const std::vector<ReliefPlace>& places,
                                            const std::vector<std::uint16_t>& codes,
                                            const std::string& where) {
  const ReliefLayout layout = relief_layout(places);
  if (std::max(layout.width, layout.height) > kMostHeightPictureSide) {
    throw InputError(where + ".spacing: would take a picture of heights of more than " +
                     std::to_string(kMostHeightPictureSide) + " pixels a side on this body; make it larger");
  }
  auto image = std::make_shared<ExemplarImage>();
  // Programs read no image that is smaller.
  image->width = std::max(layout.width, kLeastExemplarSide),
  image->height = std::max(layout.height, kLeastExemplarSide);
  image->values.assign(static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height), 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = layout.pixels[i] / static_cast<std::size_t>(layout.width),
                      column = layout.pixels[i] % static_cast<std::size_t>(layout.width);
    image->values[row * static_cast<std::size_t>(image->width) + column] = layer.code_to_grey(codes[i]);
  }
  return image;
}

}  // namespace astrolith
