// LayeredMesher (synthesis/mesh/mesher.h) on a backend, with the same vertices and triangles in the same
// order. The mesher works on some layers of blocks at a time: it culls blocks, gathers their lists, samples
// the field, numbers vertices, makes triangles, and hands them to the sink. A mesh may therefore be larger
// than the backend's memory.
#pragma once

#include <stdexcept>
#include <utility>

#include "cuda/mesher/batch_mesher.h"
#include "cuda/mesher/gathered_lists.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_field.h"

namespace astrolith {

template <class Backend>
class BackendMesher {
 public:
  // `field` are the tables of the grid's frame, for which obstacle_on_gpu() is empty.
  BackendMesher(Backend& backend, const FieldView& field, const MeshGrid& grid, MeshSink& sink)
      : backend_(backend),
        grid_(grid),
        field_(backend, field),
        culler_(backend, field, field_.view(), grid, gabor_margin(field)),
        cells_(backend.upload(std::span<const CellTriangles>(marching_cubes_table()))),
        sink_(sink) {
    statistics_.step = grid.samples.step;
    statistics_.total_blocks = std::int64_t{grid.blocks(0)} * grid.blocks(1) * grid.blocks(2);
  }

  MeshStatistics run(const Progress& progress) {
    const LayerRange range = window_layers(grid_);
    for (int done = range.first; done < range.end;) {
      done += batch_beside_sink(done, range.end);
      if (!report(progress, double(done - range.first) / (range.end - range.first),
                  std::to_string(statistics_.triangles) + " triangles")) {
        throw WorkError("mesher: stopped before the mesh was complete");
      }
    }
    pour(made_);
    return statistics_;
  }

 private:
  template <typename T>
  using Array = typename Backend::template Array<T>;
  static constexpr std::size_t kMostBlocks = 32768;  // the most blocks of a batch: 400 MB

  // Meshes a batch of layers from `first` on, while the sink receives the batch before it. Returns the number
  // of layers.
  int batch_beside_sink(int first, int end) {
    std::swap(made_, before_);
    int layers = 0;
    parallel_for(0, 2, [&](std::int64_t i) {
      if (i == 0) {
        layers = next_batch(first, end);
      } else {
        pour(before_);
      }
    });
    return layers;
  }

  // Meshes a batch of layers from `first` on and returns their number. Where memory ends, it tries half as
  // many.
  int next_batch(int first, int end) {
    for (;;) {
      const int wanted = std::min({layers_at_once_, most_layers(), end - first});
      try {
        const int layers = mesh_layers(first, wanted);
        layers_at_once_ = layers == wanted ? 2 * wanted : layers;
        return layers;
      } catch (const OutOfDeviceMemory&) {
        if (wanted == 1) {
          throw DeviceError("GPU: too little memory for one layer of blocks");
        }
        layers_at_once_ = wanted / 2;
        most_blocks_ = std::max<std::size_t>(most_blocks_ / 2, 1);
      }
    }
  }

  // The most layers that are culled at once. Culling marks every block of its layers, with 256 MB at most.
  int most_layers() const {
    const std::int64_t blocks = std::int64_t{grid_.blocks(0)} * grid_.blocks(1);
    return static_cast<int>(std::max<std::int64_t>(1, (std::int64_t{1} << 26) / blocks));
  }

  // Meshes at most `wanted` layers with at most most_blocks_ blocks, but at least one layer; returns their
  // number. Where it throws OutOfDeviceMemory, the mesher is as before.
  int mesh_layers(int first_z, int wanted) {
    auto failure = zeros_on<std::uint32_t>(backend_, 1);
    const CulledBlocks<Backend> culled = culler_.cull(first_z, wanted, failure);
    if (backend_.read(failure, 0) != 0) fail_at_border();
    const std::vector<std::vector<BlockColumn>> columns = layer_columns(culled.on_host, first_z, wanted);
    KeptLayer<Backend> last{{}, 0, columns.back(), {}, first_z + static_cast<int>(columns.size()) - 1};
    const std::vector<BlockPlace> places = place_blocks(grid_, first_z, columns, kept_.index, last.index);
    last.first = places.size() - columns.back().size();
    const GatheredLists<Backend> lists(backend_, {field_.view(), grid_, culler_.lists(), culled.view()},
                                       places.size());
    const auto place_array = backend_.upload(std::span<const BlockPlace>(places));
    last.blocks = backend_.template allocate<MeshBlock>(places.size());
    const MeshBatch batch{grid_,        field_.view(), lists.view(),  place_array.data(), last.blocks.data(),
                          kept_.data(), cells_.data(), failure.data()};
    std::vector<std::size_t> sizes;
    for (const auto& layer : columns) sizes.push_back(layer.size());
    BatchMesher<Backend>(backend_, batch, places, kept_, failure)
        .mesh(sizes, static_cast<std::uint32_t>(statistics_.vertices), made_);
    add_up(places.size());
    kept_ = std::move(last);
    return static_cast<int>(columns.size());
  }

