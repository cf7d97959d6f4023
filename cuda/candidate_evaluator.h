// Evaluates many candidates for a body's details in a few launches of a backend: where lines meet the surface
// of each candidate, and the pair counts of each candidate's samples. The fitness of a swarm follows from
// both (estimation/shape/details/).
#pragma once

#include <algorithm>
#include <memory>

#include "cuda/backend_lists.h"
#include "cuda/pair_groups.h"
#include "synthesis/body/body_at_point.h"
#include "synthesis/noise/fractal_noise.h"

namespace astrolith {

// Lines along which points move to the surface: t <- t + F(start + t direction), from t = 0, within +-reach.
struct ProbeLines {
  std::vector<Vec3f> start, direction;  // (lines)
  std::vector<std::uint32_t> block;     // (lines): number of the block of each line
  // The metaballs that reach the lines of each block, one block after another.
  std::vector<MetaballSphere<float>> metaballs;
  std::vector<std::uint32_t> first_metaball{0};  // (blocks + 1)
  MetaballParameters<float> parameters;          // parameters of all metaballs
  float reach = 0.0f;                            // length units
  int steps = 0;                                 // number of steps of each point
};

// The layers of the candidates as tables. The layers of a candidate add their heights.
struct Candidates {
  ArrayStore arrays;
  std::vector<FractalNoise> noises;         // layers of all candidates
  std::vector<ListRange> candidate_ranges;  // layers of each candidate in `noises`

  // Adds a candidate. `seed` is the recipe's. Layers are numbered from 0. The surface must lie in `domain`.
  void add(std::span<const FractalLayer> layers, std::uint64_t seed, const Box& domain) {
    candidate_ranges.push_back(
        {static_cast<std::uint32_t>(noises.size()), static_cast<std::uint32_t>(layers.size())});
    for (std::size_t i = 0; i < layers.size(); ++i) {
      noises.push_back(make_noise(layers[i], seed, static_cast<int>(i), domain, arrays));
    }
  }
  std::size_t size() const { return candidate_ranges.size(); }
};

class CandidateEvaluator {
 public:
  virtual ~CandidateEvaluator() = default;
  // The final t of every line, length units (candidates, lines).
  virtual std::vector<std::vector<float>> heights(const ProbeLines& lines, const Candidates& candidates) = 0;
  // The counts that count_pairs (descriptor/pair_count.h) finds for each set. `bins` is kMinBins .. kMaxBins.
  virtual std::vector<std::vector<std::uint64_t>> count(std::span<const SurfletArrays> sets, int bins) = 0;
};

// Each thread moves the point of one line for one candidate. Threads are numbered candidate by candidate.
struct ProbeLine {
  ArrayView arrays;
  BodyTables body;             // a plain body of one leaf
  const FractalNoise* noises;  // layers of all candidates
  const ListRange* candidate_ranges;
  LeafLists metaballs;  // one list for each block
  const Vec3f *start, *direction;
  const std::uint32_t* block;
  std::size_t lines;
  float reach;
  int steps;
  float* heights;  // (candidates, lines)

  ASTROLITH_HD void operator()(std::size_t i) const {
    const ListRange own = candidate_ranges[i / lines];
    const std::size_t line = i % lines;
    const LeafLists block_lists{metaballs.spheres, metaballs.first + block[line]};
    const Vec3f from = start[line], along = direction[line];
    float t = 0.0f;
    for (int step = 0; step < steps; ++step) {
      const Vec3f p{from.x + t * along.x, from.y + t * along.y, from.z + t * along.z};
      float f = body_at(body, arrays, block_lists, p).distance;
      for (std::uint32_t k = own.first; k < own.first + own.count; ++k) f += height_at(noises[k], arrays, p);
      t = std::clamp(t + f, -reach, reach);
    }
    heights[i] = t;
  }
};

// The evaluator on one backend.
template <class Backend>
class CandidateEvaluatorOn : public CandidateEvaluator {
 public:
  explicit CandidateEvaluatorOn(Backend backend) : backend_(std::move(backend)) {}

  std::vector<std::vector<float>> heights(const ProbeLines& lines, const Candidates& candidates) override {
    ArrayStore store = candidates.arrays;
    BodyTables body;
    body.leaves = store.add(std::vector<BodyLeaf>{{lines.parameters, false, {}, {}, {}}});
    const ArrayView view = store.view();
    const auto arrays = backend_.upload(std::span(view.bytes, view.size));
    const auto noises = backend_.upload(std::span<const FractalNoise>(candidates.noises));
    const auto candidate_ranges = backend_.upload(std::span<const ListRange>(candidates.candidate_ranges));
    const auto metaballs = backend_.upload(std::span<const MetaballSphere<float>>(lines.metaballs));
    const auto first_metaball = backend_.upload(std::span<const std::uint32_t>(lines.first_metaball));
    const auto start = backend_.upload(std::span<const Vec3f>(lines.start));
    const auto direction = backend_.upload(std::span<const Vec3f>(lines.direction));
    const auto block = backend_.upload(std::span<const std::uint32_t>(lines.block));
    const std::size_t n = lines.start.size();
    auto heights = backend_.template allocate<float>(n * candidates.size());
    backend_.launch("probing surfaces", heights.size(),
                    ProbeLine{{arrays.data(), view.size},
                              body,
                              noises.data(),
                              candidate_ranges.data(),
                              {metaballs.data(), first_metaball.data()},
                              start.data(),
                              direction.data(),
                              block.data(),
                              n,
                              lines.reach,
                              lines.steps,
                              heights.data()});
    std::vector<float> all(heights.size());
    backend_.download(heights, std::span(all));
    return split(all, candidates.size());
  }

  std::vector<std::vector<std::uint64_t>> count(std::span<const SurfletArrays> sets, int bins) override {
    return split(count_sets_on(backend_, sets, bins, {}), sets.size());
  }

 private:
  template <typename T>
  static std::vector<std::vector<T>> split(const std::vector<T>& all, std::size_t count) {
    std::vector<std::vector<T>> lists;
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * (all.size() / count));
      lists.emplace_back(first, first + static_cast<std::ptrdiff_t>(all.size() / count));
    }
    return lists;
  }

  Backend backend_;
};

}  // namespace astrolith
