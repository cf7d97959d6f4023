#include "gravity/solid_harmonics.h"

#include <array>
#include <cstddef>

namespace astrolith {
namespace {

struct RulePoint {
  double at, weight;  // on [0, 1]
};

// P_n(x) and P_(n-1)(x).
std::array<double, 2> legendre(int n, double x) {
  double last = 0.0, now = 1.0;
  for (int l = 1; l <= n; ++l) {
    const double next = ((2 * l - 1) * x * now - (l - 1) * last) / l;
    last = now;
    now = next;
  }
  return {now, last};
}

// The zero of P_n between two zeros of P_(n-1), by bisection down to neighbouring doubles.
double zero_between(int n, double low, double high) {
  const bool rises = legendre(n, high)[0] > legendre(n, low)[0];
  for (int step = 0; step < 80; ++step) {
    const double middle = 0.5 * (low + high);
    ((legendre(n, middle)[0] < 0.0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<RulePoint> gauss_legendre(int n) {
  std::vector<double> zeros;
  for (int order = 1; order <= n; ++order) {
    std::vector<double> fences{-1.0};
    fences.insert(fences.end(), zeros.begin(), zeros.end());
    fences.push_back(1.0);
    zeros.clear();
    for (std::size_t i = 0; i + 1 < fences.size(); ++i)
      zeros.push_back(zero_between(order, fences[i], fences[i + 1]));
  }
  std::vector<RulePoint> rule;
  for (const double x : zeros) {
    const double last = legendre(n, x)[1];
    rule.push_back({0.5 * (x + 1.0), (1.0 - x * x) / (n * last * n * last)});
  }
  return rule;
}

}  // namespace

std::vector<TrianglePoint> triangle_rule(int degree) {
  // The triangle is a square drawn together at one corner, which adds one degree along the first side.
  const std::vector<RulePoint> rule = gauss_legendre((degree + 1) / 2 + 1);
  std::vector<TrianglePoint> points;
  for (const RulePoint& u : rule) {
    for (const RulePoint& v : rule) {
      points.push_back({u.at, v.at * (1.0 - u.at), 2.0 * (1.0 - u.at) * u.weight * v.weight});
    }
  }
  return points;
}

}  // namespace astrolith
