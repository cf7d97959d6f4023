// Maps of a textured mesh that show the whole surface of a recipe, in as fine a detail as the texels resolve.
// Texels around charts are filled, since filters of a renderer read them, too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/progress.h"
#include "synthesis/bake/atlas_texels.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/field/surface_labels.h"

namespace astrolith {

struct BorderCopy {
  std::uint32_t to, from;  // texels, row-major
};

// The texels that are not covered and lie within `reach` rings of eight neighbours of a covered one, each
// with a covered one. Rings grow one after another; of several neighbours in the ring before, the first
// counts: left, right, above, below, then the corners. `covered` is 0 or another number. (side x side)
std::vector<BorderCopy> border_copies(std::span<const std::uint8_t> covered, int side, int reach);

// Copies values into the texels of the borders.
template <typename Value>
void fill_borders(std::span<const BorderCopy> copies, std::size_t channels, std::span<Value> values) {
  for (const BorderCopy& copy : copies) {
    for (std::size_t k = 0; k < channels; ++k)
      values[channels * copy.to + k] = values[channels * copy.from + k];
  }
}

// A mesh of the body to which rays of the occlusion go.
struct BakeOccluder {
  const TriangleMesh& mesh;
  double cell;  // side of its cells, length units
};

struct BakeSources {
  const ImplicitField& field;
  const SurfaceLabels& labels;
  const SurfaceColors* colors;  // null: the recipe has no colours
  BakeOccluder occluder;
};

// The maps, row-major with the top row first, `side` texels wide and high. Texels beyond the borders of
// charts show what a map has without detail.
struct BakedMaps {
  int side = 0;
  // (x 3) Normals in the frame of tangent t, bitangent b and normal n as vertices have them, interpolated and
  // not made unit (MikkTSpace): m = x t + y b + z n has the direction of the surface's normal. Bytes are
  // 127.5 + 127.5 (x, y, z), of unit length; y is towards the image's top (glTF, OpenGL).
  std::vector<std::uint8_t> normal;
  // The way from the mesh to the surface along the mesh's interpolated normal, made unit: `lowest` + value *
  // (`highest` - `lowest`) / 65535, length units.
  std::vector<std::uint16_t> height;
  double lowest = 0.0, highest = 0.0;
  std::vector<std::uint8_t> occlusion;  // share of the sky that is open, weighted by the cosine; 255: all
  // Mean curvature from the differences of normals of neighbouring texels: 128 is flat, 255 a bump and 1 a
  // pit of radius `curvature_radius`, length units, or tighter.
  std::vector<std::uint8_t> curvature;
  double curvature_radius = 0.0;
  std::vector<std::uint8_t> label;  // SurfaceLabels, of 2 x 2 texels; 255 for all labels above
  std::vector<std::uint8_t> color;  // (x 3) sRGB, for viewing; empty where the recipe has no colours
  // (x 3) Normal albedo in red, green and blue over 65535; empty where the recipe states none.
  std::vector<std::uint16_t> albedo;
  std::int64_t covered = 0;  // texels that show a place
  std::int64_t missed = 0;   // of them: those along whose normal no surface was met
};

// Evaluates the field for every texel whose centre lies in a triangle, and pads the charts by kChartPadding
// texels. The field is that of a whole body. Throws WorkError where progress asks to stop. The same bytes for
// any number of threads.
BakedMaps bake_maps(const BakeSources& sources, const TexturedMesh& textured, const Progress& progress);

}  // namespace astrolith
