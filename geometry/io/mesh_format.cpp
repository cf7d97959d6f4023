#include "geometry/io/mesh_format_internal.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "geometry/io/mesh_io.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {
namespace {

enum class Format { obj, ply, stl_ascii, stl_binary, off, plate, icq, bmf, other, unknown };

struct FormatEntry {
  Format format;
  const char* name;
  const char* extension;
  MeshReader reader;
};

constexpr FormatEntry kFormats[] = {
    {Format::obj, "Wavefront OBJ", ".obj", read_obj},
    {Format::ply, "PLY", ".ply", read_ply},
    {Format::stl_ascii, "ascii STL", ".stl", read_stl_ascii},
    {Format::stl_binary, "binary STL", ".stl", read_stl_binary},
    {Format::off, "OFF", ".off", read_off},
    {Format::plate, "PDS plate model", ".tab", read_plate},
    {Format::icq, "Gaskell ICQ", ".icq", read_icq},
    {Format::bmf, "BMF", ".bmf", read_bmf},
};

const FormatEntry& entry(Format format) {
  return *std::find_if(std::begin(kFormats), std::end(kFormats),
                       [&](const FormatEntry& e) { return e.format == format; });
}

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

bool starts_with_any(std::string_view text, std::span<const std::string_view> starts) {
  return std::any_of(starts.begin(), starts.end(), [&](std::string_view s) { return text.starts_with(s); });
}

// A binary STL has 80 bytes, a count and 50 bytes for each triangle. Files of other formats do not have
// exactly this size.
bool is_binary_stl(std::string_view bytes) {
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

// Tells tables of numbers apart. An ICQ states Q and goes on with "x y z". A plate model states its count (or
// both counts) and goes on with "i x y z", after both counts perhaps with "x y z".
Format sniff_table(const MeshFile& file) {
  TextScanner scan(file);
  const int first = count_numbers(scan);
  const int second = count_numbers(scan);
  if (first == 1 && second == 3) return Format::icq;
  if ((first == 1 || first == 2) && second == 4) return Format::plate;
  if (first == 2 && second == 3) return Format::plate;  // rows without numbers
  return Format::unknown;
}

Format sniff_words(const MeshFile& file) {
  TextScanner scan(file);
  if (!scan.next_filled_line()) return Format::unknown;
  static constexpr std::array<std::string_view, 10> kObjWords{"v", "vn", "vt",     "vp",     "f",
                                                              "o", "g",  "mtllib", "usemtl", "s"};
  const std::string_view word = scan.word();
  if (std::find(kObjWords.begin(), kObjWords.end(), word) != kObjWords.end()) return Format::obj;
  static constexpr std::array<std::string_view, 6> kOffWords{"OFF",   "COFF",  "NOFF",
                                                             "CNOFF", "STOFF", "NCOFF"};
  if (starts_with_any(word, kOffWords)) return Format::off;
  return sniff_table(file);
}

Format sniff(const MeshFile& file) {
  const std::string_view bytes = file.bytes;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return Format::ply;
  if (is_binary_stl(bytes)) return Format::stl_binary;
  if (bytes.starts_with("solid")) return Format::stl_ascii;
  for (const Signature& other : kOtherFiles) {
    if (bytes.starts_with(other.start)) return Format::other;
  }
  return sniff_words(file);
}

// The formats that an extension may stand for, the likeliest first; none for an unknown extension.
std::span<const Format> formats_of(const std::string& extension) {
  using enum Format;
  static constexpr Format kTable[] = {plate, icq, obj};
  static constexpr Format kIcq[] = {icq};
  static constexpr Format kStl[] = {stl_binary, stl_ascii};
  static constexpr Format kObj[] = {obj}, kPly[] = {ply}, kOff[] = {off}, kBmf[] = {bmf};
  if (extension == ".obj") return kObj;
  if (extension == ".ply") return kPly;
  if (extension == ".stl") return kStl;
  if (extension == ".off") return kOff;
  if (extension == ".bmf") return kBmf;
  if (extension == ".icq") return kIcq;
  if (extension == ".tab" || extension == ".plt" || extension == ".txt") return kTable;
  return {};
}

std::string describe(const MeshFile& file, Format seen) {
  for (const Signature& other : kOtherFiles) {
    if (seen == Format::other && file.bytes.starts_with(other.start)) return other.name;
  }
  return entry(seen).name;
}

}  // namespace

MeshReader reader_for(const MeshFile& file) {
  const auto named = formats_of(mesh_extension(file.path));
  const Format seen = sniff(file);
  if (seen == Format::other) {
    file.fail("byte 0", "the content is " + describe(file, seen),
              "give a mesh (.obj .ply .stl .off .tab .icq .bmf)");
  }
  if (seen == Format::unknown) {
    if (!named.empty()) return entry(named.front()).reader;
    file.fail("byte 0", "neither name nor content tells a mesh format",
              "give a mesh (.obj .ply .stl .off .tab .icq .bmf)");
  }
  const bool agree = named.empty() || std::find(named.begin(), named.end(), seen) != named.end();
  if (!agree) {
    file.fail("byte 0",
              "the name ends in " + mesh_extension(file.path) + " but the content looks like " +
                  describe(file, seen),
              std::string("rename it to ") + entry(seen).extension);
  }
  return entry(seen).reader;
}

}  // namespace astrolith
