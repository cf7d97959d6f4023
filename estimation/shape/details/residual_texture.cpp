#include "estimation/shape/details/residual_texture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/image_channels.h"
#include "estimation/shape/details/surface_probe.h"
#include "estimation/shape/model/metaball_model.h"
#include "numerics/errors.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// Heights lie within this distance of the base (fraction of the diagonal).
constexpr double kTextureReach = 0.05;

// The cosine of the largest angle between a normal of the base in a patch and the normal in its middle.
// Beyond this angle the tangent plane is distorted, and at last no longer a chart.
constexpr double kLeastCosine = 0.7;

// A patch with a height above this multiple of the median is left out: such a height does not belong to a
// texture.
constexpr double kStrayPatch = 12.0;

struct Patch {
  std::vector<ProbePoint> points;  // (side x side) on the base
  bool flat = false;
};

// The axes of a texture as in synthesis/gabor/gabor_surface_noise.h: east is tangent to the circle about +z,
// and south follows.
void east_and_south(const Vec3d& n, Vec3d& east, Vec3d& south) {
  const Vec3d about = cross(Vec3d{0, 0, 1}, n);
  east = squared_norm(about) > 1e-12 ? normalized(about) : Vec3d{1, 0, 0};
  south = cross(east, n);
}

// Projects a grid in the tangent plane at q onto the base along the base's gradient.
Patch make_patch(const MetaballModel& base, const Vec3d& q, const Vec3d& n, int side, double pixel) {
  Vec3d east, south;
  east_and_south(n, east, south);
  std::vector<Vec3d> grid;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      grid.push_back(q + pixel * (x - 0.5 * (side - 1)) * east + pixel * (y - 0.5 * (side - 1)) * south);
    }
  }
  const SurfaceSamples on_base = project_onto_isosurface(base, grid);
  Patch patch;
  double least = 1.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    patch.points.push_back({on_base.points[i], on_base.normals[i]});
    least = std::min(least, dot(on_base.normals[i], n));
  }
  patch.flat = least >= kLeastCosine;
  return patch;
}

// The detrended heights of every patch that is flat and has no strays.
std::vector<GreyImage> residual_patches(const TargetBody& target, const MetaballModel& base,
                                        const ResidualTextureOptions& options, double pixel) {
  const SurfaceSamples sites = project_onto_isosurface(
      base, sample_poisson_disk(target.surface, options.patches, options.seed).points);
  std::vector<GreyImage> images;
  for (std::size_t i = 0; i < sites.points.size(); ++i) {
    const Patch patch = make_patch(base, sites.points[i], sites.normals[i], options.side, pixel);
    if (!patch.flat) continue;
    GreyImage image{options.side, options.side, target_heights(target.tree, patch.points, kTextureReach)};
    const double most = kStrayPatch * median_magnitude(image.values);
    if (std::any_of(image.values.begin(), image.values.end(),
                    [&](double h) { return std::fabs(h) > most; })) {
      continue;
    }
    remove_trend(image, 1, TrendModel::kAdded, "residual");
    images.push_back(std::move(image));
  }
  return images;
}

// The mean of the patches' periodograms. Overlapping patches are not independent, so there are at most as
// many looks as patches fit side by side on the surface.
PowerSpectrum mean_periodogram(const std::vector<GreyImage>& images, double area_in_patches) {
  PowerSpectrum mean;
  double looks = 0.0;
  for (const GreyImage& image : images) {
    const PowerSpectrum one = exemplar_periodogram(image);
    if (mean.power.empty()) mean = {one.width, one.height, std::vector<double>(one.power.size(), 0.0), 1.0};
    for (std::size_t i = 0; i < mean.power.size(); ++i) mean.power[i] += one.power[i];
    looks += one.averages;
  }
  const double n = static_cast<double>(images.size());
  for (double& p : mean.power) p /= n;
  mean.averages = std::max(1.0, looks * std::min(1.0, area_in_patches / n));
  mean.scatter = 1.0 / mean.averages;
  return mean;
}

}  // namespace

ResidualTexture fit_residual_texture(const TargetBody& target, const MetaballBody& base,
                                     const ResidualTextureOptions& options, const Progress& progress) {
  const double pixel = 0.5 * probe_edge(target), width = pixel * options.side;
  const std::vector<GreyImage> images = residual_patches(target, to_model(base), options, pixel);
  if (images.empty()) {
    throw InputError(
        "residual texture: the body is nowhere flat enough for patches of 16 of its facets; give a finer "
        "mesh");
  }
  PowerSpectrum spectrum = mean_periodogram(images, target.area / (width * width));
  // The height is that of the pixels: bumps wider than a patch count, since its tilt is taken out already.
  double pixels = 0.0;
  for (const GreyImage& image : images)
    pixels += sample_variance(image.values) / static_cast<double>(images.size());
  const double rms = std::sqrt(pixels), in_spectrum = spectrum.variance();
  if (!(rms > 1e-9 && in_spectrum > 0.0)) {
    throw InputError("residual texture: the base leaves nothing of the measured surface");
  }
  for (double& p : spectrum.power) p /= in_spectrum;
  const GaborFit fit = fit_gabor_spectrum(std::move(spectrum), "residual", {}, progress);
  ResidualTexture result;
  result.patches = static_cast<int>(images.size());
  result.layer.name = "micro: residual of the base";
  result.layer.pixel_size = pixel;
  result.layer.height_rms = rms;
  result.layer.exemplar_rms = fit.exemplar_rms;
  result.layer.lobes = fit.lobes;
  return result;
}

}  // namespace astrolith
