// SPICE shape kernels of type 2: plates (NAIF, DAS, DLA and DSK Required Reading). A DAS file holds numbers
// of three kinds in records of 1,024 bytes, which directories list as clusters. All segments of a file are
// read, in kilometres of their frame.
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "geometry/io/byte_reader_internal.h"
#include "geometry/io/format_internal.h"

namespace astrolith {
namespace {

constexpr std::size_t kRecord = 1024;
constexpr const char* kFetch = "fetch the file again, or export its plates by dskexp (NAIF)";

// The doubles and the integers of a DAS file by their addresses, which count from 1.
class DasFile {
 public:
  explicit DasFile(const MeshFile& file) : file_(file) {
    constexpr std::size_t kReserved = 68, kFormat = 84;  // counts of records, and the byte order's name
    if (file.bytes.size() < kRecord) file.fail("byte 0", "ends within its first record", kFetch);
    const std::string_view format = std::string_view(file.bytes).substr(kFormat, 8);
    if (format == "BIG-IEEE")
      order_ = std::endian::big;
    else if (format != "LTL-IEEE")
      file.fail("byte 84", "the numbers are stored as " + quoted(format), "convert it by bingo (NAIF)");
    ByteReader header = at_byte(kReserved);
    std::int64_t before = 1;
    for (int count = 0; count < 4; count += 2) {  // records and characters: reserved ones, then the comment's
      before += header.read<std::int32_t>("a count");
      header.skip(sizeof(std::int32_t), "a count");
    }
    find_clusters(before);
  }

  double number(std::int64_t address) const { return value<double>(doubles_, address); }
  std::int32_t integer(std::int64_t address) const { return value<std::int32_t>(integers_, address); }

 private:
  struct Cluster {
    std::int64_t record, records;
  };

  ByteReader at_byte(std::size_t byte) const {
    return ByteReader(file_, std::min(byte, file_.bytes.size()), order_);
  }

  // A directory names its successor, the addresses of its three kinds, the kind of its first cluster, and how
  // long the clusters are: a positive length is of the next kind in turn, a negative one of the one before.
  void find_clusters(std::int64_t directory) {
    constexpr int kWords = 256, kFirstKind = 8;
    const auto records = static_cast<std::int64_t>(file_.bytes.size() / kRecord);
    std::int64_t left = records;  // directories that point in a circle end
    while (directory > 0 && left-- > 0) {
      if (doubles_.size() + integers_.size() > static_cast<std::size_t>(records))
        file_.fail("", "its directories point in a circle", kFetch);
      if (directory >= records) file_.fail("", "a directory lies beyond the file", kFetch);
      ByteReader words = at_byte(static_cast<std::size_t>(directory) * kRecord);
      words.skip(sizeof(std::int32_t), "a directory");
      const std::int64_t next = words.read<std::int32_t>("a directory");
      words.skip(6 * sizeof(std::int32_t), "a directory");
      int kind = words.read<std::int32_t>("a directory");
      if (kind < 1 || kind > 3) file_.fail("a directory", "names a kind of numbers that is none", kFetch);
      std::int64_t record = directory + 1;
      for (int k = kFirstKind + 1; k < kWords; ++k) {
        const std::int64_t length = words.read<std::int32_t>("a directory");
        if (length == 0) break;
        if (k > kFirstKind + 1) kind = length > 0 ? kind % 3 + 1 : (kind + 1) % 3 + 1;
        const Cluster cluster{record, length > 0 ? length : -length};
        if (kind == 2) doubles_.push_back(cluster);
        if (kind == 3) integers_.push_back(cluster);
        record += cluster.records;
      }
      directory = next - 1;
    }
  }

  template <typename T>
  T value(const std::vector<Cluster>& clusters, std::int64_t address) const {
    constexpr auto kEach = static_cast<std::int64_t>(kRecord / sizeof(T));
    std::int64_t left = address - 1;
    for (const Cluster& cluster : clusters) {
      if (left >= 0 && left < cluster.records * kEach)
        return at_byte(static_cast<std::size_t>(cluster.record) * kRecord +
                       static_cast<std::size_t>(left) * sizeof(T))
            .template read<T>("a number");
      left -= cluster.records * kEach;
    }
    file_.fail("address " + std::to_string(address), "lies beyond the file", kFetch);
  }

  const MeshFile& file_;
  std::endian order_ = std::endian::little;
  std::vector<Cluster> doubles_, integers_;
};

// Where a segment lies: its descriptor's eight integers.
struct Segment {
  std::int64_t next, integers, doubles;
};

void add_plates(const MeshFile& file, const DasFile& das, const Segment& segment, TriangleMesh& mesh) {
  // Offsets of a segment of type 2 (dsk02.inc), less 1.
  constexpr std::int64_t kType = 3, kVertices = 34, kPlates = 10;
  if (das.number(segment.doubles + 1 + kType) != 2.0)
    file.fail("a segment", "is none of type 2, plates", "export it as a mesh");
  const std::int64_t vertices = das.integer(segment.integers + 1), plates = das.integer(segment.integers + 2);
  const auto most = static_cast<std::int64_t>(file.bytes.size() / (3 * sizeof(std::int32_t)));
  if (vertices < 3 || plates < 1 || vertices > most || plates > most)
    file.fail("a segment", "its counts of vertices and plates cannot be right", kFetch);
  const auto base = static_cast<std::int64_t>(mesh.vertices.size());
  if (static_cast<std::int64_t>(mesh.triangles.size()) + plates > most || base + vertices > most)
    file.fail("", "its segments lie over each other", kFetch);
  for (std::int64_t v = 0; v < vertices; ++v) {
    const std::int64_t at = segment.doubles + 1 + kVertices + 3 * v;
    mesh.vertices.push_back({das.number(at), das.number(at + 1), das.number(at + 2)});
  }
  for (std::int64_t p = 0; p < plates; ++p) {
    Triangle& t = mesh.triangles.emplace_back();
    for (std::int64_t k = 0; k < 3; ++k) {
      const std::int64_t corner = das.integer(segment.integers + 1 + kPlates + 3 * p + k);
      if (corner < 1 || corner > vertices) file.fail("a plate", "names a vertex that is not there", kFetch);
      t[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(base + corner - 1);
    }
  }
}

}  // namespace

bool is_dsk(const MeshFile& file) {
  return file.bytes.starts_with("DAS/DSK") || file.bytes.starts_with("NAIF/DSK");
}

TriangleMesh read_dsk(const MeshFile& file) {
  const DasFile das(file);
  TriangleMesh mesh;
  std::int64_t at = das.integer(2);  // of the first descriptor; the list's version stands before it
  // A segment takes more than a record, so that descriptors which point in a circle end.
  for (std::size_t left = file.bytes.size() / kRecord; at > 0 && left > 0; --left) {
    const Segment segment{das.integer(at + 1), das.integer(at + 2), das.integer(at + 4)};
    add_plates(file, das, segment, mesh);
    at = segment.next;
  }
  return mesh;
}

}  // namespace astrolith
