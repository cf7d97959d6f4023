#include "gravity/gravity_tree.h"

#include <algorithm>
#include <cmath>

#include "gravity/solid_harmonics.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/reported_loop.h"
#include "numerics/split_at_rank.h"

namespace astrolith {
namespace {

using Corners = std::array<Vec3d, 3>;

Vec3d area_vector(const Corners& f) { return 0.5 * cross(f[1] - f[0], f[2] - f[0]); }

// Splits the facets of nodes by the median of their centres along the longest side of the box of the centres.
class Splitter {
 public:
  Splitter(GravityTree& tree, std::uint32_t leaf_facets) : tree_(tree), leaf_facets_(leaf_facets) {}

  void split(std::uint32_t first, std::uint32_t count) {
    const std::size_t self = tree_.nodes.size();
    tree_.nodes.push_back({});
    GravityNode node;
    node.first = first;
    node.count = count;
    node.leaf = count <= leaf_facets_ ? 1 : 0;
    if (node.leaf == 0) {
      const std::uint32_t half = count / 2;
      order_about(first, half, count);
      split(first, half);
      split(first + half, count - half);
    }
    node.next = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes[self] = node;
  }

 private:
  void order_about(std::uint32_t first, std::uint32_t half, std::uint32_t count) {
    const auto begin = tree_.facets.begin() + first;
    Box box;
    for (std::uint32_t i = 0; i < count; ++i) box.extend(begin[i][0] + begin[i][1] + begin[i][2]);
    double Vec3d::*const axis = longest_axis(box.extent());
    split_at_rank(begin, begin + half, begin + count, [axis](const Corners& a, const Corners& b) {
      return a[0].*axis + a[1].*axis + a[2].*axis < b[0].*axis + b[1].*axis + b[2].*axis;
    });
  }

