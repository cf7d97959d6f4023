#include "geometry/io/mesh_format.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/io/format_internal.h"
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

// In the order in which contents are looked at; of the formats of an extension the likeliest comes first.
constexpr MeshFormat kFormats[] = {
    {.name = "PLY",
     .extensions = {".ply"},
     .has = is_ply,
     .reader = read_ply,
     .writer = write_ply,
     .words = "binary, streamed; .ply.zst is compressed",
     .tells_unit = true,
     .has_colors = true,
     .has_values = true,
     .streamed = true,
     .file_bytes = 25.0},
    {.name = "binary STL",
     .extensions = {".stl"},
     .has = is_binary_stl,
     .reader = read_stl_binary,
     .writer = write_stl,
     .tells_unit = true,
     .file_bytes = 50.0},
    {.name = "ascii STL", .extensions = {".stl"}, .has = is_ascii_stl, .reader = read_stl_ascii},
    {.name = "PDS plate model",
     .extensions = {".tab", ".plt", ".txt"},
     .has = is_plate,
     .reader = read_plate,
     .writer = write_plate,
     .words = "PDS plates"},
    {.name = "Gaskell ICQ",
     .extensions = {".icq", ".tab", ".plt", ".txt"},
     .has = is_icq,
     .reader = read_icq,
     .writer = write_icq,
     .counts = icq_counts},
    {.name = "Wavefront OBJ",
     .extensions = {".obj", ".tab", ".plt", ".txt"},
     .has = is_obj,
     .reader = read_obj,
     .writer = write_obj,
     .tells_unit = true},
    {.name = "OFF", .extensions = {".off"}, .has = is_off, .reader = read_off},
    {.name = "BMF", .extensions = {".bmf"}, .has = never, .reader = read_bmf},
    {.name = "glTF",
     .extensions = {".glb"},
     .has = never,
     .writer = write_glb,
     .tells_unit = true,
     .has_colors = true,
     .has_texture_coordinates = true,
     .file_bytes = 24.0,
     .kept_bytes = 24.0},
};

bool may_end_in(const MeshFormat& format, const std::string& extension) {
  return !extension.empty() &&
         std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end();
}

// The extensions of formats with a member, each with its words, such as ".ply, .stl or .tab".
template <class Member>
std::string extensions_with(Member MeshFormat::*member, bool with_words) {
  std::vector<std::string> all;
  for (const MeshFormat& format : kFormats) {
    const std::string extension(format.extensions[0]), words = format.words;
    const bool known =
        std::any_of(all.begin(), all.end(), [&](const auto& e) { return e.starts_with(extension); });
    if (!(format.*member) || known) continue;
    all.push_back(extension + (with_words && !words.empty() ? " (" + words + ")" : ""));
  }
  std::string list = all.front();
  for (std::size_t k = 1; k < all.size(); ++k) list += (k + 1 < all.size() ? ", " : " or ") + all[k];
  return list;
}

std::string remedy() { return "give a mesh (" + read_mesh_words() + ")"; }

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

}  // namespace

TriangleMesh read_content(const MeshFile& file) {
  const std::string extension = mesh_extension(file.path);
  const auto named = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const MeshFormat& f) {
    return f.reader != nullptr && may_end_in(f, extension);
  });
  const auto seen = std::find_if(std::begin(kFormats), std::end(kFormats),
                                 [&](const MeshFormat& f) { return f.has(file); });
  const bool is_named = named != std::end(kFormats);
  if (seen == std::end(kFormats)) {
    if (!is_named || is_other_file(file)) fail_unknown(file);
    return named->reader(file);
  }
  if (is_named && !may_end_in(*seen, extension)) {
    file.fail("byte 0", "the name ends in " + extension + " but the content looks like " + seen->name,
              "rename it to " + std::string(seen->extensions[0]));
  }
  return seen->reader(file);
}

std::span<const MeshFormat> mesh_formats() { return kFormats; }

const MeshFormat& written_mesh_format(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  const bool packed = file.extension() == ".zst";
  for (const MeshFormat& format : kFormats) {
    if (format.writer == nullptr || format.extensions[0] != extension) continue;
    if (!packed || format.streamed) return format;
  }
  if (packed) throw InputError(file.string() + ": meshes are compressed as .ply.zst only; choose that name");
  throw InputError(file.string() + ": meshes are written as " + extensions_with(&MeshFormat::writer, false) +
                   "; choose one of these");
}

void require_mesh_format(const std::filesystem::path& file, bool MeshFormat::*asked) {
  if (written_mesh_format(file).*asked) return;
  throw InputError(file.string() + ": is no " + extensions_with(asked, false) +
                   " file; name it with that extension");
}

std::string read_mesh_words() { return extensions_with(&MeshFormat::reader, false); }

std::string written_mesh_words() { return extensions_with(&MeshFormat::writer, true); }

bool has_mesh_extension(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  return extension != ".txt" && std::any_of(std::begin(kFormats), std::end(kFormats),
                                            [&](const MeshFormat& f) { return may_end_in(f, extension); });
}

bool has_readable_extension(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  return extension != ".txt" &&
         std::any_of(std::begin(kFormats), std::end(kFormats),
                     [&](const MeshFormat& f) { return f.reader != nullptr && may_end_in(f, extension); });
}

std::string mesh_extension(const std::filesystem::path& file) {
  std::string extension = (file.extension() == ".zst" ? file.stem() : file).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

}  // namespace astrolith
