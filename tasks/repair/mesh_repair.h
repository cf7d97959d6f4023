// Makes a closed body of a mesh that is open, not manifold, wound both ways or in several pieces, and says
// what was done.
//
//   const MeshRepair repair = repair_mesh(read_mesh("eros.obj"), "eros.obj", {});
//   if (repair.changed) std::cerr << repair_words(repair, "km") << "\n";
//
// The steps, each of which leaves alone what needs no repair:
//   1. vertices at one place become one, repeated and empty facets go, facets are wound alike and outwards;
//   2. fins go: patches with a free border that hang on an edge of three or more facets; so does debris, open
//      pieces of less than 1 % of the surface;
//   3. borders are stitched: vertices within 0.45 of the shortest border edge at both become one, and a facet
//      is split where another's vertex lies on its border edge;
//   4. CGAL winds the rest, cuts it open at edges of three or more facets, stitches equal places, fills
//   holes;
//   5. where the caller found that the mesh passes through itself, CGAL replaces the facets that cross.
// Points without faces get a Poisson surface (point_surface_internal.h). A wrap is the last resort of meshes:
// a surface around the mesh through which balls of 1/200 of the diagonal do not pass, whose vertices then
// move back onto the mesh. Where such balls pass through a hole, they are larger: 3, 9 or 27 times.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// A repair that moves the surface farther than this share of the diagonal of the bounding box, or that fills
// holes of more than this share of the surface, is refused.
inline constexpr double kMostMoved = 0.01, kMostFilled = 0.05;
// Where a wrap is allowed, holes up to this share are filled, and the mesh is wrapped where they are larger.
inline constexpr double kMostFilledBeforeWrap = 0.2;

// Lengths of the wrap, as shares of the diagonal of the bounding box.
inline constexpr double kWrapAlpha = 1.0 / 200.0, kWrapOffset = 1.0 / 2000.0;

struct RepairOptions {
  bool wrap = false;         // where the steps fail, move or fill too much, the mesh is wrapped
  bool all_parts = false;    // keep all bodies of a scene; otherwise the largest
  bool unite = false;        // make one surface of parts that overlap or lie in one another
  bool fill_unseen = false;  // a surface through points may be a guess where no point saw it
  // The caller found that the mesh passes through itself.
  bool crossings = false;
  // What messages say to do where a wrap would help.
  std::string remedy = "repair it, or add --wrap";
  // What messages say of parts that overlap, and to do about it.
  std::string overlap = "rock counts twice, and walls lie inside it; --union makes one surface of them";
};

// All counts are 0 where nothing was done. Shares are of the area of the surface.
struct MeshRepair {
  TriangleMesh mesh;  // closed, every edge has two facets, wound alike and outwards
  bool changed = false;
  double diagonal = 0.0;  // of the mesh as it was, in its unit
  std::int64_t merged_vertices = 0;
  std::int64_t turned_facets = 0;
  std::int64_t dropped_facets = 0;  // repeated, empty, of fins and of debris
  double dropped_share = 0.0;       // of fins and debris
  std::int64_t stitched_edges = 0;
  std::int64_t split_facets = 0;  // facets whose border edge held another's vertex
  std::int64_t holes = 0;
  double filled_share = 0.0, largest_hole = 0.0;
  std::int64_t crossing_facets = 0;
  // The greatest distance by which a vertex left the surface as it was, in its unit. Vertices that fill holes
  // are not counted, but those of a wrap are.
  double moved = 0.0;
  bool wrapped = false;
  double wrap_alpha = 0.0, wrap_offset = 0.0;  // in the unit of the mesh
  std::int64_t bodies = 1;                     // bodies of the scene, apart from one another
  double kept_volume = 1.0;                    // share of the volume of all bodies that the mesh has
  std::int64_t overlapping_parts = 0;          // that reach into a larger one of the same body
  std::int64_t nested_parts = 0;               // inside a larger one, as if rock lay in rock
  std::int64_t cavities = 0;
  std::int64_t undecided_parts = 0;  // of which finding this out would have taken too long
  bool united = false;               // overlapping and nested parts are one surface now
  // What is known of a surface through points; lengths in the unit of the mesh.
  std::int64_t points = 0, stray_points = 0;
  Vec3d stray;                                         // the farthest of them
  double noise = 0.0;                                  // root mean square of the points' distances from it
  double farthest_point = 0.0, farthest_ground = 0.0;  // of the points from it, and of it from the points
  double unseen_share = 0.0;                           // of the ground that no point saw
};

// Reads a mesh. Where a wrap is allowed also points, as read_cloud() does. Throws InputError as read_mesh
// does.
TriangleMesh read_mesh_to_repair(const std::filesystem::path& file, bool wrap);

// Repairs a mesh, or lays a surface through points where it has no triangles and a wrap is allowed. A mesh
// that is a closed body of one part comes back as it is. Throws InputError "NAME: what is wrong; what to do"
// for what cannot be repaired, and WorkError where progress asks to stop. The result depends on the mesh and
// the options alone. The work is bounded by the number of facets: a mesh too damaged for that is refused.
MeshRepair repair_mesh(TriangleMesh mesh, const std::string& name, const RepairOptions& options,
                       const Progress& progress = {});

// Repairs a surface, which need not be closed: all bodies of a scene are kept, and a mesh that cannot be
// repaired, such as a patch, has its equal vertices merged and its facets wound alike. Points without faces
// come back as they are unless a wrap is allowed. Throws what repair_mesh throws where a wrap or a union is
// asked for.
MeshRepair mend_surface(TriangleMesh mesh, const std::string& name, RepairOptions options,
                        const Progress& progress = {});

// Reads a mesh, or points with normals, and mends it. `remark` says what was done or that the mesh is open,
// with the file's name, and is empty otherwise. Throws InputError as read_mesh does.
TriangleMesh read_mended_surface(const std::filesystem::path& file, std::string& remark);

// "stitched 412 edges, filled 3 holes (largest 2.1 % of the surface), nothing moved by more than 0.3 m". An
// empty `unit` gives the distance in percent of the diagonal. Empty where nothing was done and the mesh is
// one part.
std::string repair_words(const MeshRepair& repair, const std::string& unit,
                         const RepairOptions& options = {});

// Whether the mesh has several parts, of which the words say how they lie.
bool mentions_parts(const MeshRepair& repair);

// The fields repair.* of apps/summary_fields.json.
nlohmann::ordered_json repair_json(const MeshRepair& repair);

}  // namespace astrolith
