#include "tests/benchmarks/volume/volume_mesher.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/benchmarks/volume/volume_rows_internal.h"

namespace astrolith {
namespace {

constexpr int kSlabSlices = 4;  // their samples stay in the second-level cache through all steps
constexpr int kGroupRows = 32;  // rows that one thread makes together

void check_volume(const SampleGrid& grid, std::size_t values) {
  const auto& c = grid.cells;
  if (*std::min_element(c.begin(), c.end()) < 2)
    throw InputError("volume: has less than two cells along an axis");
  const auto samples = [&](unsigned axis) { return static_cast<std::size_t>(c[axis]) + 1; };
  if (values != samples(0) * samples(1) * samples(2)) {
    throw InputError("volume: has " + std::to_string(values) + " values, its grid another number of samples");
  }
}

// Makes room for n items in a vector that keeps its memory, and returns its start.
template <typename T>
T* room_for(std::int64_t n, std::vector<T>& items) {
  if (items.size() < static_cast<std::size_t>(n)) items.resize(static_cast<std::size_t>(n));
  return items.data();
}

// The triangles of a group of rows.
struct MadeTriangles {
  std::vector<Triangle> room;
  std::size_t count = 0;
};

// Works slab by slab along z: signs, edges, vertices and triangles, each in parallel over rows. The last
// slice of a slab is kept as the slice below the next slab.
class VolumeMesher {
 public:
  VolumeMesher(const SampleGrid& grid, std::span<const float> values, MeshSink& sink)
      : grid_(grid),
        values_(values.data()),
        sink_(sink),
        samples_(grid.cells[0] + 1),
        rows_(grid.cells[1] + 1),
        words_(words_of(samples_)),
        signs_(row_words(0, kSlabSlices + 1)),
        edges_(signs_.size()),
        row_vertices_(static_cast<std::size_t>(kSlabSlices * rows_)),
        made_triangles_(groups(kSlabSlices)) {}

  VolumeMeshSize run(const Progress& progress) {
    check_outside(0);
    const int last = grid_.cells[2];
    for (int z = 1; z <= last; z += kSlabSlices) {
      make_slab(z, std::min(kSlabSlices, last + 1 - z));
      if (!report(progress, double(z) / last, std::to_string(size_.triangles) + " triangles")) {
        throw WorkError("mesher: stopped before the mesh was complete");
      }
    }
    check_outside(last);
    return size_;
  }

 private:
  std::size_t row_words(int y, int slice) const {
    return static_cast<std::size_t>(slice * rows_ + y) * static_cast<std::size_t>(words_);
  }
  std::size_t groups(int slices) const {
    return static_cast<std::size_t>((slices * rows_ + kGroupRows - 1) / kGroupRows);
  }
  const float* row_values(int y, int z) const {
    return values_ + (static_cast<std::ptrdiff_t>(z) * rows_ + y) * samples_;
  }

  [[noreturn]] static void fail_inside() {
    throw InputError("volume: the body reaches the border of the samples; take more around it");
  }
  void check_outside(int z) const {
    const float* first = row_values(0, z);
    if (std::any_of(first, first + static_cast<std::ptrdiff_t>(rows_) * samples_,
                    [](float v) { return v > 0.0f; })) {
      fail_inside();
    }
  }

  // Makes slices z .. z + slices - 1, which stand in places 1 .. slices. Place 0 holds the slice below them.
  void make_slab(int z, int slices) {
    for_each_row(slices, [&](int y, int slice) { take_row_signs(y, z + slice - 1, slice); });
    for_each_row(slices, [&](int y, int slice) {
      const SignWord* signs = &signs_[row_words(y, slice)];
      row_vertices_[row_index(y, slice)] =
          take_edges(signs, y > 0 ? signs - words_ : signs, &signs_[row_words(y, slice - 1)], words_,
                     &edges_[row_words(y, slice)]);
    });
    number_rows(slices);
    for_each_row(slices, [&](int y, int slice) {
      for (int w = 0; w < words_; ++w) {
        edges_[row_words(y, slice) + static_cast<std::size_t>(w)].first += row_vertices_[row_index(y, slice)];
      }
    });
    emit_vertices(z, slices);
    emit_triangles(slices);
    keep_last(slices, signs_);
    keep_last(slices, edges_);
  }

  // Calls body(y, slice) for every row of the slab, in parallel.
  template <typename Body>
  void for_each_row(int slices, const Body& body) {
    parallel_for(
        0, std::int64_t{slices} * rows_,
        [&](std::int64_t i) { body(static_cast<int>(i % rows_), static_cast<int>(i / rows_) + 1); },
        kGroupRows);
  }

