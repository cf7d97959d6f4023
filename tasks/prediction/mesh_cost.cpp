#include "tasks/prediction/mesh_cost.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>

#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_stream_writer.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/vertical_directions.h"
#include "numerics/files/sha256.h"
#include "numerics/memory_use.h"
#include "numerics/portable_double.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/surface_labels.h"
#include "synthesis/finish/erosion.h"
#include "synthesis/gabor/gabor_bricks.h"
#include "synthesis/mesh/manifold_check.h"
#include "tasks/prediction/mesh_estimate.h"

namespace astrolith {
namespace {

// A plane crosses 1 to sqrt(3) edges of a lattice for each square of its side, on average over all directions
// 1.5. The same holds for boxes of a lattice.
constexpr double kMeanProjection = 1.5;

// Tables of an erosion for each triangle: verticals, areas, heights and edges.
constexpr double kBytesOfSlides = 90.0;

// The bricks of a band that touch a layer of `volume` along the surface, or lie within reach of it.
double bricks_along_surface(const SurfaceBand& band, const MeshEstimate& mesh, double volume,
                            const Vec3d& extent) {
  const double brick = double{band.cell} * kBrickCells;
  const double area = mesh.vertices * mesh.step * mesh.step / kMeanProjection;
  const double whole = volume + kMeanProjection * area * (brick + 2.0 * double{band.reach});
  const auto along = [&](double length) { return (length + 2.0 * double{band.reach}) / brick + 1.0; };
  return std::min(whole / (brick * brick * brick), along(extent.x) * along(extent.y) * along(extent.z));
}

// The layer in which a mesh evaluates impulses. Points of a plain body are projected onto it, so that half a
// block stands for the blocks. A warp and operations leave points where they are, in all active blocks.
double volume_of_blocks(const ImplicitField& field, const MeshEstimate& mesh) {
  const double block = kBlockCells * mesh.step;
  const double area = mesh.vertices * mesh.step * mesh.step / kMeanProjection;
  if (field.has_local_form()) return kMeanProjection * area * 0.5 * block;
  return mesh.blocks * portable::whole_power(block, 3);
}

// The bricks of a band that a mesh draws, from the bricks that its sample has drawn. A block that is looked
// at draws all bricks that reach it, so that a brick which k blocks need has been drawn with the probability
// 1 - exp(-k looked / all). Blocks in which the noise does not count, as under a mask, draw none and count
// alike.
double bricks_of_mesh(const SurfaceBand& band, const ImplicitField& field, const MeshEstimate& mesh,
                      double drawn) {
  const double block = kBlockCells * mesh.step;
  const double wide = 1.0 + (double{band.cell} * kBrickCells + 2.0 * double{band.reach}) / block;
  const double looked = mesh.sampled_windows / std::max(mesh.blocks, mesh.sampled_windows);
  const double found = 1.0 - portable::exp(-wide * wide * looked);
  const double most =
      bricks_along_surface(band, mesh, volume_of_blocks(field, mesh), field.bounds().extent());
  return std::max(std::min(drawn / found, most), drawn);
}

// How often a brick is drawn. Bricks that find no room are drawn anew in each layer of blocks that needs
// them.
double draws_of_brick(const SurfaceBand& band, const MeshEstimate& mesh, double bytes, double height) {
  const double block = kBlockCells * mesh.step;
  const double wide = double{band.cell} * kBrickCells + 2.0 * double{band.reach} + block;
  const double of_two_layers = bytes * std::min((wide + 2.0 * block) / height, 1.0);
  return of_two_layers <= 0.9 * kMostCacheBytes ? 1.0 : std::max(wide / block, 1.0);
}

const SurfaceBand& band_of(const FieldView& field, const ImpulseList& list) {
  const GaborSurfaceNoise& noise = *field.layers[list.layer].noise.get_if<GaborSurfaceNoise>();
  return field.arrays[noise.bands][list.element];
}

// The memory of the cache of one list whose bricks all together take so many bytes.
double kept_bytes(double bytes, int threads) {
  // The memory of heaps over what they hold. Two or more threads have heaps of their own.
  const double gaps = threads > 1 ? 1.25 : 1.1;
  return bytes > kMostCacheBytes ? gaps * kMostCacheBytes : bytes;
}

// Memory of the tree of gravity for each triangle: its facets, nodes and multipoles.
double bytes_of_gravity(double triangles) {
  constexpr double kNode = sizeof(GravityNode) + sizeof(GravityMultipoles);
  constexpr double kFacet = sizeof(std::array<Vec3d, 3>);
  double leaf = std::max(triangles, 1.0);
  while (leaf > double(GravityDetail{}.leaf_facets)) leaf *= 0.5;
  return kFacet + 2.0 * kNode / leaf;
}

// Vertices number first .. first + run - 1 of a mesh, as often as it takes for so many.
std::vector<MeshVertex> repeated(const TriangleMesh& mesh, std::size_t first, std::size_t run,
                                 std::size_t count) {
  std::vector<MeshVertex> vertices(count);
  for (std::size_t i = 0; i < count; ++i)
    vertices[i].position = to_float(mesh.vertices[first + i * run / count]);
  return vertices;
}

// How much more a triangle costs in a mesh of `ratio` times as many, if each doubling adds `more` to it.
double growth(double ratio, double more) {
  return 1.0 + more * double(std::bit_width(static_cast<std::uint64_t>(ratio)) - 1);
}

// Seconds that all threads of this process have spent.
double seconds_of_process() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Memory of the blocks of three layers. A block that the surface does not cross leaves the numbers of its
// vertices untouched, which are the last of its arrays: the system then gives it only the pages before them.
double bytes_of_blocks(const MeshEstimate& mesh) {
  using Block = LayerBlock<kBlockCells>;
  constexpr double kPage = 4096.0, kWhole = sizeof(Block);
  constexpr double kTouched = std::min(kWhole - sizeof(Block::vertices) + kPage, kWhole);
  return mesh.blocks_of_three_layers * (mesh.crossed_share * kWhole + (1.0 - mesh.crossed_share) * kTouched);
}

// What the slides of a mesh of so many cells take.
struct SlideTime {
  double triangles = 0.0, seconds = 0.0;
};
SlideTime slide_time(const ImplicitField& field, const Erosion& erosion, int cells) {
  MeshCollector coarse;
  mesh_field(field, field.bounds(), cells, coarse);
  if (coarse.mesh.triangles.empty()) return {};
  const std::vector<Vec3d> up = vertical_directions(coarse.mesh, {erosion.density, erosion.rotation_period});
  const ProcessorClock clock;
  erode(coarse.mesh, up, erosion.talus_angle, erosion.iterations);
  return {static_cast<double>(coarse.mesh.triangles.size()), clock.seconds()};
}

Recipe ball() {
  Recipe recipe;
  recipe.body = MetaballBody{};
  recipe.body->spheres = {{{0, 0, 0}, 1.0}};
  return recipe;
}

}  // namespace

OutputCost output_cost(const std::filesystem::path& output, const MeshUse& use, double triangles) {
  const std::string extension = is_ply_name(output) ? ".ply" : output.extension().string();
  // Half a vertex and half a normal as doubles, and a triangle; half of one array is copied as it grows.
  const double collected = 36.0 + 6.0;
  // The tables of an erosion are gone before a picture is drawn.
  // Facets and multipoles of the tree of gravity, and eight columns of values at half a vertex.
  const double attracted = use.gravity ? bytes_of_gravity(triangles) + 8.0 * 8.0 : 0.0;
  const double rendered =
      std::max({use.preview ? 120.0 : 0.0, use.erosion ? kBytesOfSlides : 0.0, attracted});
  // Two numbers of four bytes at half a vertex with labels, eight with gravity.
  const double values = use.labels ? 4.0 : use.gravity ? 16.0 : 0.0;
  if (extension == ".ply") return {25.0 + values, rendered > 0.0 ? collected + rendered : 0.0};
  if (extension == ".stl") return {50.0, collected + rendered};
  // Texture coordinates are two numbers of four bytes at half a vertex, and have triangles of their own.
  const double mapped = use.texture_coordinates ? 4.0 : 0.0;
  if (extension == ".glb") return {24.0 + mapped, collected + 24.0 + rendered + 4.0 * mapped};
  return {75.0, collected + rendered};
}

GaborCost gabor_cost(const ImplicitField& field, const MeshEstimate& mesh) {
  const FieldView& view = field.tables();
  const std::span<const ImpulseList> lists = view.arrays.span(view.gabor_lists);
  const std::vector<GaborCacheUse> caches = field.gabor_caches();
  const std::vector<double> brick_seconds = field.gabor_brick_seconds();
  const Vec3d extent = field.bounds().extent();
  GaborCost cost;
  cost.bytes.resize(lists.size());
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const GaborCacheUse& cache = caches[i];
    if (!(cache.drawn > 0.0) || !(mesh.sampled_blocks > 0.0))
      continue;  // too many cells for bricks: impulses are drawn for each point
    const SurfaceBand& band = band_of(view, lists[i]);
    const double bricks = bricks_of_mesh(band, field, mesh, cache.drawn);
    const double bytes = bricks * cache.drawn_bytes / cache.drawn;
    cost.bytes[i] = bytes;
    cost.seconds += brick_seconds[i] * bricks * draws_of_brick(band, mesh, bytes, extent.z);
  }
  return cost;
}

