// Meshes one batch of blocks on a backend. Samples, counts, vertices, normals and triangles are each found by
// a launch over all blocks together. The mesh is then copied to the host.
#pragma once

#include "cuda/backend_lists.h"
#include "cuda/mesher/evaluation_steps.h"

namespace astrolith {

// The vertices and triangles of some layers, and where those of each layer begin.
template <class Backend>
struct MeshedLayers {
  typename Backend::template HostArray<MeshVertex> vertices;
  typename Backend::template HostArray<Triangle> triangles;
  std::vector<std::uint32_t> first_vertex, first_triangle;  // (layers + 1)
  std::uint64_t evaluations = 0, cut_vertices = 0;
};

// The last layer of a batch, which the next batch reads.
template <class Backend>
struct KeptLayer {
  typename Backend::template Array<MeshBlock> blocks;  // blocks of the whole batch
  std::size_t first = 0;                               // number of the layer's first block in `blocks`
  std::vector<BlockColumn> columns;
  LayerIndex index;
  int z = 0;

  const MeshBlock* data() const { return blocks.data() + first; }
};

[[noreturn]] inline void fail_as(MeshFailure why) {
  if (why == MeshFailure::kBorder) fail_at_border();
  if (why == MeshFailure::kMissingBlock) fail_at_missing_block();
  fail_at_open_side();
}

template <class Backend>
class BatchMesher {
 public:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  // `failure` is a MeshFailure in the backend's memory. It may already hold a failure.
  BatchMesher(Backend& backend, const MeshBatch& batch, const std::vector<BlockPlace>& places,
              const KeptLayer<Backend>& kept, Array<std::uint32_t>& failure)
      : backend_(backend),
        batch_(batch),
        n_(places.size()),
        places_(places),
        kept_(kept),
        failure_(failure) {}

  // `layer_sizes` are numbers of blocks. The first vertex gets the number `first_number`. Throws what the
  // CPU's mesher throws, and OutOfDeviceMemory.
  void mesh(std::span<const std::size_t> layer_sizes, std::uint32_t first_number,
            MeshedLayers<Backend>& out) {
    auto counters = zeros_on<std::uint64_t>(backend_, 2);  // evaluations, cut vertices
    sample(counters);
    check_sides();
    auto vertex_rows = zeros_on<std::uint32_t>(backend_, n_ * MeshBatch::kRows + 1);
    auto triangle_rows = zeros_on<std::uint32_t>(backend_, n_ * MeshBatch::kRows + 1);
    backend_.launch("counting triangles", n_ * MeshBatch::kRows,
                    CountRows{batch_, vertex_rows.data(), triangle_rows.data(), counters.data() + 1});
    backend_.running_sum(vertex_rows);
    backend_.running_sum(triangle_rows);
    pick_starts(layer_sizes, vertex_rows, triangle_rows, out);
    require_success();
    emit(vertex_rows, triangle_rows, first_number, out);
    std::array<std::uint64_t, 2> counted;
    backend_.download(counters, std::span<std::uint64_t>(counted));
    out.evaluations = counted[0] + 4 * std::uint64_t{out.first_vertex.back()};
    out.cut_vertices = counted[1];
  }

 private:
  void sample(Array<std::uint64_t>& counters) {
    backend_.launch("starting blocks", n_, StartBlocks{batch_, counters.data()});
    batch_.grid.in_patch ? evaluate<Frame::kPatch>() : evaluate<Frame::kBody>();
    backend_.launch("filling the halo of samples", n_ * HaloThread::kSamples, FillSampleHalo{batch_});
    backend_.launch("taking signs", n_ * TakeSigns::kRows, TakeSigns{batch_});
  }

  template <Frame frame>
  void evaluate() {
    const auto band = static_cast<float>(kSampleBand * batch_.grid.samples.step);
    using Evaluate = EvaluateSamples<frame>;
    backend_.launch_groups("evaluating samples", n_, Evaluate::kThreads, Evaluate{batch_, band});
  }

