// A relief layer: the measured heights of a body over its metaballs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "recipe/body.h"
#include "recipe/exemplar_image.h"
#include "recipe/layer_traits.h"
#include "recipe/noise_layers.h"

namespace astrolith {

// Where the heights of a relief stand: each in its own place, or drawn from other places
// (synthesis/relief/relief_likeness.h). Heights that are only laid lack the last step of a likeness.
enum class ReliefArrangement { kMeasured, kLaid, kLike };
constexpr std::string_view arrangement_word(ReliefArrangement a) {
  return a == ReliefArrangement::kMeasured ? "measured" : a == ReliefArrangement::kLaid ? "laid" : "like";
}

// Heights over the bare surface, stored at places q that follow from the body and the spacing
// (synthesis/relief/relief_places.h). With maps of the surface along the axes a = x, y, z,
//   n(p) = sum_q B(p - q) w(q) h(q) / sum_q B(p - q) w(q),   w = max((n_a^2 - 1/5) / (4/5), 0)^2 at q,
// where the sums run over the places of all maps around p, B is the product of two cubic B-splines of the
// distances along the two other axes, in spacings, and n_a the normal's component along the map's axis.
// Beside the surface that a map shows it counts less and then not at all, and the height falls to 0
// (synthesis/relief/relief_noise.h). h(q) comes from the grey value v of the image's pixel for q:
//   h = low + (high - low) round((v - 1) (levels - 1) / 65534) / (levels - 1).
inline constexpr int kMostFinerLevels = 6;
inline constexpr double kLeastReliefEdge = 0.25,
                        kMostReliefEdge = 8.0;  // spacings; patches of other sizes take long
struct ReliefLayer : NamedImage {
  static constexpr std::string_view kType = "relief";
  static constexpr LayerTraits kTraits{
      .is_noise = true, .on_surface = true, .on_layers = false, .in_plane = false};

  std::string name;
  LayerSeed seed;
  LayerUse use;
  ReliefArrangement arrangement = ReliefArrangement::kMeasured;
  // The body whose places have the heights, where it is not the recipe's own; not with kMeasured.
  std::optional<MetaballBody> donor;
  // The length here of a unit of the donor, which keeps its own lengths, and with it those of this layer: its
  // places could not be found again in another unit. 1 without a donor.
  double donor_scale = 1.0;
  // The mean edge of the model that was measured, or the spacing where that is larger, length units.
  double edge = 0.0;         // 0: 1.2 spacings
  double reach = 0.3;        // of donors, as a share of the body's diagonal
  bool fill_unseen = false;  // whether ground that no camera saw gets patches of seen ground
  double spacing = 1.0;      // length units between lines of the lattice, > 0
  double low = 0.0;          // height of the grey value 1, length units
  double high = 0.0;         // height of the grey value 65535, >= low
  int levels = 2;            // heights from low to high, 2 .. 65535
  int finer = 0;  // levels below the model (synthesis/relief/relief_levels.h), 0 .. kMostFinerLevels

  // Whether the layer names no file, since the recipe holds its pixels (noise_layer_fields.cpp).
  bool is_embedded() const { return image.empty() && image_sha256.empty(); }
  double step() const { return (high - low) / (levels - 1); }
  // The code 0 .. levels - 1 of a grey value above 0, and the grey value of a code.
  std::uint16_t grey_to_code(std::uint16_t value) const {
    return static_cast<std::uint16_t>(((value - 1u) * (levels - 1u) + 32767u) / 65534u);
  }
  std::uint16_t code_to_grey(std::uint16_t code) const {
    return static_cast<std::uint16_t>(1u + (code * 65534u + (levels - 1u) / 2u) / (levels - 1u));
  }
  double edge_length() const { return edge > 0.0 ? edge : 1.2 * spacing; }
  StatedHeight stated_height() const {
    return {low < -high ? "low" : "high", donor_scale * (low < -high ? low : high)};
  }
  // Multiplies all lengths by the ratio.
  void rescale(double ratio) {
    if (donor) {
      donor_scale *= ratio;
      return;
    }
    spacing *= ratio;
    edge *= ratio;
    low *= ratio;
    high *= ratio;
  }
};
void visit_fields(FieldVisitor& v, ReliefLayer& layer);

}  // namespace astrolith