double more_cache_bytes(std::span<const GaborCacheUse> before, std::span<const double> bytes, int threads) {
  double more = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i)
    more += kept_bytes(bytes[i], threads) - before[i].held_bytes;
  return more;
}

ErosionCost erosion_cost(const ImplicitField& field, const Recipe& recipe, const MeshEstimate& mesh) {
  constexpr int kCoarser = 5, kFewestCells = 16, kFewestOfHalf = 10;
  // Gravity is that of a lattice of this many cells; each triangle then adds a little.
  constexpr int kCellsOfGravity = 48;
  constexpr double kSecondsOfVertical = 8e-8;
  // Each doubling of the triangles adds a share: sweeps are more, and tables outgrow the caches.
  constexpr double kMoreOfDoubledSlides = 0.08, kMostOfDoubledSlides = 0.15;
  const Erosion& erosion = *recipe.erosion;
  const int cells = std::min(std::max(mesh.resolution / kCoarser, kFewestCells), mesh.resolution);
  MeshCollector coarse;
  mesh_field(field, field.bounds(), cells, coarse);
  if (coarse.mesh.triangles.empty()) return {};
  const ProcessorClock clock_of_verticals;
  const std::vector<Vec3d> up = vertical_directions(coarse.mesh, {erosion.density, erosion.rotation_period});
  const double triangles = static_cast<double>(coarse.mesh.triangles.size());
  const double seconds_of_verticals = clock_of_verticals.seconds();
  const ProcessorClock clock;
  erode(coarse.mesh, up, erosion.talus_angle, erosion.iterations);
  const double of_slides = clock.seconds();
  const double ratio = std::max(mesh.triangles / triangles, 1.0);
  const SlideTime coarser = slide_time(field, erosion, cells / 2);
  double more = kMoreOfDoubledSlides;
  if (cells / 2 >= kFewestOfHalf && coarser.seconds > 0.0) {
    const double doublings = portable::log(triangles / coarser.triangles) / portable::log(2.0);
    const double slower = of_slides / triangles * coarser.triangles / coarser.seconds;
    more = std::clamp((slower - 1.0) / doublings, kMoreOfDoubledSlides, kMostOfDoubledSlides);
  }
  const double sliding = of_slides * ratio * growth(ratio, more);
  const double finer = std::max(std::min(kCellsOfGravity, mesh.resolution) / double(cells), 1.0);
  // Facets of the lattice, each with its share of the tree of multipoles: 900 to 1,450 bytes. The tree is
  // gone before the tables of the slides are made.
  constexpr double kBytesOfFacet = 1250.0;
  const double of_lattice = std::min(kCellsOfGravity / double(mesh.resolution), 1.0);
  const double bytes =
      std::max(kBytesOfFacet * of_lattice * of_lattice - kBytesOfSlides, 0.0) * mesh.triangles;
  const double verticals = seconds_of_verticals * finer * finer + kSecondsOfVertical * mesh.triangles;
  return {verticals, sliding, bytes};
}

