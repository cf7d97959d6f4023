#include "synthesis/field/noise_facts.h"

namespace astrolith {
namespace {

// Compiles only for a kind of noise without lists of impulses.
template <class Noise>
constexpr void expect_no_impulses() {
  static_assert(Noise::kTraits.lists == NoiseLists::kNone || Noise::kTraits.lists == NoiseLists::kCraters);
}

}  // namespace

double height_bound_of(const LayerNoise& noise) {
  return noise.visit([]<class Noise>(const Noise& n) {
    if constexpr (Noise::kTraits.has_heights) {
      return n.height_bound;
    } else {
      return 0.0;
    }
  });
}

NoiseDetail detail_of(const LayerNoise& noise) {
  return noise.visit([]<class Noise>(const Noise& n) {
    if constexpr (Noise::kTraits.has_heights) {
      return n.detail;
    } else {
      return NoiseDetail{};
    }
  });
}

bool has_local_form(const LayerNoise& noise) {
  return noise.visit([]<class Noise>(const Noise& n) {
    if constexpr (Noise::kTraits.local_form) {
      return n.has_local_form();
    } else {
      return false;
    }
  });
}

std::uint32_t num_impulse_lists(const LayerNoise& noise) {
  return noise.visit([]<class Noise>(const Noise& n) -> std::uint32_t {
    if constexpr (Noise::kTraits.lists == NoiseLists::kSpots) {
      return n.kinds.count;
    } else if constexpr (Noise::kTraits.lists == NoiseLists::kGabor) {
      return n.bands.count;
    } else {
      expect_no_impulses<Noise>();
      return 0;
    }
  });
}

double draws_at_a_point(const LayerNoise& noise, const ArrayView& arrays) {
  return noise.visit([&]<class Noise>(const Noise& n) {
    if constexpr (Noise::kTraits.lists == NoiseLists::kSpots || Noise::kTraits.lists == NoiseLists::kGabor) {
      return draws_at_a_point(n, arrays);
    } else {
      expect_no_impulses<Noise>();
      return 0.0;
    }
  });
}

}  // namespace astrolith
