#include "estimation/shape/fit_report.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "estimation/shape/convergence_plot.h"
#include "estimation/shape/picture_label.h"
#include "numerics/output_file.h"
#include "numerics/parallel_for.h"
#include "synthesis/colormap.h"
#include "synthesis/image_file.h"
#include "synthesis/preview.h"

namespace astrolith {
namespace {

PreviewOptions small_preview() {
  PreviewOptions options;
  options.width = 800;
  options.height = 600;
  return options;
}

RgbImage side_by_side(const RgbImage& left, const RgbImage& right) {
  RgbImage both{left.width + right.width, left.height, {}};
  both.pixels.reserve(left.pixels.size() + right.pixels.size());
  const auto append_row = [&](const RgbImage& image, int y) {
    const auto row = image.pixels.begin() + std::ptrdiff_t{3} * image.width * y;
    both.pixels.insert(both.pixels.end(), row, row + std::ptrdiff_t{3} * image.width);
  };
  for (int y = 0; y < both.height; ++y) {
    append_row(left, y);
    append_row(right, y);
  }
  return both;
}

// Distance of every vertex of the fit to the target, fractions of the diagonal.
std::vector<double> vertex_distances(const TargetBody& target, const TriangleMesh& mesh) {
  std::vector<double> distances(mesh.vertices.size());
  parallel_for(
      0, static_cast<std::int64_t>(distances.size()),
      [&](std::int64_t i) {
        const auto v = static_cast<std::size_t>(i);
        distances[v] = target.tree.closest(mesh.vertices[v]).distance;
      },
      64);
  return distances;
}

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f %%", 100.0 * fraction);
  return text;
}

RgbImage target_and_fit(const TargetBody& target, const ShapeFitResult& fit) {
  RgbImage left = render_preview(target.mesh, small_preview());
  RgbImage right = render_preview(fit.check.mesh, small_preview());
  draw_label(left, "target", 14, 24);
  draw_label(right,
             std::to_string(fit.body.spheres.size()) + " metaballs, mean distance " +
                 percent(fit.check.distance.mean) + " of the diagonal",
             14, 24);
  return side_by_side(left, right);
}

RgbImage distance_map(const TargetBody& target, const ShapeFitResult& fit) {
  PreviewOptions options = small_preview();
  options.vertex_colors = sequential_colors(vertex_distances(target, fit.check.mesh), 0.0,
                                            std::max(fit.check.distance.p99, 1e-9));
  options.fill_light = 0.5;  // colours are to be read in the shadows too
  RgbImage map = render_preview(fit.check.mesh, options);
  draw_label(map, "distance from the fit to the target, of the diagonal", 14, 24);
  draw_color_scale(map, "0", percent(fit.check.distance.p99));
  return map;
}

}  // namespace

void write_fit_report(const TargetBody& target, const ShapeFitResult& fit,
                      const std::filesystem::path& folder) {
  make_output_folder(folder);
  write_png8_rgb(target_and_fit(target, fit), folder / "target_and_fit.png");
  write_png8_rgb(distance_map(target, fit), folder / "distance_map.png");
  if (!fit.convergence.empty()) write_png8_rgb(plot_convergence(fit.convergence), folder / "convergence.png");
}

}  // namespace astrolith
