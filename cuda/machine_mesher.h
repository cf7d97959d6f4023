// LayeredMesher (synthesis/mesher.h) on a machine: the same vertices and triangles in the same order. Blocks
// are culled on the host, layer by layer; as many layers as the memory takes are then sampled, numbered and
// polygonised together, and handed to the sink, so that a mesh may be larger than the machine's memory.
#pragma once

#include <deque>
#include <utility>

#include "cuda/field_on_machine.h"
#include "cuda/mesh_steps.h"

namespace astrolith {

template <class Machine>
class MachineMesher {
 public:
  // Expects a field without obstacle_to_flattening().
  MachineMesher(Machine& machine, const ImplicitField& field, const MeshGrid& grid, MeshSink& sink)
      : machine_(machine),
        grid_(grid),
        whole_(field.gather(grid.samples.box({0, 0, 0}, grid.samples.cells, grid.samples.step))),
        data_(field),
        field_(machine, data_),
        cells_(machine.upload(std::span<const CellTriangles>(marching_cubes_table()))),
        sink_(sink) {
    statistics_.step = grid.samples.step;
    statistics_.total_blocks = std::int64_t{grid.blocks(0)} * grid.blocks(1) * grid.blocks(2);
  }

  MeshStatistics run(const Progress& progress) {
    const LayerRange range = layers_of_window(grid_);
    int done = range.first;
    while (done < range.end) {
      cull_until(done, range.end);
      std::size_t layers = batch_size();
      while (!try_batch(done, layers)) layers = smaller(layers);
      done += static_cast<int>(layers);
      culled_.erase(culled_.begin(), culled_.begin() + static_cast<std::ptrdiff_t>(layers));
      if (!report(progress, double(done - range.first) / (range.end - range.first),
                  std::to_string(statistics_.triangles) + " triangles")) {
        throw WorkError("mesher: stopped before the mesh was complete");
      }
    }
    return statistics_;
  }

 private:
  template <typename T>
  using Array = typename Machine::template Array<T>;
  using Layer = std::vector<BlockNode<FieldBlock>>;
  static constexpr std::size_t kMostBlocks = 32768;  // in a batch: 400 MB

  // The last layer of the batch before.
  struct Kept {
    Array<MeshBlock> blocks;
    std::size_t first = 0;  // in blocks
    std::vector<BlockColumn> columns;
    LayerIndex index;
    int z = 0;
  };

  // What the counts of a batch make of it.
  struct Totals {
    std::vector<std::uint32_t> first_vertex, first_triangle;  // (layers + 1)
  };

  // Layers from `first` on, until there are enough blocks for a batch.
  void cull_until(int first, int end) {
    std::size_t blocks = 0;
    for (const Layer& layer : culled_) blocks += layer.size();
    while (first + static_cast<int>(culled_.size()) < end && blocks < most_blocks_) {
      culled_.push_back(mixed_blocks(grid_, whole_, first + static_cast<int>(culled_.size())));
      blocks += culled_.back().size();
    }
  }

  // Layers whose blocks fit, at least one.
  std::size_t batch_size() const {
    std::size_t layers = 1, blocks = culled_.front().size();
    while (layers < culled_.size() && blocks + culled_[layers].size() <= most_blocks_) {
      blocks += culled_[layers++].size();
    }
    return layers;
  }

  std::size_t smaller(std::size_t layers) {
    if (layers == 1) {
      throw WorkError("GPU: too little memory for one layer of blocks; lower the resolution or use the CPU");
    }
    most_blocks_ = std::max<std::size_t>(most_blocks_ / 2, 1);
    return layers / 2;
  }

  // False where the machine's memory is too small; nothing has happened then.
  bool try_batch(int first_z, std::size_t layers) {
    try {
      mesh_batch(first_z, layers);
      return true;
    } catch (const OutOfDeviceMemory&) {
      return false;
    }
  }

  void mesh_batch(int first_z, std::size_t layers) {
    std::vector<std::vector<BlockColumn>> columns(layers);
    FlatBlocksData parts(data_);
    std::vector<const FieldBlock*> blocks;
    for (std::size_t l = 0; l < layers; ++l) {
      for (const auto& node : culled_[l]) {
        columns[l].push_back({node.x, node.y});
        blocks.push_back(&node.field);
      }
    }
    parts.add(blocks);
    Kept last{{}, parts.size() - columns.back().size(), columns.back(), {}, first_z + int(layers) - 1};
    const std::vector<BlockPlace> places = place_blocks(grid_, first_z, columns, kept_.index, last.index);
    std::vector<std::uint32_t> rows_before{0};
    for (const auto& layer : columns) {
      rows_before.push_back(rows_before.back() + static_cast<std::uint32_t>(MeshBatch::kRows * layer.size()));
    }
    mesh_places(places, parts, rows_before, last);
    kept_ = std::move(last);
  }

