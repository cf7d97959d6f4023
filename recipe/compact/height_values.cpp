#include "recipe/compact/height_values_internal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "recipe/compact/bit_mixture.h"
#include "recipe/compact/height_predictor_internal.h"

namespace astrolith {
namespace {

// A logistic distribution of a height. Both numbers are in fine units, of which a step has `unit`.
struct HeightGuess {
  int height = 0;
  int error = 1;  // its expected absolute value times kErrorParts; at least 1
};

constexpr int kErrorParts = 18;

class HeightSearch {
 public:
  // Steps are 0 .. steps - 1.
  HeightSearch(int steps, int unit, BitCoder& coder) : steps_(steps), unit_(unit), coder_(coder) {}

  // Writes `step`, or ignores it and reads one. The search starts at `best`. Both guesses and the answers in
  // earlier searches predict each answer.
  int code(int step, const HeightGuess& best, const std::array<HeightGuess, 2>& guesses);

 private:
  static constexpr std::size_t kErrorClasses = 16;
  // The first bins have models of their own, up and down; the bins after them share the last model.
  static constexpr int kMostBins = 15;
  static constexpr std::size_t kQuestions = 2 * (kMostBins + 1);

  using Mixture = BitMixture<3>;

  bool at_least(int threshold, std::size_t question);
  void find_bin(int start, int width);
  int opinion(const HeightGuess& guess, int threshold) const;
  std::size_t error_class(int error) const;

  int steps_, unit_;
  BitCoder& coder_;
  std::vector<BitCounter> counters_ = std::vector<BitCounter>(kErrorClasses * kQuestions);
  std::vector<Mixture> mixtures_ = std::vector<Mixture>(kQuestions, Mixture(kFirstWeights));
  static constexpr Mixture::Opinions kFirstWeights = {20000, 20000, 10000};

  // The search at hand.
  int step_ = 0;
  int low_ = 0, high_ = 0;  // the step is at least low and below high
  std::array<HeightGuess, 2> guesses_;
  std::size_t error_class_ = 0;
};

// The mass that a logistic distribution has between two places, of 2^40.
std::uint64_t logistic_mass(std::int64_t from, std::int64_t to) {
  if (from >= 0) return logistic_tail(from) - logistic_tail(to);
  if (to <= 0) return logistic_tail(-to) - logistic_tail(-from);
  return (std::uint64_t{1} << 40) - logistic_tail(-from) - logistic_tail(to);
}

constexpr int kMostOpinion = 10 * kOctave;
constexpr int kUniformBins = 8;  // the bins after them double their width

int HeightSearch::code(int step, const HeightGuess& best, const std::array<HeightGuess, 2>& guesses) {
  step_ = step;
  low_ = 0;
  high_ = steps_;
  guesses_ = guesses;
  error_class_ = error_class(best.error);
  find_bin((best.height + unit_ / 2) / unit_, std::max(1, best.error / (2 * kErrorParts * unit_)));
  while (high_ - low_ > 1) at_least(low_ + (high_ - low_) / 2, kMostBins + 1);
  return low_;
}

// Goes up or down from the start until the step is in the bin.
void HeightSearch::find_bin(int start, int width) {
  const bool up = at_least(start, 0);
  int edge = start;
  for (int bin = 1;; ++bin) {
    edge += up ? width : -width;
    if (edge <= low_ || edge >= high_) return;
    const int model = std::min(bin, kMostBins) + (up ? 0 : kMostBins + 1);
    if (at_least(edge, static_cast<std::size_t>(model)) != up) return;
    if (bin >= kUniformBins) width *= 2;
  }
}

bool HeightSearch::at_least(int threshold, std::size_t question) {
  if (threshold <= low_) return true;
  if (threshold >= high_) return false;
  BitCounter& counter = counters_[error_class_ * kQuestions + question];
  Mixture& mixture = mixtures_[question];
  const Mixture::Opinions opinions = {opinion(guesses_[0], threshold), opinion(guesses_[1], threshold),
                                      counter.opinion()};
  const std::uint32_t one = mixture.share(opinions);
  const bool answer = coder_.code(step_ >= threshold, one);
  mixture.learn(opinions, one, answer);
  counter.learn(answer);
  (answer ? low_ : high_) = threshold;
  return answer;
}

// A logistic distribution whose tail is 1 / (1 + 2^(x / s)) has the expected absolute value 2 s.
int HeightSearch::opinion(const HeightGuess& guess, int threshold) const {
  const auto place = [&](int step) {
    const int fine = step * unit_ - unit_ / 2 - guess.height;
    return std::int64_t{fine} * (2 * kErrorParts * kOctave) / guess.error;
  };
  const std::int64_t middle = place(threshold);
  const std::uint64_t below = logistic_mass(place(low_), middle) + 1;
  const std::uint64_t above = logistic_mass(middle, place(high_)) + 1;
  return std::clamp(log2_units(above) - log2_units(below), -kMostOpinion, kMostOpinion);
}

// Half octaves of the expected error. The least class holds all errors below a sixteenth of a step.
std::size_t HeightSearch::error_class(int error) const {
  const int above = log2_units(static_cast<std::uint64_t>(error) * 16) -
                    log2_units(static_cast<std::uint64_t>(kErrorParts * unit_));
  return static_cast<std::size_t>(std::clamp(2 * above / kOctave, 0, static_cast<int>(kErrorClasses) - 1));
}

// A picture with a margin on three sides, so that pixels already coded can be read around every pixel.
template <class T>
class PaddedGrid {
 public:
  static constexpr int kMargin = 3;  // pixels left, right and above

