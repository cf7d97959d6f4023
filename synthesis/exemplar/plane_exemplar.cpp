#include "synthesis/exemplar/plane_exemplar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/scalar_math.h"
#include "synthesis/exemplar/exemplar_colors.h"
#include "synthesis/exemplar/exemplar_noise.h"

namespace astrolith {
namespace {

constexpr int kSquareSide = 256;  // pixels

// The cells of a plane, in pixels, and after how many of them it repeats along x and y; 0: never.
struct PlaneCells {
  Vec3d edge;
  int period[2] = {0, 0};
};

PlaneCells plane_cells(const ExemplarLayer& layer, int width, int height, bool tileable,
                       const std::string& place) {
  const int side = std::min(layer.pixels->width, layer.pixels->height);
  const double edge = exemplar_edge(layer.anchor_spacing) * side;
  PlaneCells cells{{edge, edge, edge}};
  if (!tileable) return cells;
  if (std::min(width, height) < 0.5 * edge) {
    throw InputError(place + ".anchor_spacing: a tileable side must be at least " +
                     std::to_string(static_cast<int>(std::ceil(0.5 * edge))) +
                     " pixels, half a cell of anchors; make the texture larger");
  }
  const auto count = [edge](int length) { return std::max(1, static_cast<int>(std::lround(length / edge))); };
  cells.period[0] = count(width);
  cells.period[1] = count(height);
  cells.edge.x = static_cast<double>(width) / cells.period[0];
  cells.edge.y = static_cast<double>(height) / cells.period[1];
  return cells;
}

// The layer whose length unit is the pixel.
ExemplarLayer in_pixels(const ExemplarLayer& layer) {
  ExemplarLayer scaled = layer;
  scaled.pixel_size = 1.0;
  return scaled;
}

// What the squares of a texture share.
struct ExemplarPlane {
  const ExemplarLayer& layer;
  const ExemplarNoise& made;
  const ArrayView& arrays;
  const PlaneCells& cells;
  std::uint32_t seed;
  int width, height;
};

// Draws the square whose upper left pixel is (x0, y0), in coordinates relative to that pixel.
void draw_square(const ExemplarPlane& plane, int x0, int y0, std::vector<float>& texture) {
  // The plane lies a quarter of a cell above a layer of anchors, so that it cuts through tetrahedra of all
  // kinds.
  const Box square{{0, 0, 0}, {double{kSquareSide}, double{kSquareSide}, 0}};
  const NoiseFrame frame(square,
                         {static_cast<double>(x0), static_cast<double>(y0), 0.25 * plane.cells.edge.z});
  const ExemplarCells cells = exemplar_cells(frame, plane.cells.edge);
  const std::vector<ExemplarAnchor> anchors =
      anchors_on_plane(plane.layer, cells, plane.seed, plane.cells.period);
  ExemplarNoise noise = plane.made;
  noise.low = to_float(square.min);
  noise.high = to_float(square.max);
  noise.lattice = cells.lattice;
  const int columns = std::min(kSquareSide, plane.width - x0),
            rows = std::min(kSquareSide, plane.height - y0);
  const auto points = static_cast<std::size_t>(columns);
  std::vector<float> x(points), y(points), z(points);
  for (std::size_t i = 0; i < points; ++i) x[i] = static_cast<float>(i) + 0.5f;
  for (int row = 0; row < rows; ++row) {
    std::fill(y.begin(), y.end(), static_cast<float>(row) + 0.5f);
    float* heights = &texture[static_cast<std::size_t>(y0 + row) * static_cast<std::size_t>(plane.width) +
                              static_cast<std::size_t>(x0)];
    evaluate_heights(noise, plane.arrays, anchors.data(), columns, x.data(), y.data(), z.data(), heights);
  }
}

std::array<float, 3> float_parts(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

PlaneExemplarOptions make_options(const ExemplarLayer& layer, const PlaneDrawing& drawing) {
  return {drawing.recipe.seed, layer_number(layer.seed, static_cast<int>(drawing.index)), drawing.tileable};
}

}  // namespace

std::vector<float> synthesize_exemplar(const ExemplarLayer& layer, const std::string& place, int width,
                                       int height, const PlaneExemplarOptions& options,
                                       const Progress& progress) {
  const ExemplarLayer scaled = in_pixels(layer);
  ArrayStore arrays;
  const ExemplarNoise made = make_exemplar(scaled, place, arrays);
  const ArrayView view = arrays.view();
  const PlaneCells cells = plane_cells(scaled, width, height, options.tileable, place);
  const std::uint32_t seed = hash_seed(options.seed, static_cast<std::uint32_t>(options.layer_index));
  const ExemplarPlane plane{scaled, made, view, cells, seed, width, height};
  std::vector<float> texture(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int squares_x = (width - 1) / kSquareSide + 1, squares_y = (height - 1) / kSquareSide + 1;
  for (int ty = 0; ty < squares_y; ++ty) {
    if (!report(progress, static_cast<double>(ty) / squares_y, "texture")) return texture;
    parallel_for(0, squares_x, [&](std::int64_t tx) {
      draw_square(plane, static_cast<int>(tx) * kSquareSide, ty * kSquareSide, texture);
    });
  }
  report(progress, 1.0, "texture");
  return texture;
}

std::vector<float> synthesize_exemplar_colors(const ExemplarLayer& layer, const std::string& place, int width,
                                              int height, const PlaneExemplarOptions& options,
                                              const Progress& progress) {
  const ExemplarColors colors = exemplar_colors(layer, place);
  const std::array<float, 3> mean = float_parts(colors.mean);
  std::vector<float> rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = mean[i % 3];
  for (std::size_t k = 0; k < colors.channels.size(); ++k) {
    const ColorChannel& channel = colors.channels[k];
    const auto share = [&](double done, std::string_view words) {
      return report(progress, (static_cast<double>(k) + done) / static_cast<double>(colors.channels.size()),
                    words);
    };
    const std::vector<float> values =
        synthesize_exemplar(channel.layer, place, width, height, options, share);
    const std::array<float, 3> axis = float_parts(channel.axis);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = math::fma(axis[i % 3], values[i / 3], rgb[i]);
  }
  return rgb;
}

PlaneTexture heights_on_plane(const ExemplarLayer& layer, const PlaneDrawing& drawing) {
  PlaneTexture texture;
  const ExemplarLayer high = with_height(layer, texture);
  texture.values = synthesize_exemplar(high, drawing.place, drawing.width, drawing.height,
                                       make_options(layer, drawing), drawing.progress);
  texture.height_rms = exemplar_height_rms(high);
  return texture;
}

PlaneTexture colors_on_plane(const ExemplarLayer& layer, const PlaneDrawing& drawing) {
  return {3, synthesize_exemplar_colors(layer, drawing.place, drawing.width, drawing.height,
                                        make_options(layer, drawing), drawing.progress)};
}

}  // namespace astrolith
