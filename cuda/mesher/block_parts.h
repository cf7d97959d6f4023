// What of the field reaches each of some blocks, gathered on the machine where it is used.
#pragma once

#include "cuda/mesher/block_culler.h"
#include "cuda/mesher/gather_steps.h"

namespace astrolith {

template <class Machine>
class BlockParts {
 public:
  // Of the first `count` blocks that were culled.
  BlockParts(Machine& machine, const FlatFieldData& data, const GatherFrom& from, std::size_t count)
      : leaves_(from.lists.leaves),
        sizes_(static_cast<std::uint32_t>(data.spots.size())),
        bands_(static_cast<std::uint32_t>(data.bands.size())),
        features_count_(from.lists.features),
        spheres_(write_lists<MetaballSphere<float>>(machine, "gathering metaballs", count * leaves_,
                                                    GatherMetaballs{from, 0})),
        features_(write_lists<std::uint32_t>(machine, "gathering craters and boulders",
                                             count * features_count_, GatherFeatures{from})),
        impulses_(
            write_lists<SpotImpulse>(machine, "gathering spots", count * sizes_, GatherSpots{from, sizes_})),
        gabor_(gather_gabor(machine, from, count)) {}

  FlatBlocks view() const {
    return {spheres_.items.data(),
            spheres_.first.data(),
            impulses_.items.data(),
            impulses_.first.data(),
            gabor_.items.data(),
            gabor_.first.data(),
            features_.items.data(),
            features_.first.data(),
            leaves_,
            sizes_,
            bands_,
            features_count_};
  }

 private:
  MachineLists<Machine, GaborImpulse> gather_gabor(Machine& machine, const GatherFrom& from,
                                                   std::size_t count) {
    if (bands_ == 0) return write_lists<GaborImpulse>(machine, "gathering", 0, GatherGabor{});
    // Around the blocks' cells of impulses, whose frames follow from the body.
    const auto wide =
        write_lists<MetaballSphere<float>>(machine, "gathering metaballs", count * leaves_,
                                           GatherMetaballs{from, from.lists.leaves + from.lists.features});
    FlatBlock body{};
    body.spheres = wide.items.data();
    return write_lists<GaborImpulse>(machine, "gathering Gabor impulses", count * bands_,
                                     GatherGabor{from, bands_, body, wide.first.data()});
  }

  std::uint32_t leaves_, sizes_, bands_, features_count_;
  MachineLists<Machine, MetaballSphere<float>> spheres_;
  MachineLists<Machine, std::uint32_t> features_;
  MachineLists<Machine, SpotImpulse> impulses_;
  MachineLists<Machine, GaborImpulse> gabor_;
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