  PaddedGrid(int width, int height, T value)
      : stride_(width + 2 * kMargin),
        values_(static_cast<std::size_t>(stride_) * (height + kMargin), value) {}

  T& at(int x, int y) { return values_[index(x, y)]; }
  T at(int x, int y) const { return values_[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y + kMargin) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(x + kMargin);
  }

  int stride_;
  std::vector<T> values_;
};

struct Weight {
  int x, y;  // offset of a pixel
  int weight;
};

constexpr int kPredictorBits = 16;  // of a difference of heights
constexpr int kMostFineBits = 4;

// The fine units of a step: as many as the predictors bear.
int fine_units(int steps) {
  const int bits = static_cast<int>(std::bit_width(static_cast<unsigned>(steps)));
  return 1 << std::min(kMostFineBits, kPredictorBits - std::min(kPredictorBits, bits));
}

// The pixels that predict a pixel, with their weights in the mean around it.
constexpr Weight kNeighbours[HeightPredictor::kMostNeighbours] = {
    {-1, 0, 2}, {0, -1, 2},  {-1, -1, 1}, {1, -1, 1}, {-2, 0, 1}, {0, -2, 1},
    {2, -1, 1}, {-2, -1, 1}, {-1, -2, 1}, {1, -2, 1}, {-3, 0, 1}, {0, -3, 1}};
constexpr int kHole = -1;

// The pixels whose errors tell the error of a pixel. The weights add up to kErrorParts.
constexpr Weight kErrors[] = {{-1, 0, 4}, {0, -1, 4},  {-1, -1, 2}, {1, -1, 2}, {-2, 0, 1},
                              {0, -2, 1}, {-1, -2, 1}, {1, -2, 1},  {2, -1, 1}, {-2, -1, 1}};

// The absolute errors of the guesses at all pixels so far.
class Errors {
 public:
  Errors(int width, int height, int unit)
      : grid_(width, height, 4 * unit), least_(std::max(1, kErrorParts * unit / 16)) {}

  // The expected error times kErrorParts.
  int around(int x, int y) const {
    int sum = 0;
    for (const Weight& w : kErrors) sum += w.weight * grid_.at(x + w.x, y + w.y);
    return std::max(sum, least_);
  }
  void set(int x, int y, int error) { grid_.at(x, y) = std::abs(error); }
  // Continues the errors around a hole into it.
  void fill(int x, int y) {
    grid_.at(x, y) = (grid_.at(x, y - 1) + grid_.at(x - 1, y) + grid_.at(x + 1, y - 1)) / 3;
  }

