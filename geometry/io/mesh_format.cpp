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

struct OtherFile {
  std::string_view start;
  const char* name;
  const char* remedy = nullptr;  // null: give a mesh
};

constexpr const char* kUnpack = "unpack it first";
constexpr const char* kExport = "open it in its program, and export it as .ply, .obj or .stl";
constexpr const char* kReadPoints =
    "read it by Python's astrolith.bridges.read_points, or convert it to .ply (pdal translate)";
constexpr const char* kExportPlates = "export its plates: dskexp -dsk FILE -text FILE.tab -format 1 (NAIF)";

// Files of other kinds that users hand over by mistake.
constexpr OtherFile kOtherFiles[] = {
    {"\x89PNG", "a PNG picture"},
    {"\xff\xd8\xff", "a JPEG picture"},
    {"PK\x03\x04", "a zip archive or a document of an office", "unpack it, or save its table as .csv"},
    {"BZh", "a bzip2 archive", kUnpack},
    {"\xfd\x37zXZ", "an xz archive", kUnpack},
    {"7z\xbc\xaf\x27\x1c", "a 7-Zip archive", kUnpack},
    {"Rar!\x1a", "a RAR archive", kUnpack},
    {"II*", "a TIFF picture"},
    {std::string_view("MM\0*", 4), "a TIFF picture"},
    {"%PDF", "a PDF"},
    {"<?xml", "XML, such as a label or a scene",
     "give the file that a label names, or export a scene as .ply"},
    {"<", "HTML or XML"},
    {"{", "JSON"},
    {"DAF/DSK", "a SPICE DSK", kExportPlates},
    {"DAS/", "a SPICE DAS"},
    {"DAF/", "a SPICE DAF"},
    {"KPL/", "a SPICE text kernel"},
    {"Object = IsisCube", "an ISIS cube"},
    {"SIMPLE  =", "a FITS file"},
    {"\x89HDF", "an HDF5 file"},
    {"CDF\x01", "a NetCDF file"},
    {"CDF\x02", "a NetCDF file"},
    {"\x93NUMPY", "a NumPy array", "give it to Python's astrolith.Mesh"},
    {"ISO-10303-21", "a STEP file", "export it as triangles, .stl or .ply, from a CAD program"},
    {"Kaydara FBX", "an FBX scene", kExport},
    {"; FBX", "an FBX scene", kExport},
    {"BLENDER", "a scene of Blender", kExport},
    {"#VRML", "a VRML scene", kExport},
    {"PXR-USDC", "a USD scene", kExport},
    {"#usda", "a USD scene", kExport},
    {"Ogawa", "an Alembic scene", kExport},
    {"DRACO", "a Draco mesh", kExport},
    {"xof ", "a DirectX scene", kExport},
    {"# vtk DataFile", "a VTK file", kExport},
    {"# .PCD", "a point cloud of PCL", kReadPoints},
    {"LASF", "a LAS point cloud", kReadPoints},
    {"ASTM-E57", "an E57 point cloud", kReadPoints},
    {"\xd0\xcf\x11\xe0", "a document of Microsoft Office", "save its table as .csv"},
    {"version https://git-lfs", "a Git LFS pointer", "fetch the file itself: git lfs pull"},
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

std::string_view first_word(TextScanner& scan) { return scan.next_filled_line() ? scan.word() : ""; }

bool is_ply(const MeshFile& file) {
  TextScanner scan(file);
  return scan.next_line() && scan.word() == "ply" && scan.line_done();
}

// A binary STL may begin with "solid", too. Coordinates and attributes then soon give control characters.
bool is_text(std::string_view start) {
  return std::none_of(start.begin(), start.end(), [](char c) { return (c >= '\0' && c < '\t') || c == 127; });
}
bool is_ascii_stl(const MeshFile& file) {
  constexpr std::size_t kStart = 4096;
  TextScanner scan(file);
  return lower_case(first_word(scan)).starts_with("solid") &&
         is_text(std::string_view(file.bytes).substr(0, kStart));
}

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
     .tells_origin = true,
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
     .extensions = {".tab", ".plt", ".txt", ".ver"},
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
     .tells_unit = true,
     .tells_origin = true,
     .has_texture_coordinates = true},
    {.name = "OFF", .extensions = {".off"}, .has = is_off, .reader = read_off},
    {.name = "table of radii",
     .extensions = {".tab", ".plt", ".txt"},
     .has = is_grid_table,
     .reader = read_grid_table},
    {.name = "BMF", .extensions = {".bmf"}, .has = never, .reader = read_bmf},
    {.name = "SPICE DSK", .extensions = {".bds"}, .has = is_dsk, .reader = read_dsk},
    {.name = "glTF",
     .extensions = {".glb"},
     .has = is_glb,
     .reader = read_glb,
     .writer = write_glb,
     .tells_unit = true,
     .tells_origin = true,
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

bool is_packed(const std::filesystem::path& file) {
  return file.extension() == ".zst" || file.extension() == ".gz";
}

std::string remedy() { return "give a mesh (" + read_mesh_words() + ")"; }

// The kind of another file that the content begins as; null where it begins as none.
const OtherFile* other_file(const MeshFile& file) {
  const auto* const kind =
      std::find_if(std::begin(kOtherFiles), std::end(kOtherFiles),
                   [&](const OtherFile& other) { return file.bytes.starts_with(other.start); });
  return kind == std::end(kOtherFiles) ? nullptr : kind;
}

[[noreturn]] void fail_unknown(const MeshFile& file) {
  refuse_other_kinds(file, remedy());
  file.fail("byte 0", "neither name nor content tells a mesh format", remedy());
}

}  // namespace

