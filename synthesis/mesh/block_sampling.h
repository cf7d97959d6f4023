// Fills the samples of the blocks of a layer. Each block first samples the points that it owns and those
// without an active owner. It then copies the other samples of its halo from their owners.
//
// A mesh needs the sign of F at every sample, but its value only at the ends of crossed edges. Where a field
// can prove signs, F is evaluated at the other samples only, and later at the ends of crossed edges that have
// no value yet (block_polygons.h). The mesh is the same as if F had been evaluated at all samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "synthesis/mesh/block_culling.h"
#include "synthesis/mesh/block_layer.h"

namespace astrolith {

// A batch of points that one call evaluates.
template <std::size_t Capacity>
class PointBatch {
 public:
  void add(float px, float py, float pz) {
    x_[size_] = px;
    y_[size_] = py;
    z_[size_] = pz;
    ++size_;
  }
  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }
  float value(std::size_t i) const { return value_[i]; }

  // Adds point i of another batch.
  template <std::size_t Other>
  void add(const PointBatch<Other>& from, std::size_t i) {
    add(from.x_[i], from.y_[i], from.z_[i]);
  }

  template <FieldBlockLike Block>
  void evaluate(const Block& field, float band = kExactEverywhere) {
    if (size_ == 0) return;
    const std::size_t size = padded();
    const auto points = [size](const auto& v) { return std::span(v).first(size); };
    field.evaluate(points(x_), points(y_), points(z_), std::span(value_).first(size), band);
  }
  // Writes for each point what the field proves of its sign.
  template <HasSureSigns Block>
  void find_signs(const Block& field, float tolerance, std::span<std::int8_t> sign) const {
    const auto points = [this](const auto& v) { return std::span(v).first(size_); };
    if (size_ > 0) field.find_signs(points(x_), points(y_), points(z_), tolerance, sign.first(size_));
  }
  // Evaluates points that are the corners of tetrahedra, four after four.
  template <FieldBlockLike Block>
  void evaluate_tetrahedra(const Block& field) {
    if constexpr (HasTetrahedra<Block>) {
      const auto points = [this](const auto& v) { return std::span(v).first(size_); };
      field.evaluate_tetrahedra(points(x_), points(y_), points(z_), std::span(value_).first(size_));
    } else {
      evaluate(field);
    }
  }

 private:
  template <std::size_t Other>
  friend class PointBatch;

  // Repeats the last point, so that vector loops over the points have no remainder. Returns the size with the
  // repetitions.
  std::size_t padded() {
    const std::size_t end = (size_ + kVectorPoints - 1) / kVectorPoints * kVectorPoints;
    for (auto* c : {&x_, &y_, &z_}) std::fill(c->begin() + size_, c->begin() + end, (*c)[size_ - 1]);
    return end;
  }

  static constexpr std::size_t kVectorPoints = 16;
  static constexpr std::size_t kRoom = (Capacity + kVectorPoints - 1) / kVectorPoints * kVectorPoints;
  std::size_t size_ = 0;
  std::array<float, kRoom> x_, y_, z_, value_;
};

// The value of samples beyond the grid, in blocks that stick out of it, and of samples that are not known
// yet.
inline constexpr float kOutsideGrid = -1.0f;

// The value of a sample of which only the sign is known: infinite, with this sign.
inline constexpr float kOnlySign = std::numeric_limits<float>::infinity();
ASTROLITH_HD inline bool has_only_sign(float value) { return value == kOnlySign || value == -kOnlySign; }

// Below this part of a step, a distance to the surface is not worth much work for the proof of a sign.
inline constexpr double kSignTolerance = 0.25;

// The accuracy band of samples, in steps of the grid. Along an edge a distance changes by about a step, so
// that both ends of an edge that the surface crosses lie within the band. Where a field is steeper an end may
// lie beyond the band. Its sign is still right, and the vertex stays on its edge.
inline constexpr double kSampleBand = 2.0;

// Local samples first .. last along x of a row that a block has to evaluate itself.
struct SampleRow {
  int first, last;
};

// The samples of row y, z that lie in the grid and are owned by the block itself or by no active block.
template <int B>
ASTROLITH_HD SampleRow row_to_evaluate(const BlockGrid<B>& grid, int layer_z, const Owners<B>& owners,
                                       const LayerBlock<B>& block, int y, int z) {
  const auto mine = [&](unsigned owner) { return owner == 0 || owners[owner] == nullptr; };
  const auto [nx, ny, nz] = grid.samples.cells;
  if (block.y * B + y > ny || layer_z * B + z > nz) return {0, -1};
  return {mine(owner_index(0, y, z)) ? 0 : 1, mine(owner_index(1, y, z)) ? std::min(B, nx - block.x * B) : 0};
}