EvenCost even_cost(const MeshEstimate& mesh) {
  // A vertex is evaluated at the corners of a tetrahedron and once or twice more, of which the sample of the
  // mesh knows nothing. On 38 examples that took 0.1 to 0.9 of the seconds of the mesh, mostly 0.2 to 0.5.
  constexpr double kShareOfMesh = 0.5;
  // Half a vertex with its normal, and a triangle; half of one array is copied as it grows.
  constexpr double kRecorded = 24.0 + 6.0;
  // Neighbours and their ranges, places before and after a sweep, and the vertices before and after a pass.
  constexpr double kTables = 50.0;
  return {kShareOfMesh * mesh.seconds, kRecorded * mesh.triangles, kTables * mesh.triangles};
}

double label_seconds(const ImplicitField& field, const Recipe& recipe, const Region& region,
                     const MeshEstimate& mesh) {
  constexpr int kCells = 24;
  constexpr double kShare = 0.01, kMostRuns = 12.0, kMostRunsWithImpulses = 2.0;
  const TriangleMesh coarse = coarse_region(field, recipe, region, std::min(kCells, mesh.resolution));
  if (coarse.vertices.empty() || !(mesh.vertices > 0.0)) return 0.0;
  const SurfaceLabels labels(recipe, field, region.cube());
  const bool has_impulses = !field.gabor_caches().empty();
  // A run of the coarse mesh is as wide as a chunk of the mesh, which has more vertices in each row.
  const double finer = std::max(double(mesh.resolution) / kCells, 1.0);
  const auto run =
      static_cast<std::size_t>(std::clamp(double(kLabelsChunk) / finer, 1.0, double(coarse.vertices.size())));
  const int runs = static_cast<int>(std::clamp(kShare * mesh.vertices / kLabelsChunk, 1.0,
                                               has_impulses ? kMostRunsWithImpulses : kMostRuns));
  std::vector<VertexLabel> made(kLabelsChunk);
  double seconds = 0.0;
  for (int i = 0; i < runs; ++i) {
    const auto first =
        static_cast<std::size_t>(double(coarse.vertices.size() - run) * (i + 0.5) / double(runs));
    const std::vector<MeshVertex> vertices = repeated(coarse, first, run, kLabelsChunk);
    // The first time draws bricks of impulses, which the mesh has drawn when its vertices are labelled.
    if (has_impulses) labels.label(region.center, vertices, made);
    const ProcessorClock clock;
    labels.label(region.center, vertices, made);
    seconds += clock.seconds();
  }
  return seconds * mesh.vertices / (double(runs) * double(kLabelsChunk));
}