void refuse_other_kinds(const MeshFile& file, const std::string& remedy) {
  const OtherFile* const other = other_file(file);
  if (other == nullptr) return;
  if (file.bytes.find("3D/3dmodel.model") != file.bytes.npos) file.fail("", "is a 3MF scene", kExport);
  file.fail("byte 0", std::string("the content is ") + other->name,
            other->remedy == nullptr ? remedy : other->remedy);
}

TriangleMesh read_content(const MeshFile& file) {
  const std::string extension = mesh_extension(file.path);
  const auto named = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const MeshFormat& f) {
    return f.reader != nullptr && may_end_in(f, extension);
  });
  const auto seen = std::find_if(std::begin(kFormats), std::end(kFormats),
                                 [&](const MeshFormat& f) { return f.has(file); });
  const bool is_named = named != std::end(kFormats);
  if (seen == std::end(kFormats)) {
    if (!is_named || other_file(file) != nullptr) fail_unknown(file);
    if (named->reader == read_stl_binary && is_text(file.bytes))
      file.fail("line 1", "text that does not begin with 'solid' is no STL", "correct the line or the name");
    return named->reader(file);
  }
  if (is_named && !may_end_in(*seen, extension)) {
    file.fail("byte 0", "the name ends in " + extension + " but the content looks like " + seen->name,
              "rename it to " + std::string(seen->extensions[0]));
  }
  return seen->reader(file);
}

bool looks_like_mesh(const MeshFile& file) {
  return other_file(file) != nullptr || std::any_of(std::begin(kFormats), std::end(kFormats),
                                                    [&](const MeshFormat& f) { return f.has(file); });
}

std::span<const MeshFormat> mesh_formats() { return kFormats; }

const MeshFormat& written_mesh_format(const std::filesystem::path& file) {
  const std::string extension = mesh_extension(file);
  const bool packed = is_packed(file);
  for (const MeshFormat& format : kFormats) {
    if (format.writer == nullptr || format.extensions[0] != extension) continue;
    if (!packed || (format.streamed && file.extension() == ".zst")) return format;
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
  std::string extension = (is_packed(file) ? file.stem() : file).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

}  // namespace astrolith
