// Counts, numbers and makes the vertices and triangles of a layer of blocks. Both are numbered by rows of the
// whole grid (z, then y, then x). Their order therefore depends neither on threads nor on the size of blocks.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/bits.h"
#include "synthesis/mesh/block_layer.h"
#include "synthesis/mesh/block_sampling.h"
#include "synthesis/mesh/marching_cubes_table.h"

namespace astrolith {

// The signs of the samples around a row of cells, whose upper corners are the owned samples of row y, z.
template <int B>
struct CellRow {
  ASTROLITH_HD CellRow(const LayerBlock<B>& block, int y, int z)
      : rows{block.signs[LayerBlock<B>::sign_row(y - 1, z - 1)],
             block.signs[LayerBlock<B>::sign_row(y, z - 1)], block.signs[LayerBlock<B>::sign_row(y - 1, z)],
             block.signs[LayerBlock<B>::sign_row(y, z)]} {}

  // Bit x is set where the surface crosses the cell with upper corner x.
  ASTROLITH_HD SignRow crossed_cells() const {
    const SignRow any = rows[0] | rows[1] | rows[2] | rows[3];
    const SignRow all = rows[0] & rows[1] & rows[2] & rows[3];
    return (any | any << 1) & ~(all & all << 1) & kOwned;
  }
  // Bit x is set where the surface crosses the edge along axis that ends at sample x, y, z.
  ASTROLITH_HD SignRow crossed_edges(int axis) const {
    return (rows[3] ^ (axis == 0 ? rows[3] << 1 : axis == 1 ? rows[2] : rows[1])) & kOwned;
  }
  // The signs of the cell with upper corner x: bit c is set where corner c is inside.
  ASTROLITH_HD unsigned cell_signs(int x) const {
    const auto pair = [&](unsigned r) { return (rows[r] >> (x - 1)) & 3u; };
    return pair(0) | pair(1) << 2 | pair(2) << 4 | pair(3) << 6;
  }

