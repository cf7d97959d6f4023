// Codes a height by questions "is it at least t?", the likeliest heights first.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "recipe/compact/bit_mixture.h"

namespace astrolith {

// A logistic distribution of a height. Both numbers are in fine units, of which a step has `unit`.
struct HeightGuess {
  int height = 0;
  int error = 1;  // its expected absolute value times kErrorParts; at least 1
};
inline constexpr int kErrorParts = 18;

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
  std::size_t class_of(int error) const;

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

}  // namespace astrolith
