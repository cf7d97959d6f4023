// The fitness of a whole swarm of candidates for a body's details in a few launches: where lines meet the
// surface of each, and the pair counts of each one's samples. A backend that is a GPU, or its twin on the
// host.
#pragma once

#include <algorithm>
#include <memory>

#include "cuda/field_on_backend.h"
#include "cuda/pair_tiles.h"

namespace astrolith {

// Points that move along lines, t <- t + F(start + t direction), from 0 and within +- reach.
struct ProbeLines {
  std::vector<Vec3f> start, direction;   // (points)
  std::vector<std::uint32_t> block;      // (points): where its metaballs are in `metaballs`
  FlatBlocksData metaballs;              // those that reach the lines of each block
  MetaballParameters<float> parameters;  // of them all
  float reach = 0.0f;
  int steps = 0;
};

// Layers of a candidate, which add their heights.
using CandidateLayers = std::vector<FractalNoise>;

class CandidateEvaluator {
 public:
  virtual ~CandidateEvaluator() = default;
  // t of every line (candidates, lines).
  virtual std::vector<std::vector<float>> heights(const ProbeLines& lines,
                                                  std::span<const CandidateLayers> candidates) = 0;
  // count_pairs (descriptor/pair_count.h) of each set.
  virtual std::vector<std::vector<std::uint64_t>> count(std::span<const SurfletArrays> sets, int bins) = 0;
};

// A thread a line of a candidate, candidate by candidate.
struct ProbeLine {
  FlatField field;             // with the layers of all candidates
  const FlatRange* layers_of;  // by candidate
  FlatBlocks parts;
  const Vec3f *start, *direction;
  const std::uint32_t* block;
  std::size_t lines;
  float reach;
  int steps;
  float* heights;  // (candidates, lines)

  ASTROLITH_HD void operator()(std::size_t i) const {
    const FlatRange layers = layers_of[i / lines];
    const std::size_t line = i % lines;
    const FlatBlock near = parts.block(block[line]);
    const Vec3f from = start[line], along = direction[line];
    float t = 0.0f;
    for (int step = 0; step < steps; ++step) {
      const Vec3f p{from.x + t * along.x, from.y + t * along.y, from.z + t * along.z};
      float f = flat_body(field, near, p).distance;
      for (std::uint32_t l = layers.first; l < layers.first + layers.count; ++l) {
        f += flat_fractal(field, field.layers[l], p);
      }
      t = std::clamp(t + f, -reach, reach);
    }
    heights[i] = t;
  }
};

template <class Backend>
class CandidateEvaluatorOn : public CandidateEvaluator {
 public:
  explicit CandidateEvaluatorOn(Backend backend) : backend_(std::move(backend)) {}

  std::vector<std::vector<float>> heights(const ProbeLines& lines,
                                          std::span<const CandidateLayers> candidates) override {
    FlatFieldData data(lines.parameters);
    std::vector<FlatRange> layers_of;
    for (const CandidateLayers& layers : candidates) {
      layers_of.push_back(
          {static_cast<std::uint32_t>(data.layers.size()), static_cast<std::uint32_t>(layers.size())});
      for (const FractalNoise& noise : layers) data.add(noise);
    }
    const std::size_t n = lines.start.size();
    const FieldOnBackend<Backend> field(backend_, data);
    const BlocksOnBackend<Backend> parts(backend_, lines.metaballs);
    const auto ranges = backend_.upload(std::span<const FlatRange>(layers_of));
    const auto start = backend_.upload(std::span<const Vec3f>(lines.start));
    const auto direction = backend_.upload(std::span<const Vec3f>(lines.direction));
    const auto block = backend_.upload(std::span<const std::uint32_t>(lines.block));
    auto heights = backend_.template allocate<float>(n * candidates.size());
    backend_.launch("probing surfaces", heights.size(),
                    ProbeLine{field.view(), ranges.data(), parts.view(), start.data(), direction.data(),
                              block.data(), n, lines.reach, lines.steps, heights.data()});
    std::vector<float> all(heights.size());
    backend_.download(heights, std::span(all));
    return parts_of(all, candidates.size());
  }

  std::vector<std::vector<std::uint64_t>> count(std::span<const SurfletArrays> sets, int bins) override {
    return parts_of(count_sets_on(backend_, sets, bins, {}), sets.size());
  }

 private:
  template <typename T>
  static std::vector<std::vector<T>> parts_of(const std::vector<T>& all, std::size_t count) {
    std::vector<std::vector<T>> parts;
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * (all.size() / count));
      parts.emplace_back(first, first + static_cast<std::ptrdiff_t>(all.size() / count));
    }
    return parts;
  }

  Backend backend_;
};

}  // namespace astrolith