  static constexpr SignRow kOwned = LayerBlock<B>::kWholeRow & ~SignRow{1};
  std::array<SignRow, 4> rows;  // (y - 1, z - 1), (y, z - 1), (y - 1, z), (y, z)
};

// Calls visit(x) for every set bit x, ascending.
template <typename Visit>
ASTROLITH_HD void for_each_bit(SignRow bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(lowest_bit(bits));
}

// Bit x is set where the edge along axis that ends at sample x, y, z holds a vertex of the mesh.
template <int B>
ASTROLITH_HD SignRow meshed_edges(const CellRow<B>& cells, const BlockWindow<B>& window, int y, int z,
                                  int axis) {
  return cells.crossed_edges(axis) & window.edges(y, z, axis);
}

// Counts of a row of owned samples. `cut_vertices` are the vertices in the sides of the window.
struct RowCounts {
  std::uint32_t vertices = 0, triangles = 0, cut_vertices = 0;
};

// Counts what row y, z of a block will hold. `table` is marching_cubes_table().
template <int B>
ASTROLITH_HD RowCounts count_row(const CellTriangles* table, const BlockWindow<B>& window,
                                 const LayerBlock<B>& block, int y, int z) {
  const CellRow<B> cells(block, y, z);
  RowCounts counts;
  for_each_bit(cells.crossed_cells() & window.cells(y, z),
               [&](int x) { counts.triangles += table[cells.cell_signs(x)].count; });
  for (int axis = 0; axis < 3; ++axis) {
    counts.vertices += static_cast<std::uint32_t>(count_bits(meshed_edges(cells, window, y, z, axis)));
    counts.cut_vertices +=
        static_cast<std::uint32_t>(count_bits(cells.crossed_edges(axis) & window.cut_edges(y, z, axis)));
  }
  return counts;
}

// Counts the vertices and triangles of every row of a block. Returns how many of the vertices lie in the
// sides of the window.
template <int B>
std::int64_t count_rows(const BlockWindow<B>& window, LayerBlock<B>& block) {
  std::int64_t cut_vertices = 0;
  if (!is_crossed(block)) {
    block.vertex_rows.fill(0);
    block.triangle_rows.fill(0);
    return 0;
  }
  for (int z = 1; z <= B; ++z) {
    for (int y = 1; y <= B; ++y) {
      const RowCounts counts = count_row(marching_cubes_table().data(), window, block, y, z);
      block.vertex_rows[LayerBlock<B>::row(y, z)] = counts.vertices;
      block.triangle_rows[LayerBlock<B>::row(y, z)] = counts.triangles;
      cut_vertices += counts.cut_vertices;
    }
  }
  return cut_vertices;
}

struct LayerCounts {
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
};

// Replaces the counts of every row by the place in the layer where the row starts. Returns the sums.
template <int B>
LayerCounts number_rows(BlockLayer<B>& layer) {
  LayerCounts counts;
  std::vector<LayerBlock<B>>& blocks = layer.blocks;
  for (int z = 1; z <= B; ++z) {
    for (std::size_t first = 0, end = 0; first < blocks.size(); first = end) {
      while (end < blocks.size() && blocks[end].y == blocks[first].y) ++end;
      for (int y = 1; y <= B; ++y) {
        for (std::size_t i = first; i < end; ++i) {
          std::uint32_t& vertex_row = blocks[i].vertex_rows[LayerBlock<B>::row(y, z)];
          std::uint32_t& triangle_row = blocks[i].triangle_rows[LayerBlock<B>::row(y, z)];
          const std::uint32_t vertices = vertex_row, triangles = triangle_row;
          vertex_row = counts.vertices;
          triangle_row = counts.triangles;
          counts.vertices += vertices;
          counts.triangles += triangles;
        }
      }
    }
  }
  return counts;
}

// Vertices stay at least this fraction of an edge away from its ends. Three edges that meet in a sample of
// value 0 would otherwise give three vertices at one place.
inline constexpr float kEndMargin = 0x1.0p-10f;

// The place between two samples where F vanishes, as a fraction of the way from the first sample. F is taken
// as linear between them.
ASTROLITH_HD inline float crossing_fraction(float from, float to) {
  const float t = from / (from - to);
  // The comparisons are written so that NaN, which infinite values give, also ends inside the margins.
  return t >= kEndMargin ? (t <= 1.0f - kEndMargin ? t : 1.0f - kEndMargin) : kEndMargin;
}

// The vertex at fraction t of the edge along axis that ends at sample x, y, z of the grid. Its normal is the
// direction of the axis out of the body until take_normal finds a better one.
ASTROLITH_HD inline MeshVertex vertex_on_edge(const SampleGrid& grid, int x, int y, int z, int axis, float t,
                                              bool upper_inside) {
  const float out = upper_inside ? -1.0f : 1.0f;
  MeshVertex vertex{{grid.x(x), grid.y(y), grid.z(z)}, {}};
  if (axis == 0) {
    vertex.position.x = std::lerp(grid.x(x - 1), vertex.position.x, t);
    vertex.normal.x = out;
  } else if (axis == 1) {
    vertex.position.y = std::lerp(grid.y(y - 1), vertex.position.y, t);
    vertex.normal.y = out;
  } else {
    vertex.position.z = std::lerp(grid.z(z - 1), vertex.position.z, t);
    vertex.normal.z = out;
  }
  return vertex;
}

// The vertex on the edge along axis that ends at local sample x, y, z of a block.
template <int B>
ASTROLITH_HD MeshVertex place_vertex(const BlockGrid<B>& grid, int layer_z, const LayerBlock<B>& block, int x,
                                     int y, int z, int axis) {
  const float from = block.values[LayerBlock<B>::sample(x - (axis == 0), y - (axis == 1), z - (axis == 2))];
  const float to = block.values[LayerBlock<B>::sample(x, y, z)];
  return vertex_on_edge(grid.samples, block.x * B + x, block.y * B + y, layer_z * B + z, axis,
                        crossing_fraction(from, to), to > 0.0f);
}

// The number of vertices that get their normals together: enough to keep the vector loops of a field busy,
// few enough for the stack.
inline constexpr std::size_t kVerticesPerBatch = 252;

// Vertices that wait for their normals before they go into the array of their layer.
struct VertexBatch {
  std::size_t size = 0;
  std::array<MeshVertex, kVerticesPerBatch> vertices;
  std::array<std::uint32_t, kVerticesPerBatch> slots;  // indices in the array of the layer
  PointBatch<4 * kVerticesPerBatch> points;
};

// A normal is the direction in which F falls. It follows from the values of F at the corners of a small
// tetrahedron (k_i, alternate corners of a cube of half-side h): grad F = (1/4h) sum_i k_i F(p + h k_i) +
// O(h^2). This function gives k_i.
ASTROLITH_HD inline Vec3f tetrahedron_corner(int k) {
  return {k < 2 ? 1.0f : -1.0f, k == 0 || k == 2 ? 1.0f : -1.0f, k == 0 || k == 3 ? 1.0f : -1.0f};
}

// The point p + h k_i at which F is evaluated for corner k.
ASTROLITH_HD inline Vec3f normal_probe(const Vec3f& p, float h, int k) {
  const Vec3f corner = tetrahedron_corner(k);
  return {p.x + h * corner.x, p.y + h * corner.y, p.z + h * corner.z};
}

// Sets the normal from the values of F at the four probes. Where the gradient vanishes or overflows the
// normal stays as it was.
ASTROLITH_HD inline void take_normal(const float* values, MeshVertex& vertex) {
  Vec3f gradient{};
  for (int k = 0; k < 4; ++k) gradient += tetrahedron_corner(k) * values[k];
  const float length = norm(gradient);
  if (length > 0.0f && length <= std::numeric_limits<float>::max()) {
    vertex.normal = gradient * (-1.0f / length);
  }
}

// Sets the normals of all vertices of a batch.
template <FieldBlockLike Block>
void take_normals(const Block& field, float h, VertexBatch& batch) {
  batch.points.clear();
  for (std::size_t i = 0; i < batch.size; ++i) {
    for (int k = 0; k < 4; ++k) {
      const Vec3f p = normal_probe(batch.vertices[i].position, h, k);
      batch.points.add(p.x, p.y, p.z);
    }
  }
  batch.points.evaluate_tetrahedra(field);
  for (std::size_t i = 0; i < batch.size; ++i) {
    std::array<float, 4> values;
    for (std::size_t k = 0; k < 4; ++k) values[k] = batch.points.value(4 * i + k);
    take_normal(values.data(), batch.vertices[i]);
  }
}

// Calls visit(x, y, z, axis) for the meshed edges of row y, z that a block owns, in the order of their
// vertices.
template <int B, typename Visit>
ASTROLITH_HD void for_each_meshed_row_edge(const LayerBlock<B>& block, const BlockWindow<B>& window, int y,
                                           int z, const Visit& visit) {
  const CellRow<B> cells(block, y, z);
  const SignRow edges[] = {meshed_edges(cells, window, y, z, 0), meshed_edges(cells, window, y, z, 1),
                           meshed_edges(cells, window, y, z, 2)};
  for_each_bit(edges[0] | edges[1] | edges[2], [&](int x) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((edges[axis] >> x & 1u) != 0) visit(x, y, z, axis);
    }
  });
}

