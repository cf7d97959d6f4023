#include "synthesis/field/layer_maker.h"

#include <utility>

namespace astrolith {
namespace {

// The maker of a layer on the surface, from what prepare() made for all sites.
template <class Kind, class Prepared>
LayerMaker maker_on_surface(const Kind& layer, Prepared prepared, const LayerSource& source) {
  return [&layer, prepared = std::move(prepared), source](const LayerSite& site, ArrayStore& arrays) {
    const auto noise = placed(layer, prepared, source, site, arrays);
    static_assert(noise.kTraits.on_surface && noise.kTraits.lifts <= Kind::kTraits.on_layers);
    return LayerNoise(noise);
  };
}

template <class Kind>
LayerMaker maker_of(const Kind& layer, const LayerSource& source, ArrayStore& arrays) {
  if constexpr (Kind::kTraits.on_surface) {
    return maker_on_surface(layer, prepare(layer, source, arrays), source);
  } else {
    return [&layer, source](const LayerSite& site, ArrayStore& of_site) {
      const auto noise = make_noise(layer, source.recipe.seed, source.number, site.frame, of_site);
      static_assert(!noise.kTraits.on_surface);
      return LayerNoise(noise);
    };
  }
}

// Gabor layers become one of two kinds of noise.
LayerMaker maker_of(const GaborLayer& layer, const LayerSource& source, ArrayStore& arrays) {
  if (layer.evaluation == GaborEvaluation::kTiles) {
    return maker_on_surface(layer, prepare_tiles(layer, source, arrays), source);
  }
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
