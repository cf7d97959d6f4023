// The bowl and rim that fit a piece of surface best, and how well they do.
#pragma once

#include <array>
#include <optional>

#include "descriptor/features/scale_space.h"
#include "descriptor/surface/evened_surface.h"
#include "geometry/points/point_tree_internal.h"

namespace astrolith {

// What tells craters from other hollows; none has a unit.
struct FitMeasures {
  double explained = 0.0;  // share of the variance about the quadric that bowl and rim explain
  double walls = 0.0;      // share of the sectors whose rim stands above the floor by half the relief
  double crests = 0.0;     // share of the sectors whose rim also stands above the ground outside
  double saddle = 0.0;     // what the quadric bends one way and not the other, over the relief
  double bend = 0.0;       // what the quadric bends alike, over the relief
  double residual = 0.0;   // rms over the relief, depth + rim
  double inner = 0.0;      // the same within the rim
};

// A bowl with a rim, or turned over a dome. Lengths are in the mesh's unit.
struct CraterFit {
  Vec3d center;  // of the circle of the rim, at the height of the ground around
  Vec3d normal;
  double radius = 0.0, depth = 0.0, rim_height = 0.0;
  FitMeasures measures;
};

// Fits, in the frame of a normal and with t the distance from the centre over the radius a,
//   z = q(x, y) + depth B(t) + rim R(t),
//   B = t^2 - 1 within the rim, 0 outside;   R = t^2 within, ((2.5 - t) / 1.5)^3 outside
// (the profile of recipe/landforms.h), with a quadric q for the ground. Points within 1.8 a count that look
// the same way; Cauchy's weights take off what other craters have changed. Centre and radius follow by
// Gauss-Newton steps, from `radius` at the blob. None where points are few, or nothing is left of the bowl.
class CraterFitter {
 public:
  // The surface must outlive the object. For bumps heights count downwards.
  CraterFitter(const EvenedSurface& even, BlobSign sign);
  std::optional<CraterFit> fit(const SurfaceBlob& blob, double radius) const;

 private:
  bool is_on_surface(const CraterFit& fit) const;

  const EvenedSurface& even_;
  PointTree tree_;
  double sign_;
};

}  // namespace astrolith