// Calls visit(x, y, z, axis) for the meshed edges of all rows of a block.
template <int B, typename Visit>
void for_each_meshed_edge(const LayerBlock<B>& block, const BlockWindow<B>& window, const Visit& visit) {
  for (int z = 1; z <= B; ++z) {
    for (int y = 1; y <= B; ++y) for_each_meshed_row_edge(block, window, y, z, visit);
  }
}

// Evaluates F at the ends of the block's crossed edges of which only the sign is known. Returns the number of
// evaluations.
template <int B, FieldBlockLike Block>
std::int64_t evaluate_edge_ends(const BlockGrid<B>& grid, int layer_z, const Block& field,
                                const BlockWindow<B>& window, LayerBlock<B>& block) {
  PointBatch<LayerBlock<B>::kSamples> ends;
  std::array<std::uint32_t, LayerBlock<B>::kSamples> samples;
  const auto add = [&](int x, int y, int z) {
    const std::size_t i = LayerBlock<B>::sample(x, y, z);
    if (!has_only_sign(block.values[i])) return;
    block.values[i] = 0.0f;  // until its value is known: no other edge adds it again
    samples[ends.size()] = static_cast<std::uint32_t>(i);
    ends.add(grid.samples.x(block.x * B + x), grid.samples.y(block.y * B + y),
             grid.samples.z(layer_z * B + z));
  };
  for_each_meshed_edge(block, window, [&](int x, int y, int z, int axis) {
    add(x, y, z);
    add(x - (axis == 0), y - (axis == 1), z - (axis == 2));
  });
  ends.evaluate(field, static_cast<float>(kSampleBand * grid.samples.step));
  for (std::size_t i = 0; i < ends.size(); ++i) block.values[samples[i]] = ends.value(i);
  return static_cast<std::int64_t>(ends.size());
}

