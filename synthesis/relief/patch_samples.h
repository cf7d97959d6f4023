// Square patches of a surface: values at places become rows of samples in tangent frames, and what samples
// want goes back to the places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_smoothing.h"

namespace astrolith {

// Patches of side x side samples, `apart` (length units) from each other along both axes.
struct PatchGrid {
  std::size_t side;
  double apart;
  double reach;  // of samples, length units: how far off the places lie that they are means of

  std::size_t samples() const { return side * side; }
  double middle() const { return 0.5 * static_cast<double>(side - 1); }
};

// Patches about places drawn by a hash, evenly over the surface, in tangent frames turned at random. A sample
// is the mean of the values at the places within reach of it, with the weights (1 - d^2 / reach^2)^3. A patch
// with a sample that has no place is left out, and so are all beyond some 2^23 shares of places (64 MB), so
// that there may be fewer than `count`.
class PatchSamples {
 public:
  PatchSamples(const ReliefPoints& points, const PatchGrid& grid, std::size_t count, std::uint32_t hash);

  std::size_t patches() const { return (first_.size() - 1) / grid_.samples(); }

  // (patches x samples) The samples of values at the places, times `scale`, less the quadric that fits each
  // patch best.
  std::vector<float> of(const std::vector<double>& values, double scale) const;

 private:
  friend class PlaceMeans;
  struct Patch;
  Patch patch_at(const ReliefPoints& points, std::uint32_t place, std::uint32_t hash) const;

  PatchGrid grid_;
  // What samples take: (samples + 1) first of the two lists.
  std::vector<std::size_t> first_{0};
  std::vector<std::uint32_t> places_;
  std::vector<float> shares_;
};

// Means at the places of what the samples around them want, weighted by a Gaussian window over the patch with
// the standard deviation side / 4.
class PlaceMeans {
 public:
  PlaceMeans(const PatchSamples& patches, std::size_t places);

  // At all places, of (patches x samples); 0 where a place has no sample.
  std::vector<double> of(const std::vector<float>& wanted) const;

 private:
  std::vector<std::size_t> first_;  // (places + 1) of the two lists
  std::vector<std::uint32_t> samples_;
  std::vector<float> weights_;
};

// Takes the quadric that fits best off a patch of values (side x side).
void remove_quadric(std::size_t side, float* patch);

}  // namespace astrolith
