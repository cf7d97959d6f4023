#include "synthesis/field/layer_noise.h"

namespace astrolith {
namespace {

template <class Kind>
LayerMaker make_maker(const Kind& layer, const LayerSource& source, ArrayStore& arrays) {
  if constexpr (Kind::kTraits.on_surface) {
    return [&layer, prepared = prepare(layer, source, arrays), source](const LayerSite& site,
                                                                       ArrayStore& site_arrays) {
      const auto noise = placed(layer, prepared, source, site, site_arrays);
      static_assert(noise.kTraits.on_surface && noise.kTraits.lifts <= Kind::kTraits.on_layers);
      return LayerNoise(noise);
    };
  } else {
    return [&layer, source](const LayerSite& site, ArrayStore& site_arrays) {
      const auto noise = make_noise(layer, source.recipe.seed, source.number, site.frame, site_arrays);
      static_assert(!noise.kTraits.on_surface);
      return LayerNoise(noise);
    };
  }
}

// Gabor noise has nothing that all sites share.
LayerMaker make_maker(const GaborLayer& layer, const LayerSource& source, ArrayStore&) {
  return [&layer, source](const LayerSite& site, ArrayStore& site_arrays) {
    return LayerNoise(
        make_noise(layer, source.recipe.seed, source.number, site.frame, site.body_side, site_arrays));
  };
}

// Compiles only for a kind of noise without lists of impulses.
template <class Noise>
constexpr void expect_no_impulses() {
  static_assert(Noise::kTraits.lists == NoiseLists::kNone || Noise::kTraits.lists == NoiseLists::kCraters);
}

}  // namespace

LayerMaker layer_maker(const Layer& layer, const LayerSource& source, ArrayStore& arrays) {
  return std::visit(
      [&]<class Kind>(const Kind& l) -> LayerMaker {
        if constexpr (Kind::kTraits.is_noise) {
          return make_maker(l, source, arrays);
        } else {
          return {};
        }
      },
      layer);
}

double reach_below(const Layer& layer) {
  return std::visit(
      []<class Kind>(const Kind& l) {
        if constexpr (Kind::kTraits.on_layers) {
          return reach_below(l);
        } else {
          return 0.0;
        }
      },
      layer);
}

double noise_height_bound(const LayerNoise& noise) {
  return noise.visit([]<class Noise>(const Noise& n) {
    if constexpr (Noise::kTraits.has_heights) {
      return n.height_bound;
    } else {
      return 0.0;
    }
  });
}

NoiseDetail noise_detail(const LayerNoise& noise) {
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
