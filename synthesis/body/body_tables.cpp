#include "synthesis/body/body_tables.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "synthesis/body/metaball_box.h"
#include "synthesis/body/morph_grid.h"
#include "synthesis/body/surface_projection.h"

namespace astrolith {
namespace {

// The warps of leaves have the streams kBodyStream, kBodyStream - 1, ... of the recipe's seed. The stream of
// a layer is its number in the recipe.
constexpr std::uint32_t kBodyStream = 0xffffffffu;

OperatorParameters<double> operator_parameters(const BodyOperation& operation) {
  return {operation.kind,  operation.alpha, operation.exponent,
          operation.width, operation.bulge, {1.0 / operation.reach[0], 1.0 / operation.reach[1]}};
}

OperatorParameters<float> in_float(const OperatorParameters<double>& o) {
  const auto to = [](double v) { return static_cast<float>(v); };
  return {o.kind,      to(o.alpha), to(o.exponent),
          to(o.width), to(o.bulge), {to(o.inverse_reach[0]), to(o.inverse_reach[1])}};
}

// The largest sum |ds/df| + |ds/dg| of an operator.
double operator_slope(const OperatorParameters<double>& o) {
  const auto r_function = [](double alpha) { return (2.0 + std::sqrt(2.0 * (1.0 - alpha))) / (1.0 + alpha); };
  switch (o.kind) {
    case Operator::kBlend:
      return portable::pow(2.0, 1.0 / o.exponent);
    case Operator::kCleanUnion:  // 3 sqrt(3) / 8 is the steepest slope of 1 / (1 + x^2)
      return r_function(0.0) + 0.6496 * std::fabs(o.bulge) * (o.inverse_reach[0] + o.inverse_reach[1]);
    default:
      return r_function(o.alpha);
  }
}

// The grid of a morph, with its coefficients outside of any store.
struct KeptGrid {
  SplineGrid grid;
  std::vector<float> coefficients;
};

// Builds the leaves and steps of a body and its operands in the order of the recipe.
class BodyBuilder {
 public:
  BodyBuilder(std::uint64_t seed, ArrayStore& arrays, std::vector<KeptGrid>* kept)
      : seed_(seed), arrays_(arrays), kept_(kept) {}

  BodyTables build(const MetaballBody& body) {
    const Part whole = add(body);
    const bool plain = body.operations.empty() && !body.morph;
    if (plain) steps_.clear();
    const bool gridded =
        std::any_of(leaves_.begin(), leaves_.end(), [](const BodyLeaf& leaf) { return leaf.grid.exists(); });
    // The points of a plain body are warped before they are evaluated.
    const Box supports = plain ? plain_supports_ : whole.supports;
    return {arrays_.add(leaves_), arrays_.add(steps_), supports, whole.lipschitz_bound, gridded};
  }

 private:
  struct Part {
    Box supports;
    double lipschitz_bound;
  };

  Part add(const MetaballBody& body) {
    const auto number = static_cast<std::uint32_t>(leaves_.size());
    steps_.push_back({true, number, {}, {}});
    Part part = add_leaf(body, number);
    for (const BodyOperation& operation : body.operations) {
      const Part operand = add(operation.operand.front());
      const OperatorParameters<double> parameters = operator_parameters(operation);
      steps_.push_back({false, 0, in_float(parameters), parameters});
      part.supports.extend(operand.supports.min);
      part.supports.extend(operand.supports.max);
      part.lipschitz_bound =
          std::max(part.lipschitz_bound, operand.lipschitz_bound) * operator_slope(parameters);
    }
    return part;
  }

  Part add_leaf(const MetaballBody& body, std::uint32_t number) {
    if (body.morph) return add_grid(*body.morph);
    const PreparedMetaballs metaballs = prepare_metaballs(body);
    const Box supports = support_bounds(metaballs);
    if (number == 0) plain_supports_ = supports;
    BodyLeaf leaf{metaballs.parameters, body.warp.has_value(), {}, arrays_.add(metaballs.spheres), {}};
    if (leaf.warped) {
      leaf.warp = make_coordinate_warp(*body.warp, hash_seed(seed_, kBodyStream - number), supports, arrays_);
    }
    leaves_.push_back(leaf);
    return {leaf.warped ? widened(supports, leaf.warp.bound) : supports,
            leaf.warped ? leaf.warp.lipschitz_bound : 1.0};
  }