  GravityTree& tree_;
  std::uint32_t leaf_facets_;
};

void measure_node(const GravityTree& tree, GravityNode& node) {
  const std::span facets = std::span(tree.facets).subspan(node.first, node.count);
  Box box;
  for (const Corners& f : facets) {
    for (const Vec3d& p : f) box.extend(p);
  }
  node.center = box.center();
  for (const Corners& f : facets) {
    double farthest = 0.0;
    for (const Vec3d& p : f) farthest = std::max(farthest, norm(p - node.center));
    node.radius = std::max(node.radius, farthest);
    double term = norm(area_vector(f));
    node.area += term;
    for (double& spread : node.spread) spread += (term *= farthest);
  }
}

// The indices of all harmonics to an order.
std::vector<std::size_t> places_to(int order) {
  std::vector<std::size_t> places;
  for (int m = 0; m <= order; ++m) {
    for (int l = m; l <= order; ++l) places.push_back(static_cast<std::size_t>(harmonic_index(l, m)));
  }
  return places;
}

// The rule is exact for harmonics to `order`, whose indices are given.
struct Expansion {
  int order;
  std::vector<TrianglePoint> rule;
  std::vector<std::size_t> places;
};

void expand_leaf(std::span<const Corners> facets, const Vec3d& center, const Expansion& expansion,
                 GravityMultipoles& out) {
  Harmonics at, mean;
  for (const Corners& f : facets) {
    mean.fill({});
    for (const TrianglePoint& t : expansion.rule) {
      regular_harmonics(f[0] + t.b * (f[1] - f[0]) + t.c * (f[2] - f[0]) - center, expansion.order, at);
      for (const std::size_t i : expansion.places) {
        mean[i].re += t.weight * at[i].re;
        mean[i].im += t.weight * at[i].im;
      }
    }
    const Vec3d n = area_vector(f);
    const std::array<double, 4> layers{n.x, n.y, n.z, dot(n, f[0] - center)};
    for (const std::size_t i : expansion.places) {
      for (std::size_t k = 0; k < 4; ++k) {
        out.terms[i][k] += layers[k] * mean[i].re;
        out.terms[i][k + 4] += layers[k] * mean[i].im;
      }
    }
  }
}

using Layers = std::array<Harmonics, 4>;

// The multipoles about `center`, whose own layer n . (y - c) is that of the child plus n . (its centre - c).
Layers recentred(const GravityMultipoles& child, const Vec3d& step) {
  Layers layers;
  for (std::size_t i = 0; i < kHarmonics; ++i) {
    const std::array<double, 8>& t = child.terms[i];
    for (std::size_t k = 0; k < 4; ++k) layers[k][i] = {t[k], t[k + 4]};
    layers[3][i].re += step.x * t[0] + step.y * t[1] + step.z * t[2];
    layers[3][i].im += step.x * t[4] + step.y * t[5] + step.z * t[6];
  }
  return layers;
}

void add_shifted(const GravityMultipoles& child, const Vec3d& step, int order, GravityMultipoles& out) {
  Harmonics shift;
  regular_harmonics(step, order, shift);
  const Layers layers = recentred(child, step);
  for (int l = 0; l <= order; ++l) {
    for (int m = 0; m <= l; ++m) {
      std::array<double, 8>& to = out.terms[static_cast<std::size_t>(harmonic_index(l, m))];
      for (int j = 0; j <= l; ++j) {
        for (int k = std::max(-j, m - (l - j)); k <= std::min(j, m + (l - j)); ++k) {
          const HarmonicValue by = signed_harmonic(shift.data(), j, k);
          for (std::size_t n = 0; n < 4; ++n) {
            const HarmonicValue term = by * signed_harmonic(layers[n].data(), l - j, m - k);
            to[n] += term.re;
            to[n + 4] += term.im;
          }
        }
      }
    }
  }
}

// Children stand behind their parents, so that all nodes of one depth can be made at once.
std::vector<std::vector<std::uint32_t>> nodes_by_depth(const GravityTree& tree) {
  std::vector<std::vector<std::uint32_t>> depths;
  std::vector<std::uint32_t> ends;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    while (!ends.empty() && i >= ends.back()) ends.pop_back();
    if (depths.size() <= ends.size()) depths.resize(ends.size() + 1);
    depths[ends.size()].push_back(i);
    ends.push_back(tree.nodes[i].next);
  }
  return depths;
}

void double_terms(GravityMultipoles& m) {
  for (std::size_t at = kMostOrder + 1; at < kHarmonics; ++at) {
    for (double& term : m.terms[at]) term *= 2.0;
  }
}

// The integrals of R_lm over the volume. (y - c) R_lm has the divergence (l + 3) R_lm, so that they are those
// of the layer n . (y - c) over l + 3.
Harmonics volume_multipoles(const GravityMultipoles& surface, int order) {
  Harmonics volume{};
  for (int l = 0; l <= order; ++l) {
    for (int m = 0; m <= l; ++m) {
      const auto i = static_cast<std::size_t>(harmonic_index(l, m));
      volume[i] = {surface.terms[i][3] / (l + 3), surface.terms[i][7] / (l + 3)};
    }
  }
  return volume;
}

// The root mean square over directions of the sum of conj(M_lm) S_lm at distance 1 for one l. The mean square
// of S_lm is (l - m)! (l + m)! / (2 l + 1).
double degree_strength(const Harmonics& volume, int l) {
  double sum = 0.0;
  for (int m = 0; m <= l; ++m) {
    const HarmonicValue& v = volume[static_cast<std::size_t>(harmonic_index(l, m))];
    double square = (m == 0 ? 1.0 : 2.0) / (2 * l + 1);
    for (int k = 2; k <= l - m; ++k) square *= k;
    for (int k = 2; k <= l + m; ++k) square *= k;
    sum += square * (v.re * v.re + v.im * v.im);
  }
  return std::sqrt(sum);
}

// dS_lm/dz = -S_(l+1)m and (d/dx +- i d/dy) S_lm = +-S_(l+1)(m+-1).
void make_far(GravityTree& tree) {
  const Harmonics volume = volume_multipoles(tree.multipoles.front(), tree.most_order);
  const auto at = [&](int l, int m) {
    return std::abs(m) <= l ? signed_harmonic(volume.data(), l, m) : HarmonicValue{};
  };
  for (int l = 0; l <= tree.most_order; ++l) {
    for (int m = 0; m <= l; ++m) {
      const HarmonicValue own = at(l, m), below = at(l - 1, m), less = at(l - 1, m - 1),
                          more = at(l - 1, m + 1);
      tree.far.terms[static_cast<std::size_t>(harmonic_index(l, m))] = {
          0.5 * (more.re - less.re), 0.5 * (less.im + more.im),  below.re, 2.0 * own.re,
          0.5 * (more.im - less.im), -0.5 * (less.re + more.re), below.im, 2.0 * own.im};
    }
  }
  double_terms(tree.far);
  double power = std::fabs(volume[0].re);
  for (int l = 0; l <= tree.most_order; ++l, power *= tree.nodes.front().radius) {
    if (l + 2 >= tree.most_order)
      tree.far_strength = std::max(tree.far_strength, degree_strength(volume, l) / power);
  }
}

void make_multipoles(GravityTree& tree, const Progress& progress) {
  tree.multipoles.assign(tree.nodes.size(), GravityMultipoles{});
  const Expansion expansion{tree.most_order, triangle_rule(tree.most_order), places_to(tree.most_order)};
  const std::vector<std::vector<std::uint32_t>> depths = nodes_by_depth(tree);
  const auto all = static_cast<std::int64_t>(tree.nodes.size());
  std::int64_t done = 0;
  for (auto depth = depths.rbegin(); depth != depths.rend(); ++depth) {
    const auto end = done + static_cast<std::int64_t>(depth->size());
    reported_parallel_for({done, end, all}, progress, "tree of gravity", [&](std::int64_t i) {
      const std::uint32_t at = (*depth)[static_cast<std::size_t>(i - done)];
      const GravityNode& node = tree.nodes[at];
      if (node.leaf != 0) {
        expand_leaf(std::span(tree.facets).subspan(node.first, node.count), node.center, expansion,
                    tree.multipoles[at]);
        return;
      }
      for (const std::uint32_t child : {at + 1, tree.nodes[at + 1].next}) {
        add_shifted(tree.multipoles[child], tree.nodes[child].center - node.center, tree.most_order,
                    tree.multipoles[at]);
      }
    });
    done = end;
  }
  make_far(tree);
  // m and -m give equal terms; the sums take m > 0 only.
  parallel_for(0, static_cast<std::int64_t>(tree.nodes.size()), [&](std::int64_t i) {
    GravityMultipoles& m = tree.multipoles[static_cast<std::size_t>(i)];
    double_terms(m);
  });
}

}  // namespace

