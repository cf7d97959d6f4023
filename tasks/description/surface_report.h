// The statistics of a surface, and the verdict on two surfaces, as JSON and as a table.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "descriptor/surface/realism.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "tasks/description/comparison.h"

namespace astrolith {

// Words for lengths of about `length` in a unit, "m" or "km": kilometres below 1 become metres. Without a
// unit lengths are "units".
LengthWords words_for_lengths(const std::string& unit, double length);

// Measures the mesh of a file; error messages begin with its name.
SurfaceStatistics describe_surface(const NamedMesh& shape, const SurfaceStatisticsOptions& options,
                                   const Progress& progress);

// The figures of a surface. Distributions are given by five quantiles, the mean and the standard deviation.
// Lengths are in the mesh's unit where their names say nothing else.
nlohmann::ordered_json surface_json(const SurfaceStatistics& surface);

// The name of a statistic in tables: "roughness_3", "skewness_12", "slope".
std::string column_name(const LocalStatistic& statistic);

// Writes one line for each place: x, y, z, its region and every local statistic.
void write_surface_table(const SurfaceStatistics& surface, const std::filesystem::path& file);

// The verdict with its words. Lengths are in the unit of the first mesh.
nlohmann::ordered_json realism_json(const RealismVerdict& verdict, const LengthWords& lengths);

struct SurfaceComparison {
  RealismVerdict verdict;
  std::vector<std::string> lines;  // for people, with the floor where it is asked for
  nlohmann::ordered_json figures;  // realism_json(), with the floor where it is asked for
  SurfaceStatistics a, b;
};

// Judges whether b passes for a. Both are sampled at common_points(). `with_floor` adds the verdict on a
// second sampling of a: a larger p and a smaller distance cannot be expected. The words take `unit` for that
// of both meshes: "m", "km" or "".
SurfaceComparison judge_surfaces(const NamedMesh& a, const NamedMesh& b, SurfaceStatisticsOptions options,
                                 bool with_floor, const std::string& unit, const StageProgress& progress);

}  // namespace astrolith
