#include "synthesis/bake/map_borders.h"

#include <array>
#include <cstddef>
#include <optional>

namespace astrolith {
namespace {

struct TexelStep {
  int x, y;
};
constexpr std::array<TexelStep, 8> kTexelSteps{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

}  // namespace

std::vector<BorderCopy> border_copies(std::span<const std::uint8_t> covered, int side, int reach) {
  const auto width = static_cast<std::size_t>(side);
  std::vector<std::uint8_t> known(covered.begin(), covered.end());
  const auto neighbour = [&](std::size_t texel, const TexelStep& step) -> std::optional<std::size_t> {
    const int x = static_cast<int>(texel % width) + step.x, y = static_cast<int>(texel / width) + step.y;
    if (x < 0 || y < 0 || x >= side || y >= side) return std::nullopt;
    return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  };
  // The texels that the next ring grows from: at first those at the edge of what is covered.
  std::vector<BorderCopy> copies, last;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == 0) continue;
    for (const TexelStep& step : kTexelSteps) {
      const auto at = neighbour(i, step);
      if (!at || known[*at] != 0) continue;
      last.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i)});
      break;
    }
  }
  for (int ring = 0; ring < reach; ++ring) {
    std::vector<BorderCopy> next;
    for (const TexelStep& step : kTexelSteps) {
      for (const BorderCopy& source : last) {
        const auto at = neighbour(source.to, {-step.x, -step.y});
        if (!at || known[*at] != 0) continue;
        known[*at] = 1;
        next.push_back({static_cast<std::uint32_t>(*at), source.from});
      }
    }
    copies.insert(copies.end(), next.begin(), next.end());
    last = std::move(next);
  }
  return copies;
}

}  // namespace astrolith
