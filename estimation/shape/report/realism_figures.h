// Figures that show what two surfaces are like from place to place.
#pragma once

#include <filesystem>
#include <string>

#include "descriptor/surface/surface_statistics.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// A surface in a figure.
struct NamedSurface {
  const std::string& name;
  const TriangleMesh& mesh;
  const SurfaceStatistics& statistics;
};

// Writes a PNG with the quantile curves of both surfaces, a diagram for each statistic that both have: the
// value over the share of places below it, from 1 % to 99 %. Throws InputError where the file cannot be
// written.
void write_quantile_curves(const NamedSurface& a, const NamedSurface& b, const std::filesystem::path& file);

// Writes a PNG with both bodies, coloured by the roughness within 6 edges (or the smallest radius) around
// each place. The colours run from the 5 % to the 95 % quantile of the first. Throws as above.
void write_roughness_maps(const NamedSurface& a, const NamedSurface& b, const std::filesystem::path& file);

}  // namespace astrolith