  void take_row_signs(int y, int z, int slice) {
    SignWord* signs = &signs_[row_words(y, slice)];
    take_signs(row_values(y, z), samples_, signs);
    const int end = samples_ - 1;
    const bool at_ends = (signs[0] & 1) != 0 || (signs[end / 64] >> (end % 64) & 1) != 0;
    const bool border_row = y == 0 || y == rows_ - 1;
    if (at_ends || (border_row && std::any_of(signs, signs + words_, [](SignWord w) { return w != 0; }))) {
      fail_inside();
    }
  }

  template <typename Word>
  void keep_last(int slices, std::vector<Word>& words) {
    std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(row_words(0, slices)), row_words(0, 1),
                words.begin());
  }

  std::size_t row_index(int y, int slice) const { return static_cast<std::size_t>((slice - 1) * rows_ + y); }

  // Replaces the number of vertices of each row by the number of its first vertex.
  void number_rows(int slices) {
    slab_first_ = size_.vertices;
    std::int64_t next = slab_first_;
    for (std::size_t i = 0; i < static_cast<std::size_t>(slices * rows_); ++i) {
      const std::uint32_t count = row_vertices_[i];
      row_vertices_[i] = static_cast<std::uint32_t>(next);
      next += count;
    }
    if (next > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
      throw WorkError("mesher: more than 2^32 vertices; lower the resolution");
    }
    size_.vertices = next;
  }

  // Calls body(group, first row, end of rows) for every group of rows, in parallel.
  template <typename Body>
  void for_each_group(int slices, const Body& body) {
    parallel_for(0, static_cast<std::int64_t>(groups(slices)), [&](std::int64_t g) {
      const int first = static_cast<int>(g) * kGroupRows;
      body(static_cast<std::size_t>(g), first, std::min(first + kGroupRows, slices * rows_));
    });
  }

  // Passes on all vertices of a slab in one call. Triangles then name vertices of that call and of the call
  // before.
  void emit_vertices(int z, int slices) {
    const std::int64_t before = slab_first_, count = size_.vertices - before;
    MeshVertex* vertices = room_for(count, vertices_);
    for_each_group(slices, [&](std::size_t, int first, int end) {
      for (int row = first; row < end; ++row) {
        const int y = row % rows_, slice = row / rows_ + 1;
        make_vertices(grid_, values_, &edges_[row_words(y, slice)], y, z + slice - 1,
                      vertices + (row_vertices_[static_cast<std::size_t>(row)] - before));
      }
    });
    sink_.add_vertices({vertices, static_cast<std::size_t>(count)});
  }

  void emit_triangles(int slices) {
    for_each_group(slices, [&](std::size_t g, int first, int end) {
      made_triangles_[g].count = 0;
      std::int64_t most = 0;
      for (int row = first; row < end; ++row) {
        if (row % rows_ > 0) most += count_triangles_at_most(rows_around(row), words_);
      }
      Triangle* triangles = room_for(most, made_triangles_[g].room);
      for (int row = first; row < end; ++row) {
        if (row % rows_ == 0) continue;
        made_triangles_[g].count += static_cast<std::size_t>(
            make_triangles(rows_around(row), words_, triangles + made_triangles_[g].count));
      }
    });
    for (std::size_t g = 0; g < groups(slices); ++g) {
      size_.triangles += static_cast<std::int64_t>(made_triangles_[g].count);
      sink_.add_triangles({made_triangles_[g].room.data(), made_triangles_[g].count});
    }
  }

  // The four rows of samples around the cells whose upper corners are those of `row`, which must not be the
  // first row of its slice.
  std::array<VolumeRow, 4> rows_around(int row) const {
    const int y = row % rows_, slice = row / rows_ + 1;
    const auto at = [&](int b, int c) {
      return VolumeRow{&signs_[row_words(b, c)], &edges_[row_words(b, c)]};
    };
    return {at(y - 1, slice - 1), at(y, slice - 1), at(y - 1, slice), at(y, slice)};
  }

  SampleGrid grid_;
  const float* values_;
  MeshSink& sink_;
  int samples_, rows_, words_;  // samples along x, rows along y, sign words of a row
  VolumeMeshSize size_;
  std::int64_t slab_first_ = 0;  // number of the slab's first vertex
  std::vector<SignWord> signs_;  // (kSlabSlices + 1 x rows x words)
  std::vector<EdgeWord> edges_;  // (kSlabSlices + 1 x rows x words)
  // (kSlabSlices x rows) the number of vertices of a row, later the number of its first vertex.
  std::vector<std::uint32_t> row_vertices_;
  std::vector<MeshVertex> vertices_;  // vertices of the current slab
  std::vector<MadeTriangles> made_triangles_;
};

}  // namespace

VolumeMeshSize mesh_volume(const SampleGrid& grid, std::span<const float> values, MeshSink& sink,
                           const Progress& progress) {
  check_volume(grid, values.size());
  return VolumeMesher(grid, values, sink).run(progress);
}

}  // namespace astrolith
