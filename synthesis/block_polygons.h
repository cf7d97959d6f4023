// Counts, numbers and makes the vertices and triangles of a layer of blocks. Both are numbered by rows of the
// whole grid (z, then y, then x), so their order depends neither on threads nor on the size of blocks.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"
#include "synthesis/block_layer.h"
#include "synthesis/block_sampling.h"
#include "synthesis/marching_cubes_table.h"

namespace astrolith {

// The signs of the cell whose upper corner is local sample x, y, z: bit c set where corner c is inside.
template <int B>
unsigned cell_signs(const LayerBlock<B>& block, int x, int y, int z) {
  unsigned signs = 0;
  for (int c = 0; c < 8; ++c) {
    const bool inside = block.inside(x - 1 + (c & 1), y - 1 + ((c >> 1) & 1), z - 1 + (c >> 2));
    signs |= (inside ? 1u : 0u) << c;
  }
  return signs;
}

// Whether the edge that ends at local sample x, y, z along axis crosses the surface.
template <int B>
bool is_crossed(const LayerBlock<B>& block, int x, int y, int z, int axis) {
  return block.inside(x, y, z) != block.inside(x - (axis == 0), y - (axis == 1), z - (axis == 2));
}

template <int B>
void count_rows(LayerBlock<B>& block) {
  const MarchingCubesTable& table = marching_cubes_table();
  for (int z = 1; z <= B; ++z) {
    for (int y = 1; y <= B; ++y) {
      std::uint32_t vertices = 0, triangles = 0;
      for (int x = 1; x <= B; ++x) {
        const unsigned signs = cell_signs(block, x, y, z);
        if (signs == 0u || signs == 255u) continue;
        triangles += table[signs].count;
        for (int axis = 0; axis < 3; ++axis) vertices += is_crossed(block, x, y, z, axis) ? 1u : 0u;
      }
      block.vertex_rows[LayerBlock<B>::row(y, z)] = vertices;
      block.triangle_rows[LayerBlock<B>::row(y, z)] = triangles;
    }
  }
}

struct LayerCounts {
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
};

// Turns the counts of rows into where each row starts in the layer.
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

// Keeps vertices off the ends of their edges: three edges that meet in a sample of value 0 would otherwise
// give three coincident vertices.
inline constexpr float kEndMargin = 0x1.0p-10f;

// Where F vanishes between two samples, as a fraction of the way from the first; F linear in between.
inline float crossing_fraction(float from, float to) {
  const float t = from / (from - to);
  // Written so that the NaN of infinite values also ends inside the margins.
  return t >= kEndMargin ? (t <= 1.0f - kEndMargin ? t : 1.0f - kEndMargin) : kEndMargin;
}

// The vertex on the edge that ends at local sample x, y, z along axis; its normal is the axis's direction
// out of the body until a better one is known.
template <int B>
MeshVertex place_vertex(const BlockGrid<B>& grid, int layer_z, const LayerBlock<B>& block, int x, int y,
                        int z, int axis) {
  const int gx = block.x * B + x, gy = block.y * B + y, gz = layer_z * B + z;
  const float from = block.values[LayerBlock<B>::sample(x - (axis == 0), y - (axis == 1), z - (axis == 2))];
  const float to = block.values[LayerBlock<B>::sample(x, y, z)];
  const float t = crossing_fraction(from, to);
  const float out = to > 0.0f ? -1.0f : 1.0f;
  MeshVertex vertex{{grid.samples.x(gx), grid.samples.y(gy), grid.samples.z(gz)}, {}};
  if (axis == 0) {
    vertex.position.x = std::lerp(grid.samples.x(gx - 1), vertex.position.x, t);
    vertex.normal.x = out;
  } else if (axis == 1) {
    vertex.position.y = std::lerp(grid.samples.y(gy - 1), vertex.position.y, t);
    vertex.normal.y = out;
  } else {
    vertex.position.z = std::lerp(grid.samples.z(gz - 1), vertex.position.z, t);
    vertex.normal.z = out;
  }
  return vertex;
}

// Replaces normals by the direction in which F falls, from its values at the corners of a small tetrahedron
// (k_i, the alternate corners of a cube of half-side h): grad F = (1/4h) sum_i k_i F(p + h k_i) + O(h^2).
// Returns the number of evaluations; where the sum vanishes the normal stays as it was.
template <FieldBlockLike Block>
std::int64_t take_normals(const Block& field, float h, std::vector<MeshVertex>& vertices) {
  constexpr std::array<Vec3<float>, 4> kCorners = {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
  PointBatch batch;
  for (const Vec3<float>& k : kCorners) {
    for (const MeshVertex& v : vertices) {
      batch.add(v.position.x + h * k.x, v.position.y + h * k.y, v.position.z + h * k.z);
    }
  }
  batch.evaluate(field);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vec3<float> gradient{};
    for (std::size_t k = 0; k < 4; ++k) gradient += kCorners[k] * batch.value[k * vertices.size() + i];
    const float length = norm(gradient);
    if (length > 0.0f && std::isfinite(length)) vertices[i].normal = gradient * (-1.0f / length);
  }
  return static_cast<std::int64_t>(batch.x.size());
}

// Makes a block's vertices, numbers them from layer_first + row start, and puts them into the layer's array.
// Returns the number of evaluations.
template <int B, FieldBlockLike Block>
std::int64_t make_vertices(const BlockGrid<B>& grid, int layer_z, const Block& field,
                           std::uint32_t layer_first, LayerBlock<B>& block,
                           std::span<MeshVertex> layer_vertices) {
  std::vector<MeshVertex> made;
  std::vector<std::uint32_t> slots;
  for (int z = 1; z <= B; ++z) {
    for (int y = 1; y <= B; ++y) {
      std::uint32_t next = block.vertex_rows[LayerBlock<B>::row(y, z)];
      for (int x = 1; x <= B; ++x) {
        for (int axis = 0; axis < 3; ++axis) {
          if (!is_crossed(block, x, y, z, axis)) continue;
          block.vertices[3 * LayerBlock<B>::owned(x, y, z) + static_cast<unsigned>(axis)] =
              layer_first + next;
          made.push_back(place_vertex(grid, layer_z, block, x, y, z, axis));
          slots.push_back(next++);
        }
      }
    }
  }
  // A quarter of a step: near enough for O(h^2), far enough for differences of floats.
  const std::int64_t evaluations = take_normals(field, static_cast<float>(0.25 * grid.samples.step), made);
  for (std::size_t i = 0; i < made.size(); ++i) layer_vertices[slots[i]] = made[i];
  return evaluations;
}

// The number of the vertex on an edge of the cell whose upper corner is local sample x, y, z.
template <int B>
std::uint32_t vertex_number(const Owners<B>& owners, int x, int y, int z, int edge) {
  const CellEdge e = cell_edge(edge);
  const int ex = x - 1 + (e.upper & 1), ey = y - 1 + ((e.upper >> 1) & 1), ez = z - 1 + (e.upper >> 2);
  const LayerBlock<B>* owner = owners[owner_of(ex, ey, ez)];
  if (owner == nullptr) throw WorkError("mesher: an edge of the surface lies in a block that was left out");
  const std::size_t sample = LayerBlock<B>::owned(ex == 0 ? B : ex, ey == 0 ? B : ey, ez == 0 ? B : ez);
  return owner->vertices[3 * sample + static_cast<unsigned>(e.axis)];
}

template <int B>
void make_triangles(const Owners<B>& owners, std::span<Triangle> layer_triangles) {
  const MarchingCubesTable& table = marching_cubes_table();
  const LayerBlock<B>& block = *owners[0];
  for (int z = 1; z <= B; ++z) {
    for (int y = 1; y <= B; ++y) {
      std::size_t next = block.triangle_rows[LayerBlock<B>::row(y, z)];
      for (int x = 1; x <= B; ++x) {
        const CellTriangles& cell = table[cell_signs(block, x, y, z)];
        for (unsigned t = 0; t < cell.count; ++t) {
          Triangle& triangle = layer_triangles[next++];
          for (unsigned k = 0; k < 3; ++k) {
            triangle[k] = vertex_number(owners, x, y, z, cell.edges[3 * t + k]);
          }
        }
      }
    }
  }
}

}  // namespace astrolith