  void mesh_places(const std::vector<BlockPlace>& places, const FlatBlocksData& parts,
                   const std::vector<std::uint32_t>& rows_before, Kept& last) {
    const std::size_t n = places.size();
    const auto place_array = machine_.upload(std::span<const BlockPlace>(places));
    const BlocksOnMachine<Machine> part_arrays(machine_, parts);
    last.blocks = machine_.template allocate<MeshBlock>(n);
    auto failure = zeros<std::uint32_t>(1);
    auto counters = zeros<std::uint64_t>(2);  // evaluations, cut vertices
    const MeshBatch batch{grid_,
                          field_.view(),
                          part_arrays.view(),
                          place_array.data(),
                          last.blocks.data(),
                          kept_.blocks.data() + kept_.first,
                          cells_.data(),
                          failure.data()};
    sample(batch, n, counters);
    check_sides(batch, n, places);
    Array<std::uint32_t> vertex_rows = zeros<std::uint32_t>(n * MeshBatch::kRows + 1);
    Array<std::uint32_t> triangle_rows = zeros<std::uint32_t>(n * MeshBatch::kRows + 1);
    machine_.launch("counting triangles", n * MeshBatch::kRows,
                    CountRows{batch, vertex_rows.data(), triangle_rows.data(), counters.data() + 1});
    machine_.running_sum(vertex_rows);
    machine_.running_sum(triangle_rows);
    const Totals totals = pick_starts(vertex_rows, triangle_rows, rows_before);
    require_success(failure);
    emit(batch, n, totals, vertex_rows, triangle_rows, failure);
    add_up(n, totals, counters);
  }

  void sample(const MeshBatch& batch, std::size_t n, Array<std::uint64_t>& counters) {
    machine_.launch("starting blocks", n, StartBlocks{batch, counters.data()});
    const auto band = static_cast<float>(kSampleBand * grid_.samples.step);
    machine_.launch("evaluating samples", n * MeshBlock::kSamples, EvaluateSamples{batch, band});
    machine_.launch("borrowing samples", n * MeshBlock::kSamples, BorrowSamples{batch});
    machine_.launch("taking signs", n * TakeSigns::kRows, TakeSigns{batch});
  }

  // Of this batch, and of the layer before it now that the one above it is known.
  void check_sides(const MeshBatch& batch, std::size_t n, const std::vector<BlockPlace>& places) {
    machine_.launch("checking sides", 6 * n, CheckSides{batch, batch.blocks, nullptr, 0});
    if (kept_.columns.empty()) return;
    LayerIndex above(grid_.blocks(0), grid_.blocks(1));
    for (const BlockPlace& p : places) {
      if (p.z == kept_.z + 1) above.set(p.x, p.y, 0);
    }
    const std::vector<std::uint32_t> lacking = lacking_above(kept_.columns, above);
    const auto array = machine_.upload(std::span<const std::uint32_t>(lacking));
    machine_.launch("checking sides", 6 * lacking.size(),
                    CheckSides{batch, batch.below, array.data(), kept_.z});
  }

  Totals pick_starts(const Array<std::uint32_t>& vertex_rows, const Array<std::uint32_t>& triangle_rows,
                     const std::vector<std::uint32_t>& rows_before) {
    const auto rows = machine_.upload(std::span<const std::uint32_t>(rows_before));
    auto vertices = machine_.template allocate<std::uint32_t>(rows_before.size());
    auto triangles = machine_.template allocate<std::uint32_t>(rows_before.size());
    machine_.launch(
        "finding layers", rows_before.size(),
        PickStarts{vertex_rows.data(), triangle_rows.data(), rows.data(), vertices.data(), triangles.data()});
    Totals totals{std::vector<std::uint32_t>(rows_before.size()),
                  std::vector<std::uint32_t>(rows_before.size())};
    machine_.download(vertices, std::span(totals.first_vertex));
    machine_.download(triangles, std::span(totals.first_triangle));
    return totals;
  }

