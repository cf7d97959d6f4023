#include "geometry/io/mesh_format_internal.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>

#include "geometry/io/mesh_io.h"
#include "geometry/io/mesh_writers_internal.h"
#include "geometry/io/stated_unit.h"
#include "geometry/io/text_scanner_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

struct Signature {
  std::string_view start;
  const char* name;
};

// Files of other kinds that users hand over by mistake.
constexpr Signature kOtherFiles[] = {
    {"\x89PNG", "a PNG picture"},
    {"\xff\xd8\xff", "a JPEG picture"},
    {"glTF", "a glTF file"},
    {"PK\x03\x04", "a zip archive"},
    {"\x1f\x8b", "a gzip archive"},
    {"BZh", "a bzip2 archive"},
    {"\xfd\x37zXZ", "an xz archive"},
    {"II*", "a TIFF picture"},
    {"%PDF", "a PDF"},
    {"<", "HTML or XML"},
    {"{", "JSON"},
    {"NAIF/DSK", "a SPICE DSK"},
    {"DAS/", "a SPICE DAS"},
    {"version https://git-lfs", "a Git LFS pointer"},
};

// A binary STL has 80 bytes, a count and 50 bytes for each triangle. Files of other formats do not have
// exactly this size.
bool is_binary_stl(const MeshFile& file) {
  const std::string_view bytes = file.bytes;
  if (bytes.size() < 84) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return bytes.size() == 84 + std::uint64_t{50} * count;
}

// The number of numbers on the next filled line; 0 when the line holds anything else.
int count_numbers(TextScanner& scan) {
  if (!scan.next_filled_line()) return 0;
  int count = 0;
  while (!scan.line_done()) {
    if (!parse_number(scan.word())) return 0;
    ++count;
  }
  return count;
}

bool is_ply(const MeshFile& file) {
  return file.bytes.starts_with("ply\n") || file.bytes.starts_with("ply\r");
}
bool is_ascii_stl(const MeshFile& file) { return file.bytes.starts_with("solid"); }

// How many numbers stand on the first two filled lines. An ICQ states Q and goes on with "x y z". A plate
// model states its count (or both counts) and goes on with "i x y z", after both counts perhaps with "x y z".
struct TableStart {
  int first, second;
};
TableStart table_start(const MeshFile& file) {
  TextScanner scan(file);
  const int first = count_numbers(scan);
  return {first, count_numbers(scan)};
}
bool is_icq(const MeshFile& file) {
  const auto [first, second] = table_start(file);
  return first == 1 && second == 3;
}
bool is_plate(const MeshFile& file) {
  const auto [first, second] = table_start(file);
  return ((first == 1 || first == 2) && second == 4) || (first == 2 && second == 3);
}

std::string_view first_word(TextScanner& scan) { return scan.next_filled_line() ? scan.word() : ""; }
bool is_obj(const MeshFile& file) {
  static constexpr std::string_view kWords[] = {"v", "vn", "vt",     "vp",     "f",
                                                "o", "g",  "mtllib", "usemtl", "s"};
  TextScanner scan(file);
  return std::find(std::begin(kWords), std::end(kWords), first_word(scan)) != std::end(kWords);
}
bool is_off(const MeshFile& file) {
  static constexpr std::string_view kStarts[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "NCOFF"};
  TextScanner scan(file);
  const std::string_view word = first_word(scan);
  return std::any_of(std::begin(kStarts), std::end(kStarts),
                     [&](std::string_view start) { return word.starts_with(start); });
}
bool never(const MeshFile&) { return false; }  // known by its name alone

struct MeshFormat {
  const char* name;
  std::array<std::string_view, 4> extensions;  // that may stand for it, its own first
  MeshReader reader;                           // null: meshes are only written so
  MeshWriter writer;                           // null: meshes are only read so
  bool (*has)(const MeshFile&);                // whether the content tells the format
  bool tells_unit;                             // whether what is written states its unit, or has a fixed one
};