  Part add_grid(const Morph& morph) {
    BodyLeaf leaf;
    leaf.metaballs.gradient_floor = 1e-8f;  // gradients of grids have unit length
    leaf.grid = grid_of(morph);
    leaves_.push_back(leaf);
    const auto& [low, high] = std::pair(leaf.grid.low, leaf.grid.high);
    return {{{low.x, low.y, low.z}, {high.x, high.y, high.z}}, 1.0};
  }

  // The next grid that is kept, or a new one.
  SplineGrid grid_of(const Morph& morph) {
    const std::size_t number = grids_++;
    if (kept_ != nullptr && number < kept_->size()) {
      SplineGrid grid = (*kept_)[number].grid;
      grid.coefficients = arrays_.add((*kept_)[number].coefficients);
      return grid;
    }
    const SplineGrid grid = make_morph_grid(morph, arrays_);
    if (kept_ != nullptr) {
      const std::span<const float> made = arrays_.view().span(grid.coefficients);
      kept_->push_back({grid, {made.begin(), made.end()}});
    }
    return grid;
  }

  std::uint64_t seed_;
  ArrayStore& arrays_;
  std::vector<KeptGrid>* kept_;  // those of the body's morphs in their order; none where null
  std::size_t grids_ = 0;
  std::vector<BodyLeaf> leaves_;
  std::vector<BodyStep> steps_;
  Box plain_supports_;
};

// Four arrays of n floats: a distance and a gradient for each point, or coordinates.
struct Columns {
  std::vector<float> values;
  std::size_t n;
  explicit Columns(int size)
      : values(4 * static_cast<std::size_t>(size)), n(static_cast<std::size_t>(size)) {}
  float* at(std::size_t column) { return values.data() + column * n; }
};

std::span<const MetaballSphere<float>> leaf_spheres(const LeafLists& lists, std::uint32_t leaf) {
  return {lists.spheres + lists.first[leaf], lists.first[leaf + 1] - lists.first[leaf]};
}

ASTROLITH_SIMD_CLONES void divide_by_lengths(float floor, int n, float* __restrict gx, float* __restrict gy,
                                             float* __restrict gz) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const float length = gradient_length(gx[i], gy[i], gz[i], floor);
    gx[i] /= length;
    gy[i] /= length;
    gz[i] /= length;
  }
}

ASTROLITH_SIMD_CLONES void evaluate_grid(const SplineGrid& leaf_grid, const float* coefficients, int n,
                                         const float* __restrict x, const float* __restrict y,
                                         const float* __restrict z, float* __restrict distance,
                                         float* __restrict gx, float* __restrict gy, float* __restrict gz) {
  const SplineGrid grid = leaf_grid;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const BodySample s = spline_distance(grid, coefficients, {x[i], y[i], z[i]});
    distance[i] = s.distance;
    gx[i] = s.gx;
    gy[i] = s.gy;
    gz[i] = s.gz;
  }
}

// Evaluates a leaf as an operand of operations: its gradients are divided by their lengths.
void evaluate_operand(const BodyLeaf& leaf, const ArrayView& arrays,
                      std::span<const MetaballSphere<float>> spheres, int n, const float* x, const float* y,
                      const float* z, Columns& out) {
  if (leaf.grid.exists()) {
    return evaluate_grid(leaf.grid, arrays[leaf.grid.coefficients], n, x, y, z, out.at(0), out.at(1),
                         out.at(2), out.at(3));
  }
  const MetaballsView metaballs{leaf.metaballs, spheres};
  float *gx = out.at(1), *gy = out.at(2), *gz = out.at(3);
  if (leaf.warped) {
    Columns warped(n);
    warp_points(leaf.warp, arrays, n, x, y, z, warped.at(0), warped.at(1), warped.at(2));
    evaluate_metaballs(metaballs, n, warped.at(0), warped.at(1), warped.at(2), out.at(0), gx, gy, gz);
  } else {
    evaluate_metaballs(metaballs, n, x, y, z, out.at(0), gx, gy, gz);
  }
  divide_by_lengths(leaf.metaballs.gradient_floor, n, gx, gy, gz);
}

