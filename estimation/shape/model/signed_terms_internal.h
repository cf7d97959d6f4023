// What all metaballs of one kind, additive or subtractive, have in common at a point: the weight over exp k
// and the mean of u, in the symbols of block_kernels.h.
#pragma once

#include "estimation/shape/model/metaball_model.h"

namespace astrolith {

struct KindTerms {
  double weight;  // w_i over exp k_i
  Vec3d mean;     // G_i
};

class SignedTerms {
 public:
  explicit SignedTerms(const MetaballTotals<double>& totals)
      : added_(terms_of(totals.added, 1.0 / (totals.added.kernel + double{kKernelFloor}))),
        subtracted_(terms_of(totals.subtracted, 1.0 / (1.0 + totals.subtracted.kernel))) {
    subtracted_.weight *= -1.0;
  }

  const KindTerms& of(bool subtractive) const { return subtractive ? subtracted_ : added_; }
  Vec3d weighted_mean() const { return added_.mean - subtracted_.mean; }  // G

 private:
  static KindTerms terms_of(const MetaballSums<double>& sums, double weight) {
    return {weight, sums.weighted * weight};
  }

  KindTerms added_, subtracted_;
};

}  // namespace astrolith