double gravity_seconds(const ImplicitField& field, const Recipe& recipe, const MeshEstimate& mesh) {
  constexpr int kMostCells = 24, kFewestCells = 10;
  constexpr double kTolerance = 1e-6;
  const int cells = std::min(std::clamp(mesh.resolution / 8, kFewestCells, kMostCells), mesh.resolution);
  const TriangleMesh coarse = coarse_region(field, recipe, {}, cells);
  if (coarse.vertices.empty()) return 0.0;
  const double start = seconds_of_process();
  const PolyhedronGravity gravity(coarse);
  gravity.at(coarse.vertices, kTolerance);
  // Each doubling of the facets adds this share, as measured on three examples.
  constexpr double kMoreOfDoubling = 0.058;
  const double finer = std::max(mesh.vertices / double(coarse.vertices.size()), 1.0);
  return (seconds_of_process() - start) * finer * growth(finer, kMoreOfDoubling);
}

double meshing_bytes(const MeshEstimate& mesh) {
  constexpr double kNode = sizeof(BlockNode<FieldBlock>) + 96.0;  // and what the allocator adds to its lists
  // Corners: those of two layers, and the sorted ones of the older layer.
  constexpr double kCheckOfTriangle = 36.0, kCheckOfVertex = 32.0;
  const double of_layer = mesh.blocks_of_layer * mesh.triangles_per_block();
  const double of_three = mesh.blocks_of_three_layers * mesh.triangles_per_block();
  return bytes_of_blocks(mesh) + 2.0 * mesh.blocks_of_layer * (mesh.list_bytes + kNode) +
         of_layer * (sizeof(Triangle) + 0.5 * sizeof(MeshVertex)) +
         of_three * (kCheckOfTriangle + 0.5 * kCheckOfVertex);
}

double fresh_memory_seconds(const MeshEstimate& mesh) {
  constexpr std::size_t kTried = 1 << 20, kPage = 4096;
  if (!(mesh.blocks_of_layer * sizeof(LayerBlock<kBlockCells>) >= kReturnedBytes)) return 0.0;
  void* const memory = mmap(nullptr, kTried, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 0.0;
  const ProcessorClock clock;
  for (std::size_t i = 0; i < kTried; i += kPage) static_cast<volatile char*>(memory)[i] = 1;
  const double seconds = clock.seconds();
  munmap(memory, kTried);
  const double bytes = bytes_of_blocks(mesh) * mesh.blocks / mesh.blocks_of_three_layers;
  return seconds / double(kTried) * bytes;
}

double output_seconds_per_triangle() {
  constexpr int kCells = 20;
  MeshCollector collector;
  const ImplicitField field(ball());
  mesh_field(field, field.bounds(), kCells, collector);
  const TriangleMesh& mesh = collector.mesh;
  std::vector<MeshVertex> vertices;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    vertices.push_back({to_float(mesh.vertices[i]), to_float(mesh.normals[i])});
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  // What the first hash takes is taken once, however large the mesh is.
  Sha256 hash;
  hash.update(vertices.data(), sizeof(MeshVertex));
  const ProcessorClock clock;
  ManifoldCheck check;
  check.add_vertices(vertices);
  check.add_triangles(mesh.triangles);
  check.finish();
  if (file) {
    std::fwrite(vertices.data(), sizeof(MeshVertex), vertices.size(), file.get());
    for (const Triangle& triangle : mesh.triangles) std::fwrite(&triangle, 1, sizeof triangle, file.get());
    std::rewind(file.get());
    std::array<char, 1 << 14> bytes;
    while (const std::size_t read = std::fread(bytes.data(), 1, bytes.size(), file.get()))
      hash.update(bytes.data(), read);
  }
  return clock.seconds() / double(mesh.triangles.size());
}

}  // namespace astrolith
