#include "synthesis/field/layer_maker.h"

namespace astrolith {
namespace {

template <class Kind>
LayerMaker maker_of(const Kind& layer, const LayerSource& source, ArrayStore& arrays) {
  if constexpr (Kind::kTraits.on_surface) {
    return [&layer, prepared = prepare(layer, source, arrays), source](const LayerSite& site,
                                                                       ArrayStore& of_site) {
      const auto noise = placed(layer, prepared, source, site, of_site);
      static_assert(noise.kTraits.on_surface && noise.kTraits.lifts <= Kind::kTraits.on_layers);
      return LayerNoise(noise);
    };
  } else {
    return [&layer, source](const LayerSite& site, ArrayStore& of_site) {
      const auto noise = make_noise(layer, source.recipe.seed, source.number, site.frame, of_site);
      static_assert(!noise.kTraits.on_surface);
      return LayerNoise(noise);
    };
  }
}

// Gabor noise has nothing that all sites share.
LayerMaker maker_of(const GaborLayer& layer, const LayerSource& source, ArrayStore&) {
  return [&layer, source](const LayerSite& site, ArrayStore& of_site) {
    return LayerNoise(
        make_noise(layer, source.recipe.seed, source.number, site.frame, site.body_side, of_site));
  };
}

}  // namespace

LayerMaker layer_maker(const Layer& layer, const LayerSource& source, ArrayStore& arrays) {
  return std::visit(
      [&]<class Kind>(const Kind& l) -> LayerMaker {
        if constexpr (Kind::kTraits.is_noise) {
          return maker_of(l, source, arrays);
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

}  // namespace astrolith