  void emit(const MeshBatch& batch, std::size_t n, const Totals& totals,
            const Array<std::uint32_t>& vertex_rows, const Array<std::uint32_t>& triangle_rows,
            const Array<std::uint32_t>& failure) {
    const std::size_t num_vertices = totals.first_vertex.back(), num_triangles = totals.first_triangle.back();
    if (statistics_.vertices + static_cast<std::int64_t>(num_vertices) >
        std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
      throw WorkError("mesher: more than 2^32 vertices; lower the resolution");
    }
    auto vertices = machine_.template allocate<MeshVertex>(num_vertices);
    auto block_of = machine_.template allocate<std::uint32_t>(num_vertices);
    auto triangles = machine_.template allocate<Triangle>(num_triangles);
    machine_.launch("placing vertices", n * MeshBatch::kRows,
                    PlaceVertices{batch, vertex_rows.data(), static_cast<std::uint32_t>(statistics_.vertices),
                                  vertices.data(), block_of.data()});
    machine_.launch(
        "taking normals", num_vertices,
        TakeNormals{batch, static_cast<float>(0.25 * grid_.samples.step), vertices.data(), block_of.data()});
    machine_.launch("borrowing vertices", n * MeshBlock::kSamples, BorrowVertices{batch});
    machine_.launch("making triangles", n * MeshBatch::kRows,
                    MakeTriangles{batch, triangle_rows.data(), triangles.data()});
    vertices_.resize(num_vertices);
    triangles_.resize(num_triangles);
    machine_.download(vertices, std::span(vertices_));
    machine_.download(triangles, std::span(triangles_));
    require_success(failure);
    pour(totals);
  }

  // Layer by layer, as sinks expect.
  void pour(const Totals& totals) {
    for (std::size_t l = 0; l + 1 < totals.first_vertex.size(); ++l) {
      const std::uint32_t v = totals.first_vertex[l], t = totals.first_triangle[l];
      sink_.add_vertices(std::span<const MeshVertex>(vertices_).subspan(v, totals.first_vertex[l + 1] - v));
      sink_.add_triangles(std::span<const Triangle>(triangles_).subspan(t, totals.first_triangle[l + 1] - t));
    }
  }

  void add_up(std::size_t n, const Totals& totals, const Array<std::uint64_t>& counters) {
    std::array<std::uint64_t, 2> counted;
    machine_.download(counters, std::span<std::uint64_t>(counted));
    statistics_.active_blocks += static_cast<std::int64_t>(n);
    statistics_.vertices += totals.first_vertex.back();
    statistics_.triangles += totals.first_triangle.back();
    statistics_.evaluations +=
        static_cast<std::int64_t>(counted[0]) + 4 * std::int64_t{totals.first_vertex.back()};
    statistics_.cut_vertices += static_cast<std::int64_t>(counted[1]);
    const std::size_t bytes = (n + kept_.blocks.size()) * sizeof(MeshBlock) +
                              vertices_.size() * sizeof(MeshVertex) + triangles_.size() * sizeof(Triangle);
    statistics_.working_bytes = std::max(statistics_.working_bytes, static_cast<std::int64_t>(bytes));
  }

  void require_success(const Array<std::uint32_t>& failure) {
    std::array<std::uint32_t, 1> why;
    machine_.download(failure, std::span<std::uint32_t>(why));
    switch (static_cast<MeshFailure>(why[0])) {
      case MeshFailure::kNone:
        return;
      case MeshFailure::kBorder:
        fail_at_border();
      case MeshFailure::kMissingBlock:
        fail_at_missing_block();
      case MeshFailure::kOpenSide:
        fail_at_open_side();
    }
  }

  template <typename T>
  Array<T> zeros(std::size_t count) {
    Array<T> array = machine_.template allocate<T>(count);
    machine_.fill_zero(array);
    return array;
  }

  Machine& machine_;
  MeshGrid grid_;
  FieldBlock whole_;
  FlatFieldData data_;
  FieldOnMachine<Machine> field_;
  Array<CellTriangles> cells_;
  MeshSink& sink_;
  MeshStatistics statistics_;
  std::deque<Layer> culled_;  // from the first layer that is not meshed yet
  std::size_t most_blocks_ = kMostBlocks;
  Kept kept_;
  std::vector<MeshVertex> vertices_;
  std::vector<Triangle> triangles_;
};

// mesh_field (synthesis/mesher.h) on a machine: the same bytes. Expects a field without
// obstacle_to_flattening().
template <class Machine>
MeshStatistics mesh_field_on(Machine& machine, const ImplicitField& field, const Box& bounds, int resolution,
                             MeshSink& sink, const Progress& progress, MeshTile tile) {
  const SampleGrid grid = make_sample_grid(bounds, resolution);
  return MachineMesher<Machine>(machine, field, {grid, window_of_tile<kBlockCells>(grid, tile), true}, sink)
      .run(progress);
}

// The side of a block of that grid, as obstacle_to_flattening() asks for it.
inline double block_side(const Box& bounds, int resolution) {
  return (kBlockCells + 1) * make_sample_grid(bounds, resolution).step;
}

}  // namespace astrolith