  // The blocks of each layer, for as many layers as hold most_blocks_ blocks, but at least one.
  std::vector<std::vector<BlockColumn>> layer_columns(const std::vector<CullNode>& blocks, int first_z,
                                                      int layers) const {
    std::vector<std::vector<BlockColumn>> columns(static_cast<std::size_t>(layers));
    for (const CullNode& b : blocks) columns[static_cast<std::size_t>(b.z - first_z)].push_back({b.x, b.y});
    std::size_t kept = 1, sum = columns.front().size();
    while (kept < columns.size() && sum + columns[kept].size() <= most_blocks_) sum += columns[kept++].size();
    columns.resize(kept);
    return columns;
  }

  // Hands the mesh of a batch to the sink, layer by layer.
  void pour(const MeshedLayers<Backend>& made) {
    for (std::size_t l = 0; l + 1 < made.first_vertex.size(); ++l) {
      const std::uint32_t v = made.first_vertex[l], t = made.first_triangle[l];
      sink_.add_batch({made.vertices.data() + v, made.first_vertex[l + 1] - v},
                      {made.triangles.data() + t, made.first_triangle[l + 1] - t});
    }
  }

  void add_up(std::size_t blocks) {
    statistics_.active_blocks += static_cast<std::int64_t>(blocks);
    statistics_.vertices += made_.first_vertex.back();
    statistics_.triangles += made_.first_triangle.back();
    statistics_.evaluations += static_cast<std::int64_t>(made_.evaluations);
    statistics_.cut_vertices += static_cast<std::int64_t>(made_.cut_vertices);
  }

  Backend& backend_;
  MeshGrid grid_;
  FieldOnBackend<Backend> field_;
  BlockCuller<Backend> culler_;
  Array<CellTriangles> cells_;
  MeshSink& sink_;
  MeshStatistics statistics_;
  int layers_at_once_ = 8;
  std::size_t most_blocks_ = kMostBlocks;
  KeptLayer<Backend> kept_;
  MeshedLayers<Backend> made_, before_;  // meshes of the last two batches, whose memory is used again
};

// mesh_field (synthesis/mesh/mesher.h) on a backend, with the same bytes. Expects a field of no patch, for
// which obstacle_on_gpu() is empty.
template <class Backend>
MeshStatistics mesh_field_on(Backend& backend, const ImplicitField& field, const Box& bounds, int resolution,
                             MeshSink& sink, const Progress& progress, MeshTile tile) {
  return BackendMesher<Backend>(backend, field.tables(), field_grid(bounds, resolution, tile), sink)
      .run(progress);
}

// mesh_patch (synthesis/mesh/mesher.h) on a backend, with the same bytes. Expects a field for
// whose patch_tables() obstacle_on_gpu() is empty. Throws std::invalid_argument where these are of another
// patch than the field's place.
template <class Backend>
MeshStatistics mesh_patch_on(Backend& backend, const PatchField& field, double size, int resolution,
                             MeshSink& sink, const Progress& progress) {
  const FieldView& tables = field.whole().patch_tables();
  if (!(tables.patch.origin == field.place().origin))
    throw std::invalid_argument("mesh_patch_on: the field was made for another patch");
  return BackendMesher<Backend>(backend, tables, patch_grid(field.place(), size, resolution), sink)
      .run(progress);
}

}  // namespace astrolith