// True when the block holds samples on the border of the grid.
template <int B>
bool is_at_border(const BlockGrid<B>& grid, int layer_z, const LayerBlock<B>& block) {
  const auto touches = [](int first, int cells) { return first == 0 || first + B >= cells; };
  const auto [nx, ny, nz] = grid.samples.cells;
  return touches(block.x * B, nx) || touches(block.y * B, ny) || touches(layer_z * B, nz);
}

template <int B>
ASTROLITH_HD bool on_border(const BlockGrid<B>& grid, int gx, int gy, int gz) {
  const auto [nx, ny, nz] = grid.samples.cells;
  return gx == 0 || gy == 0 || gz == 0 || gx == nx || gy == ny || gz == nz;
}

// Throws WorkError when a sample on the grid's border is inside.
template <int B>
void check_border(const BlockGrid<B>& grid, int layer_z, const LayerBlock<B>& block) {
  for (int z = 0; z <= B; ++z) {
    for (int y = 0; y <= B; ++y) {
      for (int x = 0; x <= B; ++x) {
        const bool at_border = on_border(grid, block.x * B + x, block.y * B + y, layer_z * B + z);
        if (at_border && block.values[LayerBlock<B>::sample(x, y, z)] > 0.0f) fail_at_border();
      }
    }
  }
}

// The values of a batch of samples, or kOnlySign with their signs. Returns the number of evaluations of F.
template <std::size_t Capacity, FieldBlockLike Block>
std::int64_t take_samples(const Block& field, double step, PointBatch<Capacity>& samples,
                          std::array<float, Capacity>& values) {
  const auto band = static_cast<float>(kSampleBand * step);
  if constexpr (HasSureSigns<Block>) {
    std::array<std::int8_t, Capacity> signs;
    samples.find_signs(field, static_cast<float>(kSignTolerance * step), signs);
    PointBatch<Capacity> open;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (signs[i] == 0) open.add(samples, i);
    }
    open.evaluate(field, band);
    std::size_t next = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      values[i] = signs[i] == 0 ? open.value(next++) : signs[i] > 0 ? kOnlySign : -kOnlySign;
    }
    return static_cast<std::int64_t>(open.size());
  } else {
    samples.evaluate(field, band);
    for (std::size_t i = 0; i < samples.size(); ++i) values[i] = samples.value(i);
    return static_cast<std::int64_t>(samples.size());
  }
}

// How many samples a block has taken, and at how many of them F was evaluated.
struct SampleCounts {
  std::int64_t samples = 0, evaluations = 0;
};

// Takes the samples whose owner is the block itself or no active block. Throws WorkError when a sample on the
// border of a closed grid is inside the body.
template <int B, FieldBlockLike Block>
SampleCounts evaluate_samples(const BlockGrid<B>& grid, int layer_z, const Block& field,
                              const Owners<B>& owners, LayerBlock<B>& block) {
  PointBatch<LayerBlock<B>::kSamples> batch;
  const auto for_each_row = [&](const auto& visit) {
    for (int z = 0; z <= B; ++z) {
      for (int y = 0; y <= B; ++y) visit(y, z, row_to_evaluate(grid, layer_z, owners, block, y, z));
    }
  };
  for_each_row([&](int y, int z, SampleRow row) {
    const float py = grid.samples.y(block.y * B + y), pz = grid.samples.z(layer_z * B + z);
    for (int x = row.first; x <= row.last; ++x) batch.add(grid.samples.x(block.x * B + x), py, pz);
  });
  std::array<float, LayerBlock<B>::kSamples> values;
  const std::int64_t evaluations = take_samples(field, grid.samples.step, batch, values);
  block.values.fill(kOutsideGrid);
  std::size_t next = 0;
  for_each_row([&](int y, int z, SampleRow row) {
    for (int x = row.first; x <= row.last; ++x) {
      block.values[LayerBlock<B>::sample(x, y, z)] = values[next++];
    }
  });
  if (grid.closed && is_at_border(grid, layer_z, block)) check_border(grid, layer_z, block);
  return {static_cast<std::int64_t>(batch.size()), evaluations};
}

// The index at which the owner of a halo sample keeps it.
template <int B>
ASTROLITH_HD std::size_t owned_sample(int x, int y, int z) {
  return LayerBlock<B>::sample(x == 0 ? B : x, y == 0 ? B : y, z == 0 ? B : z);
}

// Copies a halo sample from its owner, where the owner is active.
template <int B>
ASTROLITH_HD void fill_halo_sample(const Owners<B>& owners, int x, int y, int z, LayerBlock<B>& block) {
  const LayerBlock<B>* owner = owners[owner_index(x, y, z)];
  if (owner == nullptr) return;
  block.values[LayerBlock<B>::sample(x, y, z)] = owner->values[owned_sample<B>(x, y, z)];
}