// Makes the vertices of a block, numbers them from layer_first + start of their row, and puts them into the
// array of the layer. Returns the number of evaluations of the field.
template <int B, FieldBlockLike Block>
std::int64_t make_vertices(const BlockGrid<B>& grid, int layer_z, const Block& field,
                           std::uint32_t layer_first, LayerBlock<B>& block,
                           std::span<MeshVertex> layer_vertices) {
  if (!is_crossed(block)) return 0;
  // Probes lie a quarter of a step from the vertex: near enough for O(h^2), far enough apart for differences
  // of floats.
  const auto h = static_cast<float>(0.25 * grid.samples.step);
  const BlockWindow<B> window = grid.block_window(block.x, block.y, layer_z);
  std::int64_t evaluations = 0;
  if constexpr (HasSureSigns<Block>) {
    evaluations += evaluate_edge_ends(grid, layer_z, field, window, block);
  }
  VertexBatch batch;
  const auto finish = [&] {
    take_normals(field, h, batch);
    for (std::size_t i = 0; i < batch.size; ++i) layer_vertices[batch.slots[i]] = batch.vertices[i];
    evaluations += static_cast<std::int64_t>(batch.points.size());
    batch.size = 0;
  };
  std::array<std::uint32_t, B* B> next = block.vertex_rows;
  for_each_meshed_edge(block, window, [&](int x, int y, int z, int axis) {
    const std::uint32_t slot = next[LayerBlock<B>::row(y, z)]++;
    block.vertices[3 * LayerBlock<B>::sample(x, y, z) + static_cast<unsigned>(axis)] = layer_first + slot;
    batch.vertices[batch.size] = place_vertex(grid, layer_z, block, x, y, z, axis);
    batch.slots[batch.size++] = slot;
    if (batch.size == kVerticesPerBatch) finish();
  });
  if (batch.size > 0) finish();
  return evaluations;
}

// Copies the numbers of the vertices on edges that end at a halo sample from the owner of the sample. Returns
// false where the surface crosses such an edge and the owner was left out.
template <int B>
ASTROLITH_HD bool fill_halo_vertices(const Owners<B>& owners, const BlockWindow<B>& window, int x, int y,
                                     int z, LayerBlock<B>& block) {
  const LayerBlock<B>* owner = owners[owner_index(x, y, z)];
  for (int axis = 0; axis < 3; ++axis) {
    const int lx = x - (axis == 0), ly = y - (axis == 1), lz = z - (axis == 2);
    if (lx < 0 || ly < 0 || lz < 0) continue;  // no cell of this block has the edge
    if ((window.edges(y, z, axis) >> x & 1u) == 0) continue;
    const SignRow upper = block.signs[LayerBlock<B>::sign_row(y, z)] >> x;
    const SignRow lower = block.signs[LayerBlock<B>::sign_row(ly, lz)] >> lx;
    if (((upper ^ lower) & 1u) == 0) continue;
    if (owner == nullptr) return false;
    block.vertices[3 * LayerBlock<B>::sample(x, y, z) + static_cast<unsigned>(axis)] =
        owner->vertices[3 * owned_sample<B>(x, y, z) + static_cast<unsigned>(axis)];
  }
  return true;
}

