#include "estimation/gabor/gaussianity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr int kLargestPiece = 512;
constexpr int kBlocks = 8;

// Large photos have fewer surrogates, since the work is that of so many pieces at most. 19 are the least that
// reach p = 0.05.
constexpr int kMostSurrogates = 99, kFewestSurrogates = 19;
constexpr int kSurrogatePieces = 16 * kMostSurrogates;

constexpr std::array<int, 3> kLags{1, 4, 16};

// The measures that are compared with those of surrogates. at(k) lists them: skewness, kurtosis, the
// logarithm of the spread, and the kurtosis of differences by lag and axis.
struct Measures {
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  double variance_spread = 0.0;  // coefficient of variation of the blocks' variances
  std::array<double, 2 * kLags.size()> steps{};

  static constexpr std::size_t kCount = 3 + 2 * kLags.size();
  double at(std::size_t k) const {
    switch (k) {
      case 0:
        return skewness;
      case 1:
        return excess_kurtosis;
      case 2:
        return std::log(variance_spread + 1e-12);
      default:
        return steps[k - 3];
    }
  }
};

// Equal pieces of at most 512 x 512 pixels side by side over the whole image. A few columns and rows, fewer
// than there are pieces along them, are left out where the sides are no multiples.
struct Pieces {
  int columns, rows, width, height;

  explicit Pieces(const GreyImage& image)
      : columns((image.width - 1) / kLargestPiece + 1),
        rows((image.height - 1) / kLargestPiece + 1),
        width(image.width / columns),
        height(image.height / rows) {}
  int count() const { return columns * rows; }
};

GreyImage cut_piece(const GreyImage& image, const Pieces& pieces, int t) {
  const auto start = [](int extent, int i, int n) {
    return static_cast<int>(static_cast<std::int64_t>(extent) * i / n);
  };
  const int x0 = start(image.width, t % pieces.columns, pieces.columns);
  const int y0 = start(image.height, t / pieces.columns, pieces.rows);
  return image.part(x0, y0, pieces.width, pieces.height);
}

double block_variance(const GreyImage& image, int bx, int by) {
  double sum = 0.0;
  double square = 0.0;
  int n = 0;
  for (int y = by * image.height / kBlocks; y < (by + 1) * image.height / kBlocks; ++y) {
    for (int x = bx * image.width / kBlocks; x < (bx + 1) * image.width / kBlocks; ++x, ++n) {
      sum += image.at(x, y);
      square += image.at(x, y) * image.at(x, y);
    }
  }
  return std::max(0.0, square / n - sum / n * (sum / n));
}

// Power sums over the pixels of all pieces, each piece about its own mean. Pieces are added in their order.
class MeasureSums {
 public:
  void add(const GreyImage& piece) {
    add_values(piece.values);
    for (int by = 0; by < kBlocks; ++by) {
      for (int bx = 0; bx < kBlocks; ++bx) {
        const double variance = block_variance(piece, bx, by);
        blocks_ += 1.0;
        block_sum_ += variance;
        block_square_ += variance * variance;
      }
    }
    for (std::size_t k = 0; k < kLags.size(); ++k) {
      add_steps(piece, kLags[k], 0, steps_[2 * k]);
      add_steps(piece, 0, kLags[k], steps_[2 * k + 1]);
    }
  }

