// What of the field reaches each of some blocks, gathered on the backend where it is used.
#pragma once

#include "cuda/mesher/block_culler.h"
#include "cuda/mesher/gather_steps.h"

namespace astrolith {

template <class Backend>
class BlockParts {
 public:
  // Of the first `count` blocks that were culled.
  BlockParts(Backend& backend, const FlatFieldData& data, const GatherFrom& from, std::size_t count)
      : leaves_(from.lists.leaves),
        sizes_(static_cast<std::uint32_t>(data.spots.size())),
        bands_(static_cast<std::uint32_t>(data.bands.size())),
        num_landform_lists_(from.lists.landforms),
        spheres_(write_lists<MetaballSphere<float>>(backend, "gathering metaballs", count * leaves_,
                                                    GatherMetaballs{from, 0})),
        landforms_(write_lists<std::uint32_t>(backend, "gathering craters and boulders",
                                              count * num_landform_lists_, GatherLandforms{from})),
        impulses_(
            write_lists<SpotImpulse>(backend, "gathering spots", count * sizes_, GatherSpots{from, sizes_})),
        gabor_(gather_gabor(backend, from, count)) {}

  FlatBlocks view() const {
    return {spheres_.items.data(),
            spheres_.first.data(),
            impulses_.items.data(),
            impulses_.first.data(),
            gabor_.items.data(),
            gabor_.first.data(),
            landforms_.items.data(),
            landforms_.first.data(),
            leaves_,
            sizes_,
            bands_,
            num_landform_lists_};
  }

 private:
  BackendLists<Backend, GaborImpulse> gather_gabor(Backend& backend, const GatherFrom& from,
                                                   std::size_t count) {
    if (bands_ == 0) return write_lists<GaborImpulse>(backend, "gathering", 0, GatherGabor{});
    // Around the blocks' cells of impulses, whose frames follow from the body.
    const auto wide =
        write_lists<MetaballSphere<float>>(backend, "gathering metaballs", count * leaves_,
                                           GatherMetaballs{from, from.lists.leaves + from.lists.landforms});
    FlatBlock body{};
    body.spheres = wide.items.data();
    return write_lists<GaborImpulse>(backend, "gathering Gabor impulses", count * bands_,
                                     GatherGabor{from, bands_, body, wide.first.data()});
  }

  std::uint32_t leaves_, sizes_, bands_, num_landform_lists_;
  BackendLists<Backend, MetaballSphere<float>> spheres_;
  BackendLists<Backend, std::uint32_t> landforms_;
  BackendLists<Backend, SpotImpulse> impulses_;
  BackendLists<Backend, GaborImpulse> gabor_;
};

// How far beyond a block the cells of Gabor impulses have their centres that may reach it; 0 without such.
inline double gabor_margin(const FlatFieldData& data) {
  double margin = 0.0;
  for (const FlatBand& band : data.bands) {
    margin = std::max(margin, 1.01 * double{band.draw.reach} + 2.0 * double{band.draw.cell});
  }
  return margin;
}

}  // namespace astrolith
