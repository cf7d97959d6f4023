// Lists of fields of a recipe's noise layers, with their rules.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "numerics/portable_double.h"
#include "recipe/base64.h"
#include "recipe/compact/height_picture.h"
#include "recipe/exemplar_image.h"
#include "recipe/fields_internal.h"
#include "recipe/relief_layer.h"

namespace astrolith {
namespace {

// The heights of the layer's pixels, coded in few bits (recipe/compact/height_picture.h), as base64. Expects
// pixels.
std::string relief_text(const ReliefLayer& layer) {
  const ExemplarImage& image = *layer.pixels;
  HeightPicture picture{image.width, image.height, image.values};
  // Codes, from 1: small numbers take fewer bits than grey values.
  for (std::uint16_t& value : picture.values) {
    if (value != 0) value = static_cast<std::uint16_t>(layer.grey_to_code(value) + 1);
  }
  RangeEncoder encoder;
  encode(picture, encoder);
  return base64_text(encoder.finish());
}

// The pixels whose text this is, for a layer with these levels; null where the text is damaged.
std::shared_ptr<const ExemplarImage> relief_pixels(const ReliefLayer& layer, std::string_view text) {
  constexpr std::size_t kMostPixelsPerByte = 400;  // a body's picture has some ten
  const std::optional<std::string> bytes = base64_bytes(text);
  if (!bytes) return nullptr;
  try {
    RangeDecoder decoder(*bytes);
    HeightPicture picture = decode(kMostPixelsPerByte * bytes->size(), decoder);
    for (std::uint16_t& value : picture.values) {
      if (value > layer.levels) return nullptr;
      if (value != 0) value = layer.code_to_grey(static_cast<std::uint16_t>(value - 1));
    }
    return std::make_shared<ExemplarImage>(
        ExemplarImage{picture.width, picture.height, std::move(picture.values), {}});
  } catch (const DamagedStream&) {
    return nullptr;
  }
}

constexpr Noise kWorleyNoises[] = {Noise::kWorleyF1, Noise::kWorleyF2, Noise::kWorleyF2MinusF1,
                                   Noise::kWorleyBlocks};
std::string_view distance_word(Noise noise) {
  constexpr std::string_view kWords[] = {"f1", "f2", "f2-f1", "blocks"};
  return kWords[static_cast<std::size_t>(noise) - static_cast<std::size_t>(Noise::kWorleyF1)];
}

void check_modulation(const FractalLayer& layer, const Place& place) {
  if (is_worley(layer.noise)) {
    expect(layer.gradient_modulation, range(0.0, 0.0), place.field("gradient_modulation"));
  }
}

void check_lobes(const GaborLayer& layer, const Place& place) {
  if (!layer.lobes.empty()) return;
  place.field("lobes").fail("must hold at least one [bandwidth, frequency_x, frequency_y, variance]");
}

void check_image(const NamedImage& named, const Place& place) {
  const bool relative = !named.image.empty() && named.image.front() != '/';
  if (!relative) {
    place.field("image").fail("must be a path relative to the recipe's folder, is " +
                              quote_text(named.image));
  }
  const std::string& hash = named.image_sha256;
  const bool digits = std::all_of(hash.begin(), hash.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (hash.size() == 64 && digits) return;
  place.field("image_sha256")
      .fail("must be the 64 hexadecimal digits that sha256sum prints for the image, is " + quote_text(hash));
}

void check_exemplar_height(const ExemplarLayer& layer, const Place& place) {
  if (layer.height_rms == 0.0 || layer.height_range == 0.0) return;
  place.field("height_range").fail("must be 0 where height_rms is not; state one of both");
}

constexpr ReliefArrangement kArrangements[] = {ReliefArrangement::kMeasured, ReliefArrangement::kLaid,
                                               ReliefArrangement::kLike};

void check_relief_heights(const ReliefLayer& layer, const Place& place) {
  if (layer.high >= layer.low) return;
  place.field("high").fail("must not be below low");
}

void check_model_edge(const ReliefLayer& layer, const Place& place) {
  const double spacings = layer.edge / layer.spacing;
  if (layer.edge == 0.0 || (spacings >= kLeastReliefEdge && spacings <= kMostReliefEdge)) return;
  place.field("edge").fail("must be 0, or 0.25 to 8 spacings, as fit_shape writes it");
}

void check_donor(const ReliefLayer& layer, const Place& place) {
  if (!layer.donor) {
    if (layer.donor_scale != 1.0)
      place.field("donor_scale").fail("is about a donor; take it out, or add one");
    return;
  }
  if (layer.arrangement == ReliefArrangement::kMeasured) {
    place.field("donor").fail("has heights for places of its own; take arrangement \"like\" with it");
  }
  if (!layer.donor->operations.empty() || layer.donor->warp) {
    place.field("donor").fail("must be metaballs without operations and warp");
  }
}

void check_edge(const Vec3d& edge, const Place& place) {
  const double length = norm(edge);
  if (length >= kLeastCellHeight && length <= kLongestCellEdge) return;
  place.fail(fmt::format("must be {:g} to {:g} long, is {:.3g}; change it", kLeastCellHeight,
                         kLongestCellEdge, length));
}

void check_lattice(const CellEdges& lattice, const Place& place) {
  std::size_t i = 0;
  for (const Vec3d& edge : {lattice.a, lattice.b, lattice.c}) check_edge(edge, place.element(i++));
  if (least_height(lattice) >= kLeastCellHeight) return;
  place.fail(
      fmt::format("its cells must be {:g} high at least over each face, are {:.3g}; make them less oblique",
                  kLeastCellHeight, least_height(lattice)));
}

void check_parts(const SpotLayer& layer, const Place& place) {
  if (layer.parts.size() <= kMaxSpotParts) return;
  place.field("parts").fail(
      fmt::format("must hold at most {}, are {}; leave some out", kMaxSpotParts, layer.parts.size()));
}

void check_spot_reach(const SpotLayer& layer, const Place& place) {
  double extent = layer.parts.empty() ? spot_extent(layer, {}) : 0.0;
  for (const SpotPart& part : layer.parts) extent = std::max(extent, spot_extent(layer, part));
  const double cells = layer.size * extent / (layer.cell_size * least_height(layer.lattice));
  if (cells <= kMaxSpotCells) return;
  place.field("cell_size")
      .fail(fmt::format("a spot's half axis size * sqrt(sigma * variance), and that of each of its parts, "
                        "must be at most {:g} cells, is {:.3g}; use larger cells or smaller spots",
                        kMaxSpotCells, cells));
}

void check_spot_density(const SpotLayer& layer, const Place& place) {
  const double finest =
      layer.density * portable::pow(layer.lacunarity, (layer.layers - 1) * (layer.exponent - 2.0));
  const double densest = std::max(layer.density, finest);
  if (densest <= kMaxSpotDensity) return;
  place.field("density").fail(fmt::format(
      "must be at most {:g} impulses a cell at every size, is {:.3g}; lower it, the exponent or the layers",
      kMaxSpotDensity, densest));
}

void check_frequencies(const RandomPhaseLayer& layer, const Place& place) {
  if (layer.frequency_max >= layer.frequency_min) return;
  place.field("frequency_max")
      .fail(fmt::format("must be at least frequency_min, {}, is {}; swap them", layer.frequency_min,
                        layer.frequency_max));
}

void check_turns(const PhasorLayer& layer, const Place& place) {
  const double turns = layer.frequency * layer.cell_size;
  if (turns <= kMaxPhasorTurns) return;
  place.field("cell_size")
      .fail(fmt::format("frequency * cell_size must be at most {:g}, is {:.3g}; use smaller cells",
                        kMaxPhasorTurns, turns));
}

template <class DirectedLayer>
void check_direction(const DirectedLayer& layer, const Place& place) {
  if (norm(layer.direction) >= kMinPositive) return;
  place.field("direction").fail("must not be zero; give the direction");
}

}  // namespace

void visit_fields(FieldVisitor& v, FractalLayer& layer) {
  v.field("amplitude", layer.amplitude, kAnyNumber);
  v.field("frequency", layer.frequency, kPositive);
  visit_octaves(v, layer.frequency, layer.octaves, layer.gain, layer.lacunarity);
  v.field("scale", layer.scale, kAnyNumber);
  v.field("bias", layer.bias, kAnyNumber);
  v.field("weight", layer.weight, kAnyNumber);
  v.rule(check_modulation, layer);
  if (is_worley(layer.noise)) {
    v.word("distance", layer.noise, kWorleyNoises, distance_word);
  } else {
    v.field("gradient_modulation", layer.gradient_modulation, kNotNegative);
  }
  v.field("warp", layer.warp);
}

static void visit_row(FieldVisitor& v, GaborLobe& lobe) {
  constexpr NumberLimits kCyclesPerPixel = range(-0.5, 0.5);
  v.row(Column{"bandwidth", lobe.bandwidth, range(1, 12)},
        Column{"frequency_x", lobe.frequency_x, kCyclesPerPixel},
        Column{"frequency_y", lobe.frequency_y, kCyclesPerPixel},
        Column{"variance", lobe.variance, kPositive});
}

void visit_fields(FieldVisitor& v, LayerColor& color) {
  v.required("axis", color.axis, range(-1.0, 1.0));
  v.field("mean", color.mean, kAnyNumber);
}

void visit_fields(FieldVisitor& v, GaborLayer& layer) {
  v.field("pixel_size", layer.pixel_size, kPositive);
  v.field("height_rms", layer.height_rms, kNotNegative);
  v.field("impulses_per_kernel", layer.impulses_per_kernel, range(1, 1024));
  v.retired("evaluation", "impulses",
            "is gone; leave it out, which evaluates the impulses of all lobes, or fit the photo again with "
            "fit_gabor --model phase");
  v.field("exemplar_mean", layer.exemplar_mean, kAnyNumber);
  v.field("exemplar_rms", layer.exemplar_rms, kNotNegative);
  v.field("color", layer.color);
  v.rule(check_lobes, layer);
  v.required("lobes", layer.lobes);
}

static void visit_image(FieldVisitor& v, NamedImage& named) {
  v.required("image", named.image);
  v.required("image_sha256", named.image_sha256);
  v.rule(check_image, named);
}

// A relief that names no file has its pixels as text.
void visit_heights(FieldVisitor& v, ReliefLayer& layer) {
  if (v.checking()) return;  // check_relief_source() does, without coding the heights
  std::string text;
  if (!v.reading() && layer.is_embedded() && layer.pixels != nullptr) text = relief_text(layer);
  v.field_if(!text.empty(), "heights", text);
  if (!v.reading() || text.empty()) return;
  layer.pixels = relief_pixels(layer, text);
  if (layer.pixels == nullptr)
    v.place().field("heights").fail("is damaged; take the text that a program wrote");
}
void check_relief_source(const ReliefLayer& layer, const Place& place) {
  if (!layer.is_embedded()) return check_image(layer, place);
  if (layer.pixels == nullptr) place.field("image").fail("is missing; add it and image_sha256, or heights");
}
void visit_fields(FieldVisitor& v, ReliefLayer& layer) {
  v.field_if(!layer.is_embedded(), "image", layer.image);
  v.field_if(!layer.is_embedded(), "image_sha256", layer.image_sha256);
  v.word("arrangement", layer.arrangement, kArrangements, arrangement_word);
  v.field("donor", layer.donor);
  v.field_if(layer.donor_scale != 1.0, "donor_scale", layer.donor_scale, kPositive);
  v.rule(check_donor, layer);
  v.field_if(layer.edge != 0.0, "edge", layer.edge, kNotNegative);
  v.field_if(layer.reach != 0.3, "reach", layer.reach, range(0.01, 1.0));
  v.field_if(layer.fill_unseen, "fill_unseen", layer.fill_unseen);
  v.required("spacing", layer.spacing, kPositive);
  v.rule(check_model_edge, layer);
  v.required("low", layer.low, kAnyNumber);
  v.required("high", layer.high, kAnyNumber);
  v.rule(check_relief_heights, layer);
  v.required("levels", layer.levels, range(2, 65535));
  v.field_if(layer.finer != 0, "finer", layer.finer, range(0, kMostFinerLevels));
  visit_heights(v, layer);
  v.rule(check_relief_source, layer);
}

void visit_fields(FieldVisitor& v, ExemplarLayer& layer) {
  visit_image(v, layer);
  v.field("pixel_size", layer.pixel_size, kPositive);
  v.field("height_rms", layer.height_rms, kNotNegative);
  v.field("height_range", layer.height_range, kAnyNumber);
  v.rule(check_exemplar_height, layer);
  v.field("exponent", layer.exponent, range(2, 8));
  v.field("anchor_spacing", layer.anchor_spacing, range(0.1, 2.0));
  v.word("border", layer.border, kExemplarBorders, border_word);
  v.word("rotation", layer.rotation, kExemplarRotations, rotation_word);
  v.field_if(layer.color, "color", layer.color);
}

static void visit_row(FieldVisitor& v, CellEdges& lattice) {
  v.array("edge", {&lattice.a, &lattice.b, &lattice.c}, kAnyNumber);
  v.rule(check_lattice, lattice);
}

void visit_fields(FieldVisitor& v, SpotPart& part) {
  v.field("center", part.center, kAnyNumber);
  v.field("axes", part.axes, range(kLeastSpotAxis, 1.0 / kLeastSpotAxis));
  v.field("turn", part.turn, range(-360.0, 360.0));
  v.field("weight", part.weight, range(-1e3, 1e3));
}

void visit_fields(FieldVisitor& v, SpotLayer& layer) {
  v.field("amplitude", layer.amplitude, kAnyNumber);
  v.field("inverted", layer.inverted);
  v.field("size", layer.size, kPositive);
  v.field("cell_size", layer.cell_size, kPositive);
  v.field("lattice", layer.lattice);
  v.field("density", layer.density, kNotNegative);
  v.field("probability", layer.probability, kShare);
  v.field("even", layer.even);
  v.field("reach", layer.reach, range(-0.5, 1.0));
  v.field("least_weight", layer.least_weight, kShare);
  v.field("gaussian", layer.gaussian, range(-1e6, 1e6));
  v.field("alpha", layer.alpha, range(0.0, 1e6));
  v.field("kappa", layer.kappa, range(-1e6, 1e6));
  v.field("beta", layer.beta, range(0.0, 1e6));
  v.field("gamma", layer.gamma, range(1e-6, 1e6));
  v.field("variances", layer.variances, range(1e-6, 1e6));
  v.field("sigma", layer.sigma, range(1e-6, 1e6));
  v.field("layers", layer.layers, range(1, 12));
  v.field("lacunarity", layer.lacunarity, above_one(16.0));
  v.field("gain", layer.gain, range(0.0, 4.0));
  v.field("exponent", layer.exponent, range(0.0, 6.0));
  v.rule(check_parts, layer);
  v.field_if(!layer.parts.empty(), "parts", layer.parts);
  v.rule(check_spot_reach, layer);
  v.rule(check_spot_density, layer);
}

void visit_fields(FieldVisitor& v, SparseLayer& layer) {
  v.field("amplitude", layer.amplitude, kAnyNumber);
  v.field("cell_size", layer.cell_size, kPositive);
  v.field("levels", layer.levels, range(1, 16));
  v.field("probability", layer.probability, kShare);
  v.field("threshold", layer.threshold, kShare);
  v.field("gain", layer.gain, range(0.0, 4.0));
  v.field("merged", layer.merged);
}

void visit_fields(FieldVisitor& v, RandomPhaseLayer& layer) {
  v.field("height_rms", layer.height_rms, kNotNegative);
  v.field("cell_size", layer.cell_size, kPositive);
  v.field("waves", layer.waves, range(1, 128));
  v.field("frequency_min", layer.frequency_min, kPositive);
  v.field("frequency_max", layer.frequency_max, kPositive);
  v.rule(check_frequencies, layer);
  v.field("exponent", layer.exponent, range(-8.0, 8.0));
  v.field("direction", layer.direction, kAnyNumber);
  v.rule(check_direction<RandomPhaseLayer>, layer);
  v.field("spread", layer.spread, kShare);
  v.field("randomness", layer.randomness, kShare);
}

void visit_fields(FieldVisitor& v, PhasorLayer& layer) {
  v.field("amplitude", layer.amplitude, kAnyNumber);
  v.field("frequency", layer.frequency, kPositive);
  v.field("cell_size", layer.cell_size, kPositive);
  v.rule(check_turns, layer);
  v.field("impulses_per_cell", layer.impulses_per_cell, range(1, 16));
  v.field("direction", layer.direction, kAnyNumber);
  v.rule(check_direction<PhasorLayer>, layer);
  v.field("spread", layer.spread, kShare);
  v.word("profile", layer.profile, kPhasorProfiles, profile_word);
}

}  // namespace astrolith