  Measures measures() const {
    Measures m;
    const double variance = second_ / pixels_;
    if (variance > 0.0) {
      m.skewness = third_ / pixels_ / (variance * std::sqrt(variance));
      m.excess_kurtosis = fourth_ / pixels_ / (variance * variance) - 3.0;
    }
    const double mean = block_sum_ / blocks_;
    if (mean > 0.0)
      m.variance_spread = std::sqrt(std::max(0.0, block_square_ / blocks_ - mean * mean)) / mean;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Steps& s = steps_[k];
      m.steps[k] = s.second > 0.0 ? s.fourth / (s.second * s.second) * pixels_ - 3.0 : 0.0;
    }
    return m;
  }

 private:
  struct Steps {
    double second = 0.0, fourth = 0.0;
  };

  void add_values(const std::vector<double>& values) {
    double mean = 0.0;
    for (const double v : values) mean += v;
    mean /= static_cast<double>(values.size());
    for (const double v : values) {
      const double d = v - mean, square = d * d;
      second_ += square;
      third_ += square * d;
      fourth_ += square * square;
    }
    pixels_ += static_cast<double>(values.size());
  }

  // The differences over (dx, dy) pixels. Their mean is 0, because the piece is periodic.
  static void add_steps(const GreyImage& piece, int dx, int dy, Steps& sums) {
    const auto add = [&](const double* from, const double* to, int n) {
      double row_second = 0.0, row_fourth = 0.0;
      for (int x = 0; x < n; ++x) {
        const double square = (to[x] - from[x]) * (to[x] - from[x]);
        row_second += square;
        row_fourth += square * square;
      }
      sums.second += row_second;
      sums.fourth += row_fourth;
    };
    const auto width = static_cast<std::size_t>(piece.width);
    for (int y = 0; y < piece.height; ++y) {
      const double* row = &piece.values[static_cast<std::size_t>(y) * width];
      const double* other = &piece.values[static_cast<std::size_t>((y + dy) % piece.height) * width];
      add(row, other + dx, piece.width - dx);
      add(row + piece.width - dx, other, dx);
    }
  }

  double pixels_ = 0.0, second_ = 0.0, third_ = 0.0, fourth_ = 0.0;
  double blocks_ = 0.0, block_sum_ = 0.0, block_square_ = 0.0;
  std::array<Steps, 2 * kLags.size()> steps_{};
};

// The moduli of the transforms of all pieces, and textures with these moduli and random phases.
//
// In a Gaussian texture the pieces are alike and nearly independent, so at each frequency the moduli of the
// pieces may be exchanged. A surrogate turns them by a random number of pieces, a different one at each
// frequency. A change from piece to piece thus shows in the photo and not in its surrogates.
class Surrogates {
 public:
  Surrogates(const Pieces& pieces, std::uint64_t seed)
      : pieces_(static_cast<std::size_t>(pieces.count())),
        seed_(seed),
        fourier_(pieces.width, pieces.height) {}

  void add_piece(const GreyImage& piece) {
    std::vector<std::complex<double>> half(fourier_.half_size());
    fourier_.forward(piece.values, half);
    for (const std::complex<double>& c : half) moduli_.push_back(std::abs(c));
  }

  // A surrogate that is being measured, piece by piece.
  struct Surrogate {
    CounterRandom random;
    std::vector<std::size_t> turns;
    MeasureSums sums;
  };
  Surrogate begin(std::uint64_t index) const { return {CounterRandom(seed_, index), draw_turns(index), {}}; }
  void add_piece(std::size_t t, Surrogate& s) const { s.sums.add(piece(t, s.turns, s.random)); }

 private:
  // By how many pieces the moduli of each frequency are turned. A lone piece keeps its own.
  std::vector<std::size_t> draw_turns(std::uint64_t index) const {
    std::vector<std::size_t> turns(fourier_.half_size(), 0);
    constexpr std::uint64_t kTurns = 0x7475726eu;  // a stream apart from that of the phases
    CounterRandom random(seed_ ^ kTurns, index);
    if (pieces_ > 1) {
      for (std::size_t& turn : turns) turn = random.below(pieces_);
    }
    return turns;
  }

