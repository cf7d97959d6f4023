#include <algorithm>
#include <cmath>

#include "recipe/body_internal.h"
#include "recipe/expect_internal.h"
#include "recipe/noise_layers_internal.h"

namespace astrolith {
namespace {

void check(const GaborLobe& lobe, const Place& place) {
  expect_integer(lobe.bandwidth, place.field("bandwidth"), 1, 12);
  expect_range(lobe.frequency_x, place.field("frequency_x"), -0.5, 0.5);
  expect_range(lobe.frequency_y, place.field("frequency_y"), -0.5, 0.5);
  expect_positive(lobe.variance, place.field("variance"));
}

void check(const LayerColor& color, const Place& place) {
  const Place axis = place.field("axis");
  expect_range(color.axis.x, axis.field("x"), -1.0, 1.0);
  expect_range(color.axis.y, axis.field("y"), -1.0, 1.0);
  expect_range(color.axis.z, axis.field("z"), -1.0, 1.0);
  expect_vector(color.mean, place.field("mean"));
}

// What bounds the number of impulses that one point needs.
void check(const SpotPart& part, const Place& place) {
  expect_vector(part.center, place.field("center"));
  const Place axes = place.field("axes");
  for (const auto& [axis, name] : {std::pair{part.axes.x, "x"}, {part.axes.y, "y"}, {part.axes.z, "z"}}) {
    expect_range(axis, axes.field(name), kLeastSpotAxis, 1.0 / kLeastSpotAxis);
  }
  const Place turn = place.field("turn");
  for (const auto& [angle, name] : {std::pair{part.turn.x, "x"}, {part.turn.y, "y"}, {part.turn.z, "z"}}) {
    expect_range(angle, turn.field(name), -360.0, 360.0);
  }
  expect_range(part.weight, place.field("weight"), -1e3, 1e3);
}

void check(const CellEdges& lattice, const Place& place) {
  std::size_t i = 0;
  for (const Vec3d& edge : {lattice.a, lattice.b, lattice.c}) {
    expect_vector(edge, place.element(i));
    const double length = norm(edge);
    if (!(length >= kLeastCellHeight && length <= kLongestCellEdge)) {
      place.element(i).fail(fmt::format("must be {:g} to {:g} long, is {:.3g}; change it", kLeastCellHeight,
                                        kLongestCellEdge, length));
    }
    ++i;
  }
  if (!(least_height(lattice) >= kLeastCellHeight)) {
    place.fail(
        fmt::format("its cells must be {:g} high at least over each face, are {:.3g}; make them less oblique",
                    kLeastCellHeight, least_height(lattice)));
  }
}

void check_parts(const SpotLayer& layer, const Place& place) {
  const Place parts = place.field("parts");
  if (layer.parts.size() > kMaxSpotParts) {
    parts.fail(
        fmt::format("must hold at most {}, are {}; leave some out", kMaxSpotParts, layer.parts.size()));
  }
  for (std::size_t i = 0; i < layer.parts.size(); ++i) check(layer.parts[i], parts.element(i));
}

void check_spot_counts(const SpotLayer& layer, const Place& place) {
  double extent = layer.parts.empty() ? spot_extent(layer, {}) : 0.0;
  for (const SpotPart& part : layer.parts) extent = std::max(extent, spot_extent(layer, part));
  const double cells = layer.size * extent / (layer.cell_size * least_height(layer.lattice));
  if (!(cells <= kMaxSpotCells)) {
    place.field("cell_size")
        .fail(fmt::format(
            "a spot's half axis size * sqrt(sigma * variance), and that of each of its parts, must be "
            "at most {:g} cells, is {:.3g}; use larger cells or smaller spots",
            kMaxSpotCells, cells));
  }
  const double finest =
      layer.density * std::pow(layer.lacunarity, (layer.layers - 1) * (layer.exponent - 2.0));
  if (!(std::max(layer.density, finest) <= kMaxSpotDensity)) {
    place.field("density").fail(fmt::format(
        "must be at most {:g} impulses a cell at every size, is {:.3g}; lower it, the exponent or the layers",
        kMaxSpotDensity, std::max(layer.density, finest)));
  }
}

void expect_direction(const Vec3d& v, const Place& place) {
  expect_vector(v, place);
  if (norm(v) < kMinPositive) place.fail("must not be zero; give the direction");
}

}  // namespace

void check(const FractalLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  check_octaves(layer.frequency, layer.octaves, layer.gain, layer.lacunarity, place);
  expect_vector(layer.scale, place.field("scale"));
  expect_vector(layer.bias, place.field("bias"));
  expect_number(layer.weight, place.field("weight"));
  expect_range(layer.gradient_modulation, place.field("gradient_modulation"), 0.0,
               is_worley(layer.noise) ? 0.0 : kMaxNumber);
  if (layer.warp) check(*layer.warp, place.field("warp"));
}

void check(const GaborLayer& layer, const Place& place) {
  expect_positive(layer.pixel_size, place.field("pixel_size"));
  expect_not_negative(layer.height_rms, place.field("height_rms"));
  expect_integer(layer.impulses_per_kernel, place.field("impulses_per_kernel"), 1, 1024);
  expect_number(layer.exemplar_mean, place.field("exemplar_mean"));
  expect_not_negative(layer.exemplar_rms, place.field("exemplar_rms"));
  if (layer.color) check(*layer.color, place.field("color"));
  const Place lobes = place.field("lobes");
  if (layer.lobes.empty())
    lobes.fail("must hold at least one [bandwidth, frequency_x, frequency_y, variance]");
  for (std::size_t i = 0; i < layer.lobes.size(); ++i) check(layer.lobes[i], lobes.element(i));
}

void check(const SpotLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  expect_positive(layer.size, place.field("size"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  expect_not_negative(layer.density, place.field("density"));
  expect_range(layer.probability, place.field("probability"), 0.0, 1.0);
  expect_range(layer.reach, place.field("reach"), -0.5, 1.0);
  expect_range(layer.least_weight, place.field("least_weight"), 0.0, 1.0);
  expect_range(layer.gaussian, place.field("gaussian"), -1e6, 1e6);
  expect_range(layer.alpha, place.field("alpha"), 0.0, 1e6);
  expect_range(layer.kappa, place.field("kappa"), -1e6, 1e6);
  expect_range(layer.beta, place.field("beta"), 0.0, 1e6);
  expect_range(layer.gamma, place.field("gamma"), 1e-6, 1e6);
  const Place variances = place.field("variances");
  expect_range(layer.variances.x, variances.field("x"), 1e-6, 1e6);
  expect_range(layer.variances.y, variances.field("y"), 1e-6, 1e6);
  expect_range(layer.variances.z, variances.field("z"), 1e-6, 1e6);
  expect_range(layer.sigma, place.field("sigma"), 1e-6, 1e6);
  expect_integer(layer.layers, place.field("layers"), 1, 12);
  expect_above_one(layer.lacunarity, place.field("lacunarity"), 16.0);
  expect_range(layer.gain, place.field("gain"), 0.0, 4.0);
  expect_range(layer.exponent, place.field("exponent"), 0.0, 6.0);
  check(layer.lattice, place.field("lattice"));
  check_parts(layer, place);
  check_spot_counts(layer, place);
}

void check(const SparseLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  expect_integer(layer.levels, place.field("levels"), 1, 16);
  expect_range(layer.probability, place.field("probability"), 0.0, 1.0);
  expect_range(layer.threshold, place.field("threshold"), 0.0, 1.0);
  expect_range(layer.gain, place.field("gain"), 0.0, 4.0);
}

void check(const RandomPhaseLayer& layer, const Place& place) {
  expect_not_negative(layer.height_rms, place.field("height_rms"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  expect_integer(layer.waves, place.field("waves"), 1, 128);
  expect_positive(layer.frequency_min, place.field("frequency_min"));
  expect_positive(layer.frequency_max, place.field("frequency_max"));
  if (layer.frequency_max < layer.frequency_min) {
    place.field("frequency_max")
        .fail(fmt::format("must be at least frequency_min, {}, is {}; swap them", layer.frequency_min,
                          layer.frequency_max));
  }
  expect_range(layer.exponent, place.field("exponent"), -8.0, 8.0);
  expect_direction(layer.direction, place.field("direction"));
  expect_range(layer.spread, place.field("spread"), 0.0, 1.0);
  expect_range(layer.randomness, place.field("randomness"), 0.0, 1.0);
}

void check(const PhasorLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  expect_positive(layer.frequency, place.field("frequency"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  if (!(layer.frequency * layer.cell_size <= kMaxPhasorTurns)) {
    place.field("cell_size")
        .fail(fmt::format("frequency * cell_size must be at most {:g}, is {:.3g}; use smaller cells",
                          kMaxPhasorTurns, layer.frequency * layer.cell_size));
  }
  expect_integer(layer.impulses_per_cell, place.field("impulses_per_cell"), 1, 16);
  expect_direction(layer.direction, place.field("direction"));
  expect_range(layer.spread, place.field("spread"), 0.0, 1.0);
}

}  // namespace astrolith