// Replaces the distances and gradients of `body` by those of its combination with `other`.
ASTROLITH_SIMD_CLONES void combine(const OperatorParameters<float>& parameters, int n,
                                   float* __restrict distance, float* __restrict gx, float* __restrict gy,
                                   float* __restrict gz, const float* __restrict other,
                                   const float* __restrict ox, const float* __restrict oy,
                                   const float* __restrict oz) {
  const OperatorParameters<float> o = parameters;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const BodySample both =
        combined(o, BodySample{distance[i], gx[i], gy[i], gz[i]}, BodySample{other[i], ox[i], oy[i], oz[i]});
    distance[i] = both.distance;
    gx[i] = both.gx;
    gy[i] = both.gy;
    gz[i] = both.gz;
  }
}
void combine(const OperatorParameters<float>& o, int n, Columns& body, Columns& other) {
  combine(o, n, body.at(0), body.at(1), body.at(2), body.at(3), other.at(0), other.at(1), other.at(2),
          other.at(3));
}

}  // namespace

BodyTables make_body(const MetaballBody& body, std::uint64_t seed, ArrayStore& arrays,
                     std::shared_ptr<void>* kept) {
  using KeptGrids = std::vector<KeptGrid>;
  if (kept != nullptr && *kept == nullptr) *kept = std::make_shared<KeptGrids>();
  return BodyBuilder(seed, arrays, kept == nullptr ? nullptr : static_cast<KeptGrids*>(kept->get()))
      .build(body);
}

ReachingMetaballs all_metaballs(const BodyTables& body, const ArrayView& arrays) {
  ReachingMetaballs all;
  for (const BodyLeaf& leaf : arrays.span(body.leaves)) all.add(arrays.span(leaf.spheres));
  return all;
}

ReachingMetaballs metaballs_reaching(const BodyTables& body, const ArrayView& arrays, const LeafLists& lists,
                                     const Box& at) {
  ReachingMetaballs reaching;
  for (std::uint32_t l = 0; l < body.leaves.count; ++l) {
    const double cutoff = double{arrays[body.leaves][l].metaballs.cutoff_squared};
    const Box box = leaf_box(body, arrays, l, at);
    for (const MetaballSphere<float>& sphere : leaf_spheres(lists, l)) {
      if (reaches_box(sphere, cutoff, box)) reaching.spheres.push_back(sphere);
    }
    reaching.first.push_back(static_cast<std::uint32_t>(reaching.spheres.size()));
  }
  return reaching;
}

void evaluate_body(const BodyTables& body, const ArrayView& arrays, const LeafLists& lists, int n,
                   const float* x, const float* y, const float* z, float* distance, float* gradient_x,
                   float* gradient_y, float* gradient_z) {
  const BodyLeaf* leaves = arrays[body.leaves];
  if (body.plain()) {
    return evaluate_metaballs({leaves[0].metaballs, leaf_spheres(lists, 0)}, n, x, y, z, distance, gradient_x,
                              gradient_y, gradient_z);
  }
  std::vector<Columns> stack;
  for (const BodyStep& step : arrays.span(body.steps)) {
    if (step.is_leaf) {
      evaluate_operand(leaves[step.leaf], arrays, leaf_spheres(lists, step.leaf), n, x, y, z,
                       stack.emplace_back(n));
    } else {
      combine(step.combine, n, stack[stack.size() - 2], stack.back());
      stack.pop_back();
    }
  }
  float* const to[] = {distance, gradient_x, gradient_y, gradient_z};
  for (std::size_t column = 0; column < 4; ++column) std::copy_n(stack[0].at(column), n, to[column]);
}

}  // namespace astrolith
