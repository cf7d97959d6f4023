// A hash table of indices: chains of small integers in two flat arrays. The user of the table compares the
// keys.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace astrolith {

// The finaliser of splitmix64 (Steele, Lea and Flood 2014).
inline std::uint64_t mix_bits_64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

class IndexTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  // `expected`: about how many indices will be inserted. The table works with more of them, at a higher cost.
  explicit IndexTable(std::size_t expected)
      : heads_(std::bit_ceil(std::max<std::size_t>(expected, 16)), kNone) {}

  // Calls visitor(index) for every index inserted under this hash, and for some indices of other hashes.
  template <typename Visitor>
  void visit(std::uint64_t hash, const Visitor& visitor) const {
    for (std::uint32_t i = heads_[slot(hash)]; i != kNone; i = next_[i]) visitor(i);
  }
  // The k-th call inserts index k, counted from 0.
  void insert(std::uint64_t hash, std::uint32_t index) {
    std::uint32_t& head = heads_[slot(hash)];
    next_.push_back(head);
    head = index;
  }

 private:
  std::size_t slot(std::uint64_t hash) const { return hash & (heads_.size() - 1); }

  std::vector<std::uint32_t> heads_;
  std::vector<std::uint32_t> next_;
};

}  // namespace astrolith
