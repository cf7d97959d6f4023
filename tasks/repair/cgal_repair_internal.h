// What CGAL does for a repair. Its headers are included by two sources alone. Builds without the fitting
// packages have no CGAL: these functions then throw InputError.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct FilledMesh {
  TriangleMesh mesh;                // consistently wound, edges of one or two facets
  std::int64_t stitched_edges = 0;  // pairs of border edges at equal places that became one edge
  std::vector<double> holes;        // area of the facets that fill each hole, in the order of the holes
};

// Winds the facets alike, cuts the mesh open along edges of three or more facets, stitches borders at equal
// places, and fills the holes that are left. A hole of many edges is filled by facets as large as those
// around it, which continue the bend of the surface. Vertices that were given stay where they are. Throws
// InputError "NAME: what is wrong" for holes that cannot be filled, or that would take too long.
FilledMesh fill_holes(const TriangleMesh& mesh, const std::string& name, const Progress& progress);

struct UncrossedMesh {
  TriangleMesh mesh;
  std::int64_t crossing_facets = 0;  // facets that passed through others
  bool has_no_crossings = false;
};

// Replaces the facets of a closed mesh that pass through others. Throws InputError where they are too many.
UncrossedMesh remove_crossings(const TriangleMesh& mesh, const std::string& name, const Progress& progress);

// The wrap of Portaneri and others, "Alpha wrapping with an offset", ACM Transactions on Graphics 2022: a
// closed surface without crossings around the mesh. Balls of radius `alpha` do not pass through it, and it
// lies about `offset` outside. Lengths are those of the mesh.
TriangleMesh alpha_wrapped(const TriangleMesh& mesh, double alpha, double offset, const std::string& name);

// Each point moved onto a surface of second degree through its `neighbours` nearest ones, by least squares.
std::vector<Vec3d> jet_smoothed(std::vector<Vec3d> points, int neighbours);

// Unit normals of such surfaces (Cazals and Pouget, 2005), turned alike along a minimal spanning tree (Hoppe
// and others, 1992). Which of the two ways is outwards is not known. A normal that cannot be turned is zero.
std::vector<Vec3d> jet_normals(const std::vector<Vec3d>& points, int neighbours);

// The surface of the indicator function whose gradient the outward normals are (Kazhdan and others, "Poisson
// surface reconstruction", 2006): closed, with facets of at most the radius `facet`, within `error` of the
// surface. Empty where there is none. The same in every run.
TriangleMesh poisson_surface(const std::vector<Vec3d>& points, const std::vector<Vec3d>& normals,
                             double facet, double error, const std::string& name);

// The surface of the union of all components, each of which is closed, less the cavities: components of
// negative volume. A smaller component may lie in a larger cavity. No walls are buried. Computed exactly, and
// rounded to doubles at the end. Throws InputError for a component that passes through itself, and for
// those that touch so that no closed surface bounds their union.
TriangleMesh united(const TriangleMesh& mesh, const std::string& name, const Progress& progress);

}  // namespace astrolith
