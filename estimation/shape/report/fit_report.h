// A report on a fit: pictures of target and fit, the distances between them, and the convergence of the fit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "descriptor/surface/realism.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

// The verdict on the surface of a fit, with what it was made from. Lengths are fractions of the diagonal.
struct ReportedRealism {
  const RealismVerdict& verdict;
  const SurfaceStatistics& target;
  const TriangleMesh& mesh;  // of the fit with its details, as the verdict took it
  const SurfaceStatistics& fit;
  LengthWords lengths;
};

// Writes these files into the folder, which is made if it is missing. Throws InputError where a file cannot
// be written.
//   target_and_fit.png   target, metaballs alone (where the fit has details) and fit, in the same light
//   distance_map.png     the fit, coloured by distance to the target from 0 (dark) to the 99th percentile
//   error_histogram.png  signed distances of the fit from the target
//   convergence.png      mean distance (logarithmic) against iterations of the refinement
//   quantile_curves.png  with `realism`: local statistics of both surfaces
//   roughness_maps.png   with `realism`: both bodies, coloured by their roughness
//   index.html           a page that needs no other file: both bodies to turn, the target beside another body
//                        of its kind (`likeness`, in the file's frame), these pictures, and tables of the
//                        numbers
void write_fit_report(const TargetBody& target, const ShapeFitResult& fit, const std::string& title,
                      const std::filesystem::path& folder, const ReportedRealism* realism = nullptr,
                      const TriangleMesh* likeness = nullptr);

// The files of the reports in these folders.
std::vector<std::filesystem::path> fit_report_files(const std::vector<std::string>& folders);

}  // namespace astrolith
