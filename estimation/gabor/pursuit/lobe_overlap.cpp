#include "estimation/gabor/pursuit/lobe_overlap.h"

#include <algorithm>

#include "estimation/gabor/pursuit/gabor_dictionary.h"

namespace astrolith {
namespace {

constexpr double kNegligible = 1e-14;

struct AxisTerm {
  std::size_t bin;
  double value;
};

// The products a_i b_i (or a_i b_-i) that are not negligible.
void axis_product(const std::vector<double>& a, const std::vector<double>& b, bool mirrored,
                  std::vector<AxisTerm>& terms) {
  terms.clear();
  const std::size_t n = a.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double value = a[i] * b[mirrored ? (n - i) % n : i];
    if (value > kNegligible) terms.push_back({i, value});
  }
}

void axis_terms(const std::vector<double>& a, std::vector<AxisTerm>& terms) {
  terms.clear();
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > kNegligible) terms.push_back({i, a[i]});
  }
}

double weighted_sum(const std::vector<double>& grid, const std::vector<AxisTerm>& xs,
                    const std::vector<AxisTerm>& ys, std::size_t width) {
  double total = 0.0;
  for (const AxisTerm& y : ys) {
    const double* row = grid.data() + y.bin * width;
    double sum = 0.0;
    for (const AxisTerm& x : xs) sum += row[x.bin] * x.value;
    total += sum * y.value;
  }
  return total;
}

}  // namespace

LobeProfile make_lobe_profile(int width, int height, double center_x, double center_y, double deviation_x,
                              double deviation_y, double amplitude) {
  return {periodic_gaussian(width, center_x, deviation_x), periodic_gaussian(height, center_y, deviation_y),
          amplitude};
}

// <a, b> = 2 <g_a(f - m_a), b>, since the metric and b are symmetric.
double lobe_overlap(const std::vector<double>& metric, const LobeProfile& a, const LobeProfile& b) {
  std::vector<AxisTerm> xs;
  std::vector<AxisTerm> ys;
  double total = 0.0;
  for (const bool mirrored : {false, true}) {
    axis_product(a.x, b.x, mirrored, xs);
    axis_product(a.y, b.y, mirrored, ys);
    total += weighted_sum(metric, xs, ys, a.x.size());
  }
  return 2.0 * a.amplitude * b.amplitude * total;
}

double lobe_sum(const std::vector<double>& grid, const LobeProfile& a) {
  std::vector<AxisTerm> xs;
  std::vector<AxisTerm> ys;
  axis_terms(a.x, xs);
  axis_terms(a.y, ys);
  return 2.0 * a.amplitude * weighted_sum(grid, xs, ys, a.x.size());
}

void add_lobe(const LobeProfile& a, double factor, std::vector<double>& grid) {
  std::vector<AxisTerm> xs;
  std::vector<AxisTerm> ys;
  axis_terms(a.x, xs);
  axis_terms(a.y, ys);
  const std::size_t w = a.x.size();
  const std::size_t h = a.y.size();
  for (const AxisTerm& y : ys) {
    const double height = factor * a.amplitude * y.value;
    double* row = grid.data() + y.bin * w;
    double* mirror = grid.data() + (h - y.bin) % h * w;
    for (const AxisTerm& x : xs) {
      row[x.bin] += height * x.value;
      mirror[(w - x.bin) % w] += height * x.value;
    }
  }
}

}  // namespace astrolith
