// Points near the bare surface, and their projections on it, as the synthesis evaluates them.
#pragma once

#include <vector>

#include "synthesis/body/body_ground.h"

namespace astrolith {

// Points, and s and grad L (synthesis/body/metaballs.h) there; length units.
struct GroundPoints {
  std::vector<float> x, y, z, distance, gx, gy, gz;

  explicit GroundPoints(std::size_t n) : x(n), y(n), z(n), distance(n), gx(n), gy(n), gz(n) {}
  explicit GroundPoints(const std::vector<Vec3d>& points);
  void resize(std::size_t n) {
    for (std::vector<float>* v : {&x, &y, &z, &distance, &gx, &gy, &gz}) v->resize(n);
  }
  std::size_t size() const { return x.size(); }
  Vec3f at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3f gradient(std::size_t i) const { return {gx[i], gy[i], gz[i]}; }
};

// Evaluates the bare body at the points, which are relative to ground.origin where there is one. They should
// lie close together: the metaballs that reach the box around them are visited for each.
void evaluate(const BodyGround& ground, GroundPoints& points);

// Moves the points, which were evaluated, to their first-order projections (surface_projection.h). Distances
// and gradients stay as they are. Expects a plain body.
void project(const BodyGround& ground, GroundPoints& points);

}  // namespace astrolith