  // Noise with the moduli of the pieces and independent uniform phases. The transform of a real image is
  // symmetric: in the columns that hold both a frequency and its opposite, one is the conjugate of the other,
  // and a frequency that is its own opposite is real.
  GreyImage piece(std::size_t t, const std::vector<std::size_t>& turns, CounterRandom& random) const {
    GreyImage noise{fourier_.width(), fourier_.height(), std::vector<double>(fourier_.grid_size())};
    std::vector<std::complex<double>> half(fourier_.half_size());
    const auto columns = static_cast<std::size_t>(fourier_.half_width());
    const auto rows = static_cast<std::size_t>(fourier_.height());
    for (std::size_t y = 0; y < rows; ++y) {
      const std::size_t opposite = (rows - y) % rows;
      for (std::size_t x = 0; x < columns; ++x) {
        const std::size_t i = y * columns + x;
        const bool self_opposite = x == 0 || 2 * x == static_cast<std::size_t>(fourier_.width());
        const double modulus = moduli_[(t + turns[i]) % pieces_ * half.size() + i];
        const double turn = random.uniform();
        if (self_opposite && opposite < y) {
          half[i] = std::conj(half[opposite * columns + x]);
        } else if (self_opposite && opposite == y) {
          half[i] = modulus * (turn < 0.5 ? -1.0 : 1.0);
        } else {
          half[i] = std::polar(modulus, 2.0 * std::numbers::pi * turn);
        }
      }
    }
    half[0] = 0.0;
    fourier_.inverse(half, noise.values);
    return noise;
  }

  std::size_t pieces_;
  std::uint64_t seed_;
  FourierTransform fourier_;
  std::vector<double> moduli_;  // piece by piece
};

// How unusual each sample is among all samples: its largest standardised measure.
std::vector<double> unusualness(const std::vector<Measures>& samples) {
  std::vector<double> largest(samples.size(), 0.0);
  const auto n = static_cast<double>(samples.size());
  for (std::size_t k = 0; k < Measures::kCount; ++k) {
    double mean = 0.0;
    double square = 0.0;
    for (const Measures& m : samples) mean += m.at(k) / n;
    for (const Measures& m : samples) square += (m.at(k) - mean) * (m.at(k) - mean) / n;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double deviation = std::abs(samples[i].at(k) - mean);
      largest[i] = std::max(largest[i], square > 0.0 ? deviation / std::sqrt(square) : 0.0);
    }
  }
  return largest;
}

constexpr int kSmallSide = 128;  // sides of fewer pixels let most textures pass for Gaussian ones
constexpr const char* kComparing = "comparing with Gaussian textures";

// The largest measures of a photo that is close to, or roughly, a Gaussian texture.
struct Limits {
  double skewness, excess_kurtosis, edges, spread;
};
constexpr Limits kClose{0.5, 1.0, 1.5, 2.0}, kRoughly{1.0, 2.0, 3.0, 4.0};

bool within(const Gaussianity& g, const Limits& limits) {
  return std::abs(g.skewness) <= limits.skewness && std::abs(g.excess_kurtosis) <= limits.excess_kurtosis &&
         g.edge_kurtosis <= limits.edges && g.variance_spread <= limits.spread;
}

Likeness judge_likeness(const Gaussianity& g) {
  if (!within(g, kRoughly)) return Likeness::kOutside;
  if (g.p_value > 0.05) return Likeness::kGaussian;
  return within(g, kClose) ? Likeness::kClose : Likeness::kRoughly;
}

// A phrase for every measure beyond its limit.
std::string reasons(const Gaussianity& g, const Limits& limits) {
  std::string why;
  if (std::abs(g.skewness) > limits.skewness)
    why += fmt::format(" its values are lopsided (skewness {:.2f}),", g.skewness);
  if (std::abs(g.excess_kurtosis) > limits.excess_kurtosis) {
    why += fmt::format(" extreme values are {} (excess kurtosis {:.2f}),",
                       g.excess_kurtosis > 0.0 ? "common" : "rare", g.excess_kurtosis);
  }
  if (g.edge_kurtosis > limits.edges)
    why += fmt::format(" it has edges (excess kurtosis of differences {:.1f}),", g.edge_kurtosis);
  if (g.variance_spread > limits.spread)
    why += fmt::format(" detail sits in places ({:.1f} times the spread of noise),", g.variance_spread);
  if (!why.empty()) why.pop_back();
  return why;
}

std::string sentence_for(const Gaussianity& g) {
  switch (g.likeness) {
    case Likeness::kGaussian:
      return "The photo is a Gaussian texture as far as can be told: noise of its spectrum looks like it.";
    case Likeness::kClose:
      return "The photo is close to a Gaussian texture: noise of its spectrum looks much like it.";
    case Likeness::kRoughly:
      return "The photo is roughly a Gaussian texture:" + reasons(g, kClose) +
             ". The noise keeps its spectrum and will look softer and more even.";
    case Likeness::kOutside:
      break;
  }
  return "The photo is no Gaussian texture:" + reasons(g, kRoughly) +
         ". The noise keeps its spectrum, and not its shapes.";
}

