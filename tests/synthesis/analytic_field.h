// Fields given by a formula, with a Lipschitz constant as their bound: the fields that tests mesh.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "synthesis/mesh/block_field.h"

namespace astrolith::testing {

// F(p) must change by at most `lipschitz` per unit of length. Infinity switches culling off.
template <class Function>
class AnalyticField {
 public:
  class Block {
   public:
    Block(const AnalyticField& field, const Box& box) : field_(&field), box_(box) {}

    BlockContent content() const {
      const double centre = field_->function_(box_.center());
      const double reach = field_->lipschitz_ * 0.5 * box_.diagonal();
      if (centre < -reach) return BlockContent::kOutside;
      return centre > reach ? BlockContent::kInside : BlockContent::kMixed;
    }
    Block restricted_to(const Box& child) const { return Block(*field_, child); }
    void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  std::span<float> value, float /*band*/) const {
      for (std::size_t i = 0; i < value.size(); ++i) {
        value[i] = static_cast<float>(field_->function_({x[i], y[i], z[i]}));
      }
    }

   private:
    const AnalyticField* field_;
    Box box_;
  };

  explicit AnalyticField(Function function, double lipschitz = std::numeric_limits<double>::infinity())
      : function_(std::move(function)), lipschitz_(lipschitz) {}

  Block gather(const Box& box) const { return Block(*this, box); }

 private:
  Function function_;
  double lipschitz_;
};

inline Box cube(double half_side) {
  return {{-half_side, -half_side, -half_side}, {half_side, half_side, half_side}};
}

}  // namespace astrolith::testing