[[noreturn]] inline void fail_at_missing_block() {
  throw WorkError("mesher: an edge of the surface lies in a block that was left out");
}

// Fills the vertex numbers on the edges that end at halo samples, by rows. Throws WorkError where an owner
// was left out.
template <int B>
void fill_vertex_halo(const Owners<B>& owners, const BlockWindow<B>& window, LayerBlock<B>& block) {
  if (!is_crossed(block)) return;
  for (int z = 0; z <= B; ++z) {
    for (int y = 0; y <= B; ++y) {
      const SignRow halo = y != 0 && z != 0 ? SignRow{1} : LayerBlock<B>::kWholeRow;
      const SignRow row = block.signs[LayerBlock<B>::sign_row(y, z)];
      SignRow crossed = row ^ row << 1;
      if (y > 0) crossed |= row ^ block.signs[LayerBlock<B>::sign_row(y - 1, z)];
      if (z > 0) crossed |= row ^ block.signs[LayerBlock<B>::sign_row(y, z - 1)];
      for_each_bit(crossed & halo, [&](int x) {
        if (!fill_halo_vertices(owners, window, x, y, z, block)) fail_at_missing_block();
      });
    }
  }
}

// For each of a cell's edges, where its vertex number stands relative to the numbers of the cell's upper
// corner.
template <int B>
constexpr std::array<std::ptrdiff_t, 12> edge_offsets() {
  std::array<std::ptrdiff_t, 12> offsets{};
  for (int edge = 0; edge < 12; ++edge) {
    const CellEdge e = cell_edge(edge);
    const auto sample = LayerBlock<B>::sample(e.upper & 1, (e.upper >> 1) & 1, e.upper >> 2);
    offsets[static_cast<unsigned>(edge)] = 3 * (static_cast<std::ptrdiff_t>(sample) -
                                                static_cast<std::ptrdiff_t>(LayerBlock<B>::sample(1, 1, 1))) +
                                           e.axis;
  }
  return offsets;
}

// Makes the triangles of row y, z of cells and writes them from `triangles` on. `table` is
// marching_cubes_table() and `offsets` is edge_offsets().
template <int B>
ASTROLITH_HD void make_row_triangles(const CellTriangles* table,
                                     const std::array<std::ptrdiff_t, 12>& offsets,
                                     const LayerBlock<B>& block, const BlockWindow<B>& window, int y, int z,
                                     Triangle* triangles) {
  const CellRow<B> cells(block, y, z);
  for_each_bit(cells.crossed_cells() & window.cells(y, z), [&](int x) {
    const CellTriangles& cell = table[cells.cell_signs(x)];
    const std::uint32_t* numbers = block.vertices.data() + 3 * LayerBlock<B>::sample(x, y, z);
    for (unsigned t = 0; t < cell.count; ++t) {
      Triangle& triangle = *triangles++;
      for (unsigned k = 0; k < 3; ++k) triangle[k] = numbers[offsets[cell.edges[3 * t + k]]];
    }
  });
}

template <int B>
void make_triangles(const LayerBlock<B>& block, const BlockWindow<B>& window,
                    std::span<Triangle> layer_triangles) {
  if (!is_crossed(block)) return;
  static constexpr std::array<std::ptrdiff_t, 12> kOffsets = edge_offsets<B>();
  for (int z = 1; z <= B; ++z) {
    for (int y = 1; y <= B; ++y) {
      make_row_triangles(marching_cubes_table().data(), kOffsets, block, window, y, z,
                         layer_triangles.data() + block.triangle_rows[LayerBlock<B>::row(y, z)]);
    }
  }
}

}  // namespace astrolith