// Fills all halo samples, by rows.
template <int B>
void fill_sample_halo(const Owners<B>& owners, LayerBlock<B>& block) {
  for (int z = 0; z <= B; ++z) {
    for (int y = 0; y <= B; ++y) {
      fill_halo_sample(owners, 0, y, z, block);
      if (y != 0 && z != 0) continue;
      const LayerBlock<B>* owner = owners[owner_index(1, y, z)];
      if (owner == nullptr) continue;
      std::copy_n(owner->values.data() + owned_sample<B>(1, y, z), B,
                  block.values.data() + LayerBlock<B>::sample(1, y, z));
    }
  }
}

// The signs of row sign_row(y, z).
template <int B>
ASTROLITH_HD SignRow row_signs(const LayerBlock<B>& block, std::size_t row) {
  const float* value = block.values.data() + row * LayerBlock<B>::kSide;
  SignRow signs = 0;
  for (int x = 0; x <= B; ++x) signs |= (value[x] > 0.0f ? SignRow{1} : SignRow{0}) << x;
  return signs;
}

template <int B>
void take_signs(LayerBlock<B>& block) {
  for (std::size_t row = 0; row < block.signs.size(); ++row) block.signs[row] = row_signs(block, row);
}

// Whether the surface crosses an edge between two samples of the block. Expects the signs of all rows.
template <int B>
bool is_crossed(const LayerBlock<B>& block) {
  SignRow any = 0, all = LayerBlock<B>::kWholeRow;
  for (const SignRow row : block.signs) any |= row, all &= row;
  return any != 0 && all != LayerBlock<B>::kWholeRow;
}

// True when the surface crosses a side of a block. Sides are numbered 2 axis + (0 low, 1 high). `last` holds
// the last local samples that lie in the grid.
template <int B>
ASTROLITH_HD bool is_side_crossed(const LayerBlock<B>& block, int side, const std::array<int, 3>& last) {
  const auto axis = static_cast<std::size_t>(side / 2);
  const int fixed = side % 2 != 0 ? B : 0;
  if (fixed > last[axis]) return false;
  const SignRow mask = axis == 0 ? SignRow{1} << fixed : (SignRow{2} << last[0]) - 1;
  SignRow any = 0, all = mask;
  for (int v = 0; v <= last[axis == 2 ? 1 : 2]; ++v) {
    for (int u = 0; u <= (axis == 0 ? last[1] : 0); ++u) {
      const SignRow row = block.signs[axis == 0   ? LayerBlock<B>::sign_row(u, v)
                                      : axis == 1 ? LayerBlock<B>::sign_row(fixed, v)
                                                  : LayerBlock<B>::sign_row(v, fixed)];
      any |= row & mask;
      all &= row;
    }
  }
  return any != 0 && all != mask;
}

// The last local samples of a block that lie in the grid.
template <int B>
ASTROLITH_HD std::array<int, 3> last_samples(const BlockGrid<B>& grid, const LayerBlock<B>& block,
                                             int layer_z) {
  const std::array<int, 3> place{block.x, block.y, layer_z};
  std::array<int, 3> last{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    last[axis] = std::min(B, grid.samples.cells[axis] - place[axis] * B);
  }
  return last;
}

[[noreturn]] inline void fail_at_open_side() {
  throw WorkError("mesher: the surface enters a block that a bound of the field proved free of it");
}

// Throws WorkError when the surface crosses a side of a block whose neighbour there was proved free of
// surface, since the mesh would have a hole. `below` and `above` are null where these layers are not made.
template <int B>
void check_open_sides(const BlockGrid<B>& grid, int layer_z, const BlockLayer<B>& layer,
                      const BlockLayer<B>* below, const BlockLayer<B>* above) {
  const auto lacks_block = [](const BlockLayer<B>* there, int x, int y) {
    return there != nullptr && there->contains(x, y) && there->find(x, y) == nullptr;
  };
  parallel_for(0, static_cast<std::int64_t>(layer.blocks.size()), [&](std::int64_t i) {
    const LayerBlock<B>& block = layer.blocks[static_cast<std::size_t>(i)];
    const int x = block.x, y = block.y;
    const std::array<bool, 6> lacking = {lacks_block(&layer, x - 1, y), lacks_block(&layer, x + 1, y),
                                         lacks_block(&layer, x, y - 1), lacks_block(&layer, x, y + 1),
                                         lacks_block(below, x, y),      lacks_block(above, x, y)};
    const std::array<int, 3> last = last_samples(grid, block, layer_z);
    for (int side = 0; side < 6; ++side) {
      if (lacking[static_cast<unsigned>(side)] && is_side_crossed(block, side, last)) fail_at_open_side();
    }
  });
}

}  // namespace astrolith
