// The lists of the elements that reach some blocks, gathered on the backend that uses them.
#pragma once

#include "cuda/mesher/block_culler.h"
#include "cuda/mesher/gather_steps.h"

namespace astrolith {

template <class Backend>
class GatheredLists {
 public:
  // Gathers the lists of the first `count` blocks of `from`.
  GatheredLists(Backend& backend, const GatherFrom& from, std::size_t count)
      : leaves_(from.lists.leaves),
        spot_lists_(from.field.spot_lists.count),
        gabor_lists_(from.field.gabor_lists.count),
        landform_lists_(from.lists.landforms),
        metaballs_(write_lists<MetaballSphere<float>>(backend, "gathering metaballs", count * leaves_,
                                                      GatherMetaballs{from, 0})),
        landforms_(write_lists<std::uint32_t>(backend, "gathering craters and boulders",
                                              count * landform_lists_, GatherLandforms{from})),
        spots_(write_lists<SpotImpulse>(backend, "gathering spots", count * spot_lists_, GatherSpots{from})),
        gabor_(gather_gabor_lists(backend, from, count)) {}

  // The lists in the backend's memory. The view is valid while this object lives.
  BlockListArrays view() const {
    return {metaballs_.items.data(),
            metaballs_.first.data(),
            spots_.items.data(),
            spots_.first.data(),
            gabor_.items.data(),
            gabor_.first.data(),
            landforms_.items.data(),
            landforms_.first.data(),
            leaves_,
            spot_lists_,
            gabor_lists_,
            landform_lists_};
  }

 private:
  BackendLists<Backend, GaborImpulse> gather_gabor_lists(Backend& backend, const GatherFrom& from,
                                                         std::size_t count) {
    if (gabor_lists_ == 0) return write_lists<GaborImpulse>(backend, "gathering", 0, GatherGabor{});
    // The frames of impulses follow from the body at the centres of their cells, which lie around the blocks.
    const auto wide =
        write_lists<MetaballSphere<float>>(backend, "gathering metaballs", count * leaves_,
                                           GatherMetaballs{from, from.lists.leaves + from.lists.landforms});
    return write_lists<GaborImpulse>(backend, "gathering Gabor impulses", count * gabor_lists_,
                                     GatherGabor{from, {wide.items.data(), wide.first.data()}});
  }

  std::uint32_t leaves_, spot_lists_, gabor_lists_, landform_lists_;
  BackendLists<Backend, MetaballSphere<float>> metaballs_;
  BackendLists<Backend, std::uint32_t> landforms_;
  BackendLists<Backend, SpotImpulse> spots_;
  BackendLists<Backend, GaborImpulse> gabor_;
};

}  // namespace astrolith
