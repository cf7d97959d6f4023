#include "synthesis/body/combined_body.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/body/operator_bounds.h"
#include "synthesis/body/surface_projection.h"

namespace astrolith {
namespace {

constexpr std::uint32_t kBodyStream =
    0xffffffffu;  // of the recipe's seed, downwards; layers have their numbers

OperatorParameters<double> parameters_of(const BodyOperation& operation) {
  return {operation.kind,  operation.alpha, operation.exponent,
          operation.width, operation.bulge, {1.0 / operation.reach[0], 1.0 / operation.reach[1]}};
}

// `next` counts the metaballs of the whole recipe.
PreparedBody prepare_part(const MetaballBody& body, std::uint64_t seed, std::uint32_t& next) {
  PreparedBody part{prepare_metaballs(body), nullptr, {}};
  const std::uint32_t number = next++;
  if (body.warp) {
    part.warp = std::make_shared<const CoordinateWarp>(*body.warp, body_warp_seed(seed, number),
                                                       support_bounds(part.metaballs));
  }
  for (const BodyOperation& operation : body.operations) {
    part.operations.push_back(
        {parameters_of(operation), prepare_part(operation.operand.front(), seed, next)});
  }
  return part;
}

// Points' distances and gradients, or coordinates and more.
struct Columns {
  std::vector<float> values;
  std::size_t n;
  explicit Columns(int size)
      : values(4 * static_cast<std::size_t>(size)), n(static_cast<std::size_t>(size)) {}
  float* at(std::size_t column) { return values.data() + column * n; }
};

// The metaballs alone, gradients divided by their lengths.
void evaluate_leaf(const PreparedBody& body, int n, const float* x, const float* y, const float* z,
                   float* distance, float* gx, float* gy, float* gz) {
  if (body.warp) {
    Columns warped(n);
    body.warp->evaluate(n, x, y, z, warped.at(0), warped.at(1), warped.at(2));
    evaluate_metaballs(body.metaballs, n, warped.at(0), warped.at(1), warped.at(2), distance, gx, gy, gz);
  } else {
    evaluate_metaballs(body.metaballs, n, x, y, z, distance, gx, gy, gz);
  }
  const float floor = body.metaballs.parameters.gradient_floor;
  for (int i = 0; i < n; ++i) {
    const float length = gradient_length(gx[i], gy[i], gz[i], floor);
    gx[i] /= length;
    gy[i] /= length;
    gz[i] /= length;
  }
}

void combine(const OperatorParameters<double>& parameters, int n, Columns& other, float* distance, float* gx,
             float* gy, float* gz) {
  const OperatorParameters<float> o = in_float(parameters);
  const float *g = other.at(0), *ox = other.at(1), *oy = other.at(2), *oz = other.at(3);
  for (int i = 0; i < n; ++i) {
    const BodySample both =
        combined(o, BodySample{distance[i], gx[i], gy[i], gz[i]}, BodySample{g[i], ox[i], oy[i], oz[i]});
    distance[i] = both.distance;
    gx[i] = both.gx;
    gy[i] = both.gy;
    gz[i] = both.gz;
  }
}

Interval bound_leaf(const PreparedBody& body, const Box& box, double height) {
  const Box at = body.warp ? body.warp->image(box) : box;
  const MetaballInterval all = bound_metaballs(body.metaballs, at);
  const double near =
      is_off_surface(all, height) ? bound_metaballs(body.metaballs, at, height).gradient_max : 0.0;
  return bound_leaf_distance(body.metaballs.parameters, all, height, near);
}

// The largest sum of |ds/df| and |ds/dg|.
double slope_of(const OperatorParameters<double>& o) {
  const auto r_function = [](double alpha) { return (2.0 + std::sqrt(2.0 * (1.0 - alpha))) / (1.0 + alpha); };
  switch (o.kind) {
    case Operator::kBlend:
      return std::pow(2.0, 1.0 / o.exponent);
    case Operator::kCleanUnion:  // 3 sqrt(3) / 8 is the steepest slope of 1 / (1 + x^2)
      return r_function(0.0) + 0.6496 * std::fabs(o.bulge) * (o.inverse_reach[0] + o.inverse_reach[1]);
    default:
      return r_function(o.alpha);
  }
}

}  // namespace

OperatorParameters<float> in_float(const OperatorParameters<double>& o) {
  const auto to = [](double v) { return static_cast<float>(v); };
  return {o.kind,      to(o.alpha), to(o.exponent),
          to(o.width), to(o.bulge), {to(o.inverse_reach[0]), to(o.inverse_reach[1])}};
}

std::uint32_t body_warp_seed(std::uint64_t seed, std::uint32_t n) { return hash_seed(seed, kBodyStream - n); }

PreparedBody prepare_body(const MetaballBody& body, std::uint64_t seed) {
  if (body.operations.empty()) return {prepare_metaballs(body), nullptr, {}};
  std::uint32_t next = 0;
  return prepare_part(body, seed, next);
}

PreparedBody body_reaching(const PreparedBody& body, const Box& box) {
  PreparedBody reaching{
      metaballs_reaching(body.metaballs, body.warp ? body.warp->image(box) : box), body.warp, {}};
  for (const PreparedOperation& o : body.operations) {
    reaching.operations.push_back({o.parameters, body_reaching(o.operand, box)});
  }
  return reaching;
}

Box support_bounds(const PreparedBody& body) {
  const Box own = support_bounds(body.metaballs);
  Box box = body.warp ? widened(own, body.warp->bound()) : own;
  for (const PreparedOperation& o : body.operations) {
    const Box operand = support_bounds(o.operand);
    box.extend(operand.min);
    box.extend(operand.max);
  }
  return box;
}

void evaluate_body(const PreparedBody& body, int n, const float* x, const float* y, const float* z,
                   float* distance, float* gradient_x, float* gradient_y, float* gradient_z) {
  if (body.plain()) {
    return evaluate_metaballs(body.metaballs, n, x, y, z, distance, gradient_x, gradient_y, gradient_z);
  }
  evaluate_leaf(body, n, x, y, z, distance, gradient_x, gradient_y, gradient_z);
  Columns other(n);
  for (const PreparedOperation& o : body.operations) {
    const PreparedBody& operand = o.operand;
    const auto evaluate = operand.operations.empty() ? evaluate_leaf : evaluate_body;
    evaluate(operand, n, x, y, z, other.at(0), other.at(1), other.at(2), other.at(3));
    combine(o.parameters, n, other, distance, gradient_x, gradient_y, gradient_z);
  }
}

Interval bound_distance(const PreparedBody& body, const Box& box, double height) {
  Interval s = bound_leaf(body, box, height);
  for (const PreparedOperation& o : body.operations) {
    s = bound_combined(o.parameters, s, bound_distance(o.operand, box, height));
  }
  return s;
}

double lipschitz_bound_of(const PreparedBody& body) {
  double lipschitz_bound = body.warp ? body.warp->lipschitz_bound() : 1.0;
  for (const PreparedOperation& o : body.operations) {
    lipschitz_bound = std::max(lipschitz_bound, lipschitz_bound_of(o.operand)) * slope_of(o.parameters);
  }
  return lipschitz_bound;
}

}  // namespace astrolith
