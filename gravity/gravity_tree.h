// The surface of a body as a tree of facets, with multipoles of the surface about the centre of each node.
//
// By Gauss' theorem the gravity of a homogeneous body is that of layers on its surface (Werner & Scheeres
// 1997):
//   acceleration = -G rho sum over facets of n I,   potential = G rho / 2 sum over facets of (n . r) I,
// with I the integral of dS / r over a facet. A node holds multipoles of four layers: the components of n and
// n . (y - c), c being the node's centre.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "gravity/solid_harmonics.h"
#include "numerics/progress.h"

namespace astrolith {

// One node. The facets of a node follow each other in the order of the tree.
struct GravityNode {
  Vec3d center;
  double radius = 0.0;  // of a ball about the centre that holds the node's facets
  double area = 0.0;
  std::uint32_t first = 0, count = 0;  // facets
  std::uint32_t next = 0;              // node to go on with when this one is not opened
  std::uint32_t leaf = 0;              // 1 where the node has no children; its first child stands behind it
  // spread[q] is no less than the integral of |y - c|^(q + 1) over the node's facets. It bounds the error of
  // the multipoles to order q by spread[q] / (d^(q + 1) (d - radius)) at distance d.
  std::array<double, kMostOrder + 1> spread{};
};

// The multipoles of one node: four layers for each harmonic, real parts and then imaginary parts. They make
// up the memory of a tree: 4,224 bytes a node, which are 350 to 700 a facet. Floats would halve that, but
// could not keep tolerances down to 1e-12.
struct GravityMultipoles {
  std::array<std::array<double, 8>, kHarmonics> terms;
};

// How fine a tree is. A coarse tree is made faster.
struct GravityDetail {
  int most_order = kMostOrder;     // of its multipoles, in [0, kMostOrder]
  std::uint32_t leaf_facets = 24;  // a node with at most this many facets is not split, >= 1
};

// The tables; lengths are in units of `scale` and relative to `origin`. Nodes are in depth-first order.
struct GravityTree {
  Vec3d origin;
  double scale = 1.0;
  double area = 0.0, volume = 0.0;  // of the whole, in the tables' units
  int most_order = kMostOrder;      // terms of higher orders are zero
  std::vector<std::array<Vec3d, 3>> facets;
  std::vector<GravityNode> nodes;
  std::vector<GravityMultipoles> multipoles;
  // The multipoles of the body's volume about the centre of the first node: twice the potential to order
  // most_order, and the acceleration, turned round, of its terms below most_order. A sum over the surface
  // loses digits with the distance, because almost all of it cancels; of these terms none cancel.
  GravityMultipoles far{};
  // How strong the potential's last terms are, l = most_order - 2 to most_order: the largest root mean square
  // over directions at distance d, as a multiple of (first node's radius / d)^l volume / d.
  double far_strength = 0.0;
};

// Builds the tables of a mesh with indices in range and at least one triangle of positive area. Throws
// InputError where there is none, and WorkError when progress asks to stop.
GravityTree make_gravity_tree(const TriangleMesh& mesh, const GravityDetail& detail = {},
                              const Progress& progress = {});

// Sums over all facets for 16 points in the tables' units, added to: layers[k] is the sum of n_k I, work the
// sum of (n . r) I. What a point gets depends on no other point of its batch.
constexpr int kPointBatch = 16;
using PointRow = std::array<double, kPointBatch>;
struct GravityBatch {
  PointRow x{}, y{}, z{};
};
struct GravitySums {
  std::array<PointRow, 3> layers{};
  PointRow work{};
};
// The sums of squares of what is rounded on the way to the sums, for the vector of the layers and for work.
// Their square roots times 2^-53 estimate the errors.
struct RoundedSquares {
  PointRow layers{}, work{};
};
// `on` is 1 for points that get the facets and 0 for others.
void add_facets(std::span<const std::array<Vec3d, 3>> facets, const GravityBatch& points, const PointRow& on,
                GravitySums& sums);
void add_facets(std::span<const std::array<Vec3d, 3>> facets, const GravityBatch& points, const PointRow& on,
                GravitySums& sums, RoundedSquares& rounded);
// Each point has an order of its own, a whole number to kMostOrder; nothing is added where it is below 0.
void add_multipoles(const GravityNode& node, const GravityMultipoles& multipoles, const PointRow& order,
                    const GravityBatch& points, GravitySums& sums);
// The whole body by tree.far, for points that are on.
void add_far_body(const GravityTree& tree, const PointRow& on, const GravityBatch& points, GravitySums& sums);

}  // namespace astrolith