// Fills samples[1] and those behind it. A few surrogates at a time take a piece each between two reports.
void measure_surrogates(const Surrogates& noise, int pieces, std::vector<Measures>& samples,
                        const Progress& progress) {
  const auto together = static_cast<std::size_t>(std::max(thread_limit(), 1));
  for (std::size_t first = 1; first < samples.size(); first += together) {
    std::vector<Surrogates::Surrogate> group;
    for (std::size_t k = first; k < std::min(first + together, samples.size()); ++k)
      group.push_back(noise.begin(k));
    for (int t = 0; t < pieces; ++t) {
      const double done = static_cast<double>(first - 1) +
                          static_cast<double>(group.size() * static_cast<std::size_t>(t)) / pieces;
      if (!report(progress, done / static_cast<double>(samples.size()), kComparing))
        throw WorkError("gaussianity: stopped");
      parallel_for(0, static_cast<std::int64_t>(group.size()), [&](std::int64_t i) {
        noise.add_piece(static_cast<std::size_t>(t), group[static_cast<std::size_t>(i)]);
      });
    }
    for (std::size_t i = 0; i < group.size(); ++i) samples[first + i] = group[i].sums.measures();
  }
}

}  // namespace

// False alarms at p <= 0.05 over 200 Gaussian textures, measured by gaussianity_benchmark of release
// 0.2.0: 3.5 to 7 % of whole periods, 5.5 to 6.5 % of squares cut out of white noise, and 18 % of 64 x 64
// squares cut out of a smooth texture. In the last case the border is a large part of the square, and the
// periodic component changes it.
Gaussianity test_gaussianity(const GreyImage& image, std::uint64_t seed, const Progress& progress) {
  const Pieces pieces(image);
  Surrogates noise(pieces, seed);
  MeasureSums photo;
  for (int t = 0; t < pieces.count(); ++t) {
    if (!report(progress, 0.0, kComparing)) throw WorkError("gaussianity: stopped");
    const GreyImage piece = decompose_periodic(cut_piece(image, pieces, t)).periodic;
    photo.add(piece);
    noise.add_piece(piece);
  }
  const int surrogates = std::clamp(kSurrogatePieces / pieces.count(), kFewestSurrogates, kMostSurrogates);
  std::vector<Measures> samples(static_cast<std::size_t>(surrogates) + 1);
  samples[0] = photo.measures();
  measure_surrogates(noise, pieces.count(), samples, progress);

  Gaussianity result;
  result.skewness = samples[0].skewness;
  result.excess_kurtosis = samples[0].excess_kurtosis;
  for (const double k : samples[0].steps)
    result.edge_kurtosis += k / static_cast<double>(samples[0].steps.size());
  double usual_spread = 0.0;
  for (int i = 1; i <= surrogates; ++i) usual_spread += samples[static_cast<std::size_t>(i)].variance_spread;
  usual_spread /= surrogates;
  result.variance_spread = usual_spread > 0.0 ? samples[0].variance_spread / usual_spread : 1.0;
  const std::vector<double> unusual = unusualness(samples);
  const auto as_unusual =
      std::count_if(unusual.begin(), unusual.end(), [&](double u) { return u >= unusual[0]; });
  result.p_value = static_cast<double>(as_unusual) / (surrogates + 1);
  result.likeness = judge_likeness(result);
  result.sentence = sentence_for(result);
  if (std::min(image.width, image.height) < kSmallSide) {
    result.sentence +=
        fmt::format(" It is small, though: {} x {} pixels are little evidence.", image.width, image.height);
  }
  return result;
}

GreyImage known_texture(const GreyImage& image) {
  GreyImage part = largest_whole_part(image);
  return std::min(part.width, part.height) < 32 ? image : part;
}

}  // namespace astrolith