 private:
  PaddedGrid<int> grid_;
  int least_;
};

// Two predictors guess each height, one with a long memory, from twelve pixels or, to be quick, from six, and
// one from six with a shorter memory. The errors of either nearby tell how far its guess may be wrong.
class HeightCoder {
 public:
  HeightCoder(HeightPicture& picture, const HeightRange& range, Prediction prediction, BitCoder& coder)
      : picture_(picture),
        low_(range.low),
        steps_(range.high - range.low + 1),
        unit_(fine_units(steps_)),
        last_(steps_ / 2 * unit_),
        heights_(picture.width, picture.height, kHole),
        predictors_{HeightPredictor(picture.width,
                                    prediction == Prediction::kClose ? HeightPredictor::kMostNeighbours
                                                                     : HeightPredictor::kFewNeighbours,
                                    230, unit_),
                    HeightPredictor(picture.width, HeightPredictor::kFewNeighbours, 155, unit_)},
        errors_{Errors(picture.width, picture.height, unit_), Errors(picture.width, picture.height, unit_)},
        best_errors_(picture.width, picture.height, unit_),
        search_(steps_, unit_, coder) {}

  void code_picture() {
    std::uint16_t* value = picture_.values.data();
    for (int y = 0; y < picture_.height; ++y) {
      for (HeightPredictor& predictor : predictors_) predictor.start_row();
      for (int x = 0; x < picture_.width; ++x, ++value) {
        if (*value == 0) {
          pass_hole(x, y);
        } else {
          *value = static_cast<std::uint16_t>(low_ + code_height(x, y, *value - low_));
        }
      }
    }
  }

 private:
  int code_height(int x, int y, int step) {
    const int mean = mean_around(x, y);
    const HeightPredictor::Neighbours neighbours = neighbours_over(mean, x, y);
    std::array<HeightGuess, 2> guesses;
    for (std::size_t i = 0; i < 2; ++i) {
      const int guess = mean + predictors_[i].predict(x, neighbours);
      guesses[i] = {std::clamp(guess, 0, (steps_ - 1) * unit_), errors_[i].around(x, y)};
    }
    const HeightGuess best = {blend(guesses), best_errors_.around(x, y)};
    step = search_.code(step, best, guesses);
    const int height = step * unit_;
    for (std::size_t i = 0; i < 2; ++i) {
      errors_[i].set(x, y, height - guesses[i].height);
      predictors_[i].learn(x, neighbours, height - mean);
    }
    best_errors_.set(x, y, height - best.height);
    last_ = heights_.at(x, y) = height;
    return step;
  }

  // The mean of two guesses, weighted by the inverse squares of their errors.
  static int blend(const std::array<HeightGuess, 2>& guesses) {
    const auto square = [](std::int64_t error) { return error * error; };
    const std::int64_t first = square(guesses[1].error), second = square(guesses[0].error);
    return static_cast<int>((first * guesses[0].height + second * guesses[1].height) / (first + second));
  }

  // The mean of the pixels around that have a height, or else the height coded last.
  int mean_around(int x, int y) const {
    int sum = 0, weights = 0;
    for (const Weight& n : kNeighbours) {
      const int height = heights_.at(x + n.x, y + n.y);
      if (height == kHole) continue;
      sum += n.weight * height;
      weights += n.weight;
    }
    return weights > 0 ? sum / weights : last_;
  }

  // Holes are taken to have the mean height.
  HeightPredictor::Neighbours neighbours_over(int mean, int x, int y) const {
    HeightPredictor::Neighbours heights{};
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const int height = heights_.at(x + kNeighbours[i].x, y + kNeighbours[i].y);
      if (height != kHole) heights[i] = height - mean;
    }
    return heights;
  }

  void pass_hole(int x, int y) {
    for (HeightPredictor& predictor : predictors_) predictor.pass(x);
    for (Errors& errors : errors_) errors.fill(x, y);
    best_errors_.fill(x, y);
  }

  HeightPicture& picture_;
  int low_, steps_;
  int unit_;  // Heights are kept in fine units, of which a step has so many.
  int last_;  // the height coded last
  PaddedGrid<int> heights_;
  std::array<HeightPredictor, 2> predictors_;
  std::array<Errors, 2> errors_;
  Errors best_errors_;
  HeightSearch search_;
};

}  // namespace

void code_heights(HeightPicture& picture, const HeightRange& range, Prediction prediction, BitCoder& coder) {
  HeightCoder(picture, range, prediction, coder).code_picture();
}

}  // namespace astrolith