GravityTree make_gravity_tree(const TriangleMesh& mesh, const GravityDetail& detail,
                              const Progress& progress) {
  GravityTree tree;
  tree.most_order = detail.most_order;
  const Box bounds = mesh.bounds();
  tree.origin = bounds.center();
  tree.scale = 0.5 * bounds.diagonal();
  if (mesh.triangles.empty() || !(tree.scale > 0.0))
    throw InputError("gravity: the mesh has no facet with an area; give another mesh");
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto scaled = [&](std::uint32_t i) {
      return (mesh.vertices[i] - tree.origin) * (1.0 / tree.scale);
    };
    const Corners f{scaled(a), scaled(b), scaled(c)};
    const double area = norm(area_vector(f));
    if (!(area > 0.0)) continue;
    tree.facets.push_back(f);
    tree.area += area;
    tree.volume += dot(area_vector(f), f[0]) / 3.0;
  }
  if (tree.facets.empty()) throw InputError("gravity: the mesh has no facet with an area; give another mesh");
  Splitter(tree, detail.leaf_facets).split(0, static_cast<std::uint32_t>(tree.facets.size()));
  parallel_for(0, static_cast<std::int64_t>(tree.nodes.size()),
               [&](std::int64_t i) { measure_node(tree, tree.nodes[static_cast<std::size_t>(i)]); });
  make_multipoles(tree, progress);
  return tree;
}

}  // namespace astrolith
