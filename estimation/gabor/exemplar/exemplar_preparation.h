// Prepares a photo as the image of an exemplar layer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimation/gabor/exemplar/texture_score.h"
#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// Sides of the photos that become an exemplar, in pixels.
inline constexpr int kLeastTextureSide = 32, kMostTextureSide = 4096;

// Throws InputError for sides outside kLeastTextureSide to kMostTextureSide, and for a photo of one grey
// value. `name` is the photo's in messages.
void require_exemplar(const GreyImage& photo, const std::string& name);
// Throws InputError for planes with values beyond -1 to 2, which are no colours.
void require_colors(const std::vector<GreyImage>& planes, const std::string& name);

// The image in 16 bits: the darkest pixel becomes 0, the brightest 65535.
ExemplarImage in_16_bits(const GreyImage& image);
// Red, green and blue in 16 bits of full scale, cut off at 0 and 1, with their luma.
ExemplarImage colors_in_16_bits(const std::vector<GreyImage>& planes);

// The luma of three planes: 0.2126 R + 0.7152 G + 0.0722 B.
GreyImage luma_image(const std::vector<GreyImage>& planes);

// The ways to continue a photo beyond its border:
//   kPeriodic  its periodic component (Moisan 2011), which repeats without a seam
//   kMatched   the periodic component, whose ranks take the grey values of the photo
//   kMirrored  the photo itself, mirrored at its borders
enum class ExemplarVariant { kPeriodic, kMatched, kMirrored };
inline constexpr ExemplarVariant kExemplarVariants[] = {ExemplarVariant::kPeriodic, ExemplarVariant::kMatched,
                                                        ExemplarVariant::kMirrored};
std::string_view variant_word(ExemplarVariant variant);
// The variant of that name; none for other words.
std::optional<ExemplarVariant> variant_named(std::string_view word);

struct PreparedExemplar {
  ExemplarVariant variant = ExemplarVariant::kPeriodic;
  ExemplarLayer layer;  // with pixels and border; lengths are pixels, height_rms is the image's deviation
  // The score of each variant that was tried, by number: of a texture against the photo, or its middle
  // 1024 x 1024.
  std::optional<TextureScore> scores[3];
  const TextureScore& score() const { return *scores[static_cast<int>(variant)]; }
};

// Makes an exemplar of a photo by the variant `only`, or else by the one whose textures are nearest to the
// photo, in their direction too: mirrored at its borders, a photo of which light comes from one side is lit
// from four. `name` is the photo's name in messages. Throws InputError as require_exemplar() does. Throws
// WorkError when `progress` asks to stop.
PreparedExemplar prepare_exemplar(const GreyImage& photo, const std::string& name, std::uint64_t seed,
                                  const Progress& progress = {}, std::optional<ExemplarVariant> only = {});

// Prepares a photo in colour alike: red, green and blue of one size, full scale = 1. The layer has the
// colours and paints. Its height is that of their luma, and the scores are those of the luma. The variant
// changes each plane by itself; values beyond 0 to 1 are cut off. Throws InputError also as require_colors()
// does.
PreparedExemplar prepare_exemplar(const std::vector<GreyImage>& planes, const std::string& name,
                                  std::uint64_t seed, const Progress& progress = {},
                                  std::optional<ExemplarVariant> only = {});

// A texture of an exemplar layer, in the grey values of the photo that it was made from.
GreyImage exemplar_texture_like(const ExemplarLayer& layer, const GreyImage& photo, std::uint64_t seed);

}  // namespace astrolith