// In the order in which contents are looked at; of the formats of an extension the likeliest comes first.
constexpr MeshFormat kFormats[] = {
    {"PLY", {".ply"}, read_ply, write_ply, is_ply, true},
    {"binary STL", {".stl"}, read_stl_binary, write_stl, is_binary_stl, true},
    {"ascii STL", {".stl"}, read_stl_ascii, nullptr, is_ascii_stl, false},
    {"PDS plate model", {".tab", ".plt", ".txt"}, read_plate, write_plate, is_plate, false},
    {"Gaskell ICQ", {".icq", ".tab", ".plt", ".txt"}, read_icq, write_icq, is_icq, false},
    {"Wavefront OBJ", {".obj", ".tab", ".plt", ".txt"}, read_obj, write_obj, is_obj, true},
    {"OFF", {".off"}, read_off, nullptr, is_off, false},
    {"BMF", {".bmf"}, read_bmf, nullptr, never, false},
    {"glTF", {".glb"}, nullptr, write_glb, never, true},
};

bool may_end_in(const MeshFormat& format, const std::string& extension) {
  return !extension.empty() &&
         std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end();
}

// The extensions of formats with a member, such as ".ply .stl .tab".
template <class Member>
std::string extensions_with(Member MeshFormat::*member) {
  std::string words;
  for (const MeshFormat& format : kFormats) {
    const std::string extension(format.extensions[0]);
    if (format.*member == nullptr || words.find(extension) != std::string::npos) continue;
    words += (words.empty() ? "" : " ") + extension;
  }
  return words;
}

std::string remedy() { return "give a mesh (" + extensions_with(&MeshFormat::reader) + ")"; }

[[noreturn]] void fail_unknown(const MeshFile& file) {
  for (const Signature& other : kOtherFiles) {
    if (file.bytes.starts_with(other.start)) {
      file.fail("byte 0", std::string("the content is ") + other.name, remedy());
    }
  }
  file.fail("byte 0", "neither name nor content tells a mesh format", remedy());
}

bool is_other_file(const MeshFile& file) {
  return std::any_of(std::begin(kOtherFiles), std::end(kOtherFiles),
                     [&](const Signature& other) { return file.bytes.starts_with(other.start); });
}

// The format in which meshes are written for an extension; null where none is.
const MeshFormat* written_format(const std::string& extension) {
  for (const MeshFormat& format : kFormats) {
    if (format.writer != nullptr && format.extensions[0] == extension) return &format;
  }
  return nullptr;
}

}  // namespace

MeshReader reader_for(const MeshFile& file) {
  const std::string extension = mesh_extension(file.path);
  const auto named = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const MeshFormat& f) {
    return f.reader != nullptr && may_end_in(f, extension);
  });
  const auto seen = std::find_if(std::begin(kFormats), std::end(kFormats),
                                 [&](const MeshFormat& f) { return f.has(file); });
  const bool is_named = named != std::end(kFormats);
  if (seen == std::end(kFormats)) {
    if (!is_named || is_other_file(file)) fail_unknown(file);
    return named->reader;
  }
  if (is_named && !may_end_in(*seen, extension)) {
    file.fail("byte 0", "the name ends in " + extension + " but the content looks like " + seen->name,
              "rename it to " + std::string(seen->extensions[0]));
  }
  return seen->reader;
}

MeshWriter writer_for(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  if (file.extension() == ".zst" && extension != ".ply") {
    throw InputError(file.string() + ": meshes are compressed as .ply.zst only; choose that name");
  }
  if (const MeshFormat* format = written_format(extension)) return format->writer;
  throw InputError(file.string() + ": meshes are written as " + extensions_with(&MeshFormat::writer) +
                   "; choose one of these");
}

bool tells_length_unit(const std::filesystem::path& file) {
  const MeshFormat* format = written_format(mesh_extension(file));
  return format != nullptr && format->tells_unit;
}

bool has_mesh_extension(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  return extension != ".txt" &&
         std::any_of(std::begin(kFormats), std::end(kFormats),
                     [&](const MeshFormat& f) { return f.reader != nullptr && may_end_in(f, extension); });
}

}  // namespace astrolith