  template <Frame frame>
  void take_normals(const Array<std::uint32_t>& vertex_rows, Array<MeshVertex>& vertices) {
    const auto h = static_cast<float>(0.25 * batch_.grid.samples.step);
    using Take = TakeNormals<frame>;
    backend_.launch_groups("taking normals", n_, Take::kThreads,
                           Take{batch_, h, vertex_rows.data(), vertices.data()});
  }

  // Checks the sides of this batch. The layer before it is checked too, since the layer above it is known
  // now.
  void check_sides() {
    backend_.launch("checking sides", 6 * n_, CheckSides{batch_, batch_.blocks, nullptr, 0});
    if (kept_.columns.empty()) return;
    LayerIndex above(batch_.grid.blocks(0), batch_.grid.blocks(1));
    for (const BlockPlace& p : places_) {
      if (p.z == kept_.z + 1) above.set(p.x, p.y, 0);
    }
    const std::vector<std::uint32_t> lacking = lacking_above(kept_.columns, above);
    const auto array = backend_.upload(std::span<const std::uint32_t>(lacking));
    backend_.launch("checking sides", 6 * lacking.size(),
                    CheckSides{batch_, batch_.below, array.data(), kept_.z});
  }

  void pick_starts(std::span<const std::size_t> layer_sizes, const Array<std::uint32_t>& vertex_rows,
                   const Array<std::uint32_t>& triangle_rows, MeshedLayers<Backend>& out) {
    std::vector<std::uint32_t> rows{0};
    for (const std::size_t size : layer_sizes) {
      rows.push_back(rows.back() + static_cast<std::uint32_t>(MeshBatch::kRows * size));
    }
    const auto row_array = backend_.upload(std::span<const std::uint32_t>(rows));
    auto vertices = backend_.template allocate<std::uint32_t>(rows.size());
    auto triangles = backend_.template allocate<std::uint32_t>(rows.size());
    backend_.launch("finding layers", rows.size(),
                    PickStarts{vertex_rows.data(), triangle_rows.data(), row_array.data(), vertices.data(),
                               triangles.data()});
    out.first_vertex.resize(rows.size());
    out.first_triangle.resize(rows.size());
    backend_.download(vertices, std::span(out.first_vertex));
    backend_.download(triangles, std::span(out.first_triangle));
  }

  void emit(const Array<std::uint32_t>& vertex_rows, const Array<std::uint32_t>& triangle_rows,
            std::uint32_t first_number, MeshedLayers<Backend>& out) {
    const std::size_t num_vertices = out.first_vertex.back(), num_triangles = out.first_triangle.back();
    if (first_number + num_vertices > std::numeric_limits<std::uint32_t>::max()) {
      throw WorkError("mesher: more than 2^32 vertices; lower the resolution");
    }
    auto vertices = backend_.template allocate<MeshVertex>(num_vertices);
    auto triangles = backend_.template allocate<Triangle>(num_triangles);
    backend_.launch("placing vertices", n_ * MeshBatch::kRows,
                    PlaceVertices{batch_, vertex_rows.data(), first_number, vertices.data()});
    batch_.grid.in_patch ? take_normals<Frame::kPatch>(vertex_rows, vertices)
                         : take_normals<Frame::kBody>(vertex_rows, vertices);
    backend_.launch("filling the halo of vertices", n_ * HaloThread::kSamples, FillVertexHalo{batch_});
    backend_.launch("making triangles", n_ * MeshBatch::kRows,
                    MakeTriangles{batch_, triangle_rows.data(), triangles.data()});
    out.vertices.resize(num_vertices);
    out.triangles.resize(num_triangles);
    backend_.download(vertices, std::span<MeshVertex>(out.vertices.data(), num_vertices));
    backend_.download(triangles, std::span<Triangle>(out.triangles.data(), num_triangles));
    require_success();
  }

  void require_success() {
    const auto why = static_cast<MeshFailure>(backend_.read(failure_, 0));
    if (why != MeshFailure::kNone) fail_as(why);
  }

  Backend& backend_;
  MeshBatch batch_;
  std::size_t n_;
  const std::vector<BlockPlace>& places_;
  const KeptLayer<Backend>& kept_;
  const Array<std::uint32_t>& failure_;
};

}  // namespace astrolith
