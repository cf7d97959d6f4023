#include "geometry/io/ply_stream_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/io/format_internal.h"
#include "geometry/io/ply_header_internal.h"
#include "numerics/files/input_file.h"

namespace astrolith {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in the file");

constexpr std::uint64_t kTrianglesInBlock = 1 << 14;
constexpr std::size_t kLongestHeader = 1 << 16;  // bytes

bool starts_with_floats_xyz(const PlyElement& element) {
  static constexpr std::string_view kNames[] = {"x", "y", "z"};
  if (element.name != "vertex" || element.properties.size() < 3) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (element.properties[k].name != kNames[k] || element.properties[k].type != PlyType::float32)
      return false;
  }
  return std::none_of(element.properties.begin(), element.properties.end(),
                      [](const PlyProperty& p) { return p.is_list; });
}

bool has_one_vertex_list(const PlyElement& element) {
  return element.name == "face" && element.properties.size() == 1 && element.properties[0].is_list &&
         element.properties[0].count_type == PlyType::uint8 && element.properties[0].type == PlyType::uint32;
}

}  // namespace

PlyStreamReader::PlyStreamReader(const std::filesystem::path& file) : path_(file) {
  require_plain_file(file);
  file_.reset(std::fopen(file.c_str(), "rb"));
  if (!file_) throw InputError(file.string() + ": cannot be read; check its permissions");
  read_header();
}

void PlyStreamReader::fail(const std::string& what) const {
  throw InputError(path_.string() + ": " + what + "; give a .ply that synth has written");
}

void PlyStreamReader::read_header() {
  const std::uint64_t size = std::filesystem::file_size(path_);
  MeshFile start{path_, std::string(std::min<std::uint64_t>(size, kLongestHeader), '\0')};
  fill(start.bytes.data(), start.bytes.size());
  TextScanner scan(start);
  const PlyHeader header = read_ply_header(scan);
  if (header.ascii || header.order != std::endian::little || header.elements.size() != 2 ||
      !starts_with_floats_xyz(header.elements[0]) || !has_one_vertex_list(header.elements[1])) {
    fail("has another layout than synth's binary PLY");
  }
  num_vertices_ = header.elements[0].count;
  num_triangles_ = header.elements[1].count;
  vertex_bytes_ = header.elements[0].least_row_bytes();
  vertices_at_ = start.bytes.size() - scan.bytes_left();
  const bool too_many = num_vertices_ > static_cast<std::uint64_t>(kMaxVertices) || num_triangles_ > size;
  triangles_at_ = vertices_at_ + num_vertices_ * vertex_bytes_;
  if (too_many || triangles_at_ + num_triangles_ * kPlyTriangleBytes != size) {
    fail("its size does not agree with the counts in its header");
  }
}

void PlyStreamReader::go_to(std::uint64_t offset) {
  if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) fail("cannot be read");
}

void PlyStreamReader::fill(void* data, std::size_t bytes) {
  if (std::fread(data, 1, bytes, file_.get()) != bytes) fail("ends early or cannot be read");
}

const std::vector<Triangle>& PlyStreamReader::read_triangles(std::uint64_t block) {
  const std::uint64_t first = block * kTrianglesInBlock;
  triangles_.resize(std::min(kTrianglesInBlock, num_triangles_ - first));
  bytes_.resize(triangles_.size() * kPlyTriangleBytes);
  go_to(triangles_at_ + first * kPlyTriangleBytes);
  fill(bytes_.data(), bytes_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const char* row = bytes_.data() + i * kPlyTriangleBytes;
    std::memcpy(triangles_[i].data(), row + 1, sizeof(Triangle));
    if (row[0] != 3 || *std::max_element(triangles_[i].begin(), triangles_[i].end()) >= num_vertices_) {
      fail("face " + std::to_string(first + i) + " is no triangle of the file's vertices");
    }
  }
  return triangles_;
}

std::vector<PlyStreamReader::BlockRange> PlyStreamReader::block_ranges() {
  std::vector<BlockRange> ranges((num_triangles_ + kTrianglesInBlock - 1) / kTrianglesInBlock,
                                 {std::numeric_limits<std::uint32_t>::max(), 0});
  for (std::size_t block = 0; block < ranges.size(); ++block) {
    for (const Triangle& triangle : read_triangles(block)) {
      const auto [lowest, highest] = std::minmax({triangle[0], triangle[1], triangle[2]});
      ranges[block].lowest = std::min(ranges[block].lowest, lowest);
      ranges[block].highest = std::max(ranges[block].highest, highest);
    }
  }
  return ranges;
}

void PlyStreamReader::pass_vertices(std::uint64_t end, MeshSink& sink) {
  bytes_.resize((end - passed_) * vertex_bytes_);
  go_to(vertices_at_ + passed_ * vertex_bytes_);
  fill(bytes_.data(), bytes_.size());
  std::vector<MeshVertex> vertices(end - passed_);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vec3f& p = vertices[i].position;
    std::memcpy(&p, bytes_.data() + i * vertex_bytes_, sizeof p);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      fail("vertex " + std::to_string(passed_ + i) + " is not finite");
    }
  }
  sink.add_vertices(vertices);
  passed_ = end;
}

void PlyStreamReader::read(MeshSink& sink) {
  const std::vector<BlockRange> ranges = block_ranges();
  std::vector<std::uint32_t> lowest_from(ranges.size() + 1, std::numeric_limits<std::uint32_t>::max());
  for (std::size_t i = ranges.size(); i > 0; --i) {
    lowest_from[i - 1] = std::min(lowest_from[i], ranges[i - 1].lowest);
  }
  passed_ = 0;
  for (std::size_t first = 0, end = 0; first < ranges.size(); first = end) {
    // Up to the last block that names a vertex of an earlier call. Later calls then need the last two only.
    std::uint64_t needed = passed_;
    do {
      needed = std::max(needed, std::uint64_t{ranges[end++].highest} + 1);
    } while (end < ranges.size() && lowest_from[end] < passed_);
    if (needed > passed_) pass_vertices(needed, sink);
    for (std::size_t block = first; block < end; ++block) sink.add_triangles(read_triangles(block));
  }
  constexpr std::uint64_t kBatch = 1 << 14;
  while (passed_ < num_vertices_) pass_vertices(std::min(passed_ + kBatch, num_vertices_), sink);
}

}  // namespace astrolith
