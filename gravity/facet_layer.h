// The potential of a plane triangle that is covered with a layer of unit density, exactly.
//
// Werner & Scheeres, "Exterior gravitation of a polyhedron derived and compared with harmonic and mascon
// gravitation representations of asteroid 4769 Castalia", Celestial Mechanics 65, 1997, sum over edges and
// faces. The edge of two faces stands in their sum twice, once for each face; the terms of one face with its
// three edges are
//   I = integral of dS / r = sum over edges (m_e . r_e) L_e - (n . r) w,
// where r goes from the field point to a point of the face, n is the face's unit normal, m_e the unit normal
// of an edge in the plane of the face, L_e the potential of the edge as a wire and w the signed solid angle.
#pragma once

#include "numerics/branch_free.h"
#include "numerics/host_device.h"
#include "numerics/vec3.h"

namespace astrolith::layer {

// What the sums need of one triangle. A triangle without area has zero vectors, and contributes nothing.
struct Facet {
  Vec3d corner[3];
  Vec3d normal;
  Vec3d along[3];    // unit vectors from corner k to corner k + 1
  Vec3d outward[3];  // unit normals of these edges in the plane of the facet
  double edge[3];    // their lengths
  double twice_area;
};

ASTROLITH_HD inline Facet make_facet(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  Facet f{{a, b, c}, {}, {}, {}, {}, 0.0};
  const Vec3d area = cross(b - a, c - a);
  f.twice_area = norm(area);
  f.normal = f.twice_area > 0.0 ? area * (1.0 / f.twice_area) : Vec3d{};
  for (int k = 0; k < 3; ++k) {
    const Vec3d side = f.corner[(k + 1) % 3] - f.corner[k];
    f.edge[k] = norm(side);
    f.along[k] = f.edge[k] > 0.0 ? side * (1.0 / f.edge[k]) : Vec3d{};
    f.outward[k] = cross(f.along[k], f.normal);
  }
  return f;
}

struct LayerValue {
  double potential;  // I, in length units
  double height;     // n . r: the distance of the field point below the plane
  double rounded;    // the sum of the squares of the terms of I, each as large as its factors may make it
  double square;     // squared distance of the first corner
};

// I at p. Finite and right at points on the facet, on its edges and at its corners.
ASTROLITH_KERNEL LayerValue layer_potential(const Facet& f, double px, double py, double pz) {
  const double ax = f.corner[0].x - px, ay = f.corner[0].y - py, az = f.corner[0].z - pz;
  const double bx = f.corner[1].x - px, by = f.corner[1].y - py, bz = f.corner[1].z - pz;
  const double cx = f.corner[2].x - px, cy = f.corner[2].y - py, cz = f.corner[2].z - pz;
  const double square = ax * ax + ay * ay + az * az;
  const double ra = __builtin_sqrt(square);
  const double rb = __builtin_sqrt(bx * bx + by * by + bz * bz);
  const double rc = __builtin_sqrt(cx * cx + cy * cy + cz * cz);
  const double height = f.normal.x * ax + f.normal.y * ay + f.normal.z * az;
  double rounded = 0.0;
  const auto edge = [&](int k, double x, double y, double z, double r1, double x2, double y2, double z2,
                        double r2) {
    const Vec3d &u = f.along[k], &m = f.outward[k];
    const double t1 = u.x * x + u.y * y + u.z * z, t2 = u.x * x2 + u.y * y2 + u.z * z2;
    const double out = m.x * x + m.y * y + m.z * z;
    const double beside = out * out + height * height;  // squared distance to the line of the edge
    const bool before = t1 > 0.0, behind = t2 <= 0.0;
    const double above = before ? r2 + t2 : behind ? r1 - t1 : (r2 + t2) * (r1 - t1);
    const double below = before ? r1 + t1 : behind ? r2 - t2 : beside;
    const double wire = branch_free::log_ratio(above, below, f.edge[k], r1 + r2), most = r1 * wire;
    rounded += most * most;
    return out * wire;
  };
  const double wires = edge(0, ax, ay, az, ra, bx, by, bz, rb) + edge(1, bx, by, bz, rb, cx, cy, cz, rc) +
                       edge(2, cx, cy, cz, rc, ax, ay, az, ra);
  const double ab = ax * bx + ay * by + az * bz, bc = bx * cx + by * cy + bz * cz,
               ca = cx * ax + cy * ay + cz * az;
  const double solid =
      2.0 * branch_free::atan2(height * f.twice_area, ra * rb * rc + ra * bc + rb * ca + rc * ab);
  const double cone = ra * solid;
  return {wires - height * solid, height, rounded + cone * cone, square};
}

}  // namespace astrolith::layer
