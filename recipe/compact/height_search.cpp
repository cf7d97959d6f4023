#include "recipe/compact/height_search_internal.h"

#include <algorithm>

namespace astrolith {
namespace {

// The mass that a logistic distribution has between two places, of 2^40.
std::uint64_t logistic_mass(std::int64_t from, std::int64_t to) {
  if (from >= 0) return logistic_tail(from) - logistic_tail(to);
  if (to <= 0) return logistic_tail(-to) - logistic_tail(-from);
  return (std::uint64_t{1} << 40) - logistic_tail(-from) - logistic_tail(to);
}

constexpr int kMostOpinion = 10 * kOctave;
constexpr int kBinsOfOneWidth = 8;  // the bins after them double their width

}  // namespace

int HeightSearch::code(int step, const HeightGuess& best, const std::array<HeightGuess, 2>& guesses) {
  step_ = step;
  low_ = 0;
  high_ = steps_;
  guesses_ = guesses;
  error_class_ = class_of(best.error);
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
    if (bin >= kBinsOfOneWidth) width *= 2;
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
  return std::clamp(log_of(above) - log_of(below), -kMostOpinion, kMostOpinion);
}

// Half octaves of the expected error. The least class holds all errors below a sixteenth of a step.
std::size_t HeightSearch::class_of(int error) const {
  const int above = log_of(static_cast<std::uint64_t>(error) * 16) -
                    log_of(static_cast<std::uint64_t>(kErrorParts * unit_));
  return static_cast<std::size_t>(std::clamp(2 * above / kOctave, 0, static_cast<int>(kErrorClasses) - 1));
}

}  // namespace astrolith
