#include "tasks/synth/tile_certificate.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "numerics/files/sha256.h"
#include "numerics/json_whole.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kMostSummaryBytes = 1 << 16;
constexpr int kMostLevels = 32;  // of nested objects and arrays
constexpr std::int64_t kMostTiles = 1 << 20;
constexpr std::int64_t kMostElements = std::int64_t{1} << 34;  // triangles of 2^32 vertices, and a border
constexpr std::size_t kLongestText = 4096;

Json side_to_json(const TileSide& side) {
  return {{"z", side.z}, {"vertices", side.vertices}, {"loops", side.loops}, {"sha256", side.sha256}};
}

std::string make_checksum(const Json& certificate) {
  Json stated = certificate;
  stated.erase("checksum");
  return sha256(stated.dump(-1, ' ', false, Json::error_handler_t::replace));
}

// Reads the fields of an object of a summary. Failures name the file and the field.
class CertificateFields {
 public:
  CertificateFields(const fs::path& file, const Json& object, std::string path)
      : file_(file), object_(object), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_.string() + ": " + what + "; give the --summary of synth --tile");
  }
  std::int64_t count(const char* name, std::int64_t least, std::int64_t most) const {
    const std::optional<std::int64_t> number = whole_number<std::int64_t>(at(name));
    if (!number) fail(path_ + name + ": is no whole number");
    if (*number < least || *number > most) fail(path_ + name + ": is out of range");
    return *number;
  }
  double number(const char* name) const {
    const Json& value = at(name);
    if (!value.is_number() || !std::isfinite(value.get<double>())) fail(path_ + name + ": is no number");
    return value.get<double>();
  }
  std::string text(const char* name) const {
    const Json& value = at(name);
    if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestText)
      fail(path_ + name + ": is no text");
    return value.get<std::string>();
  }
  std::string hash(const char* name) const {
    std::string digits = text(name);
    if (digits.size() != 64 || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
      fail(path_ + name + ": is no SHA-256");
    return digits;
  }
  CertificateFields object(const char* name) const {
    const Json& value = at(name);
    if (!value.is_object()) fail(path_ + name + ": is no object");
    return {file_, value, path_ + name + "."};
  }
  bool has(const char* name) const { return object_.contains(name); }

 private:
  const Json& at(const char* name) const {
    if (!object_.contains(name)) fail(path_ + name + ": is missing");
    return object_.at(name);
  }

  const fs::path& file_;
  const Json& object_;
  std::string path_;
};

TileSide read_side(const CertificateFields& fields) {
  const double height = fields.number("z");
  if (std::fabs(height) > double{std::numeric_limits<float>::max()})
    fields.fail("tile: has a side beyond all numbers of 32 bits");
  const auto z = static_cast<float>(height);
  return {z, fields.count("vertices", 0, kMostElements), fields.count("loops", 0, kMostElements),
          fields.hash("sha256")};
}

// Figures that no tile can have are refused, so that sums over tiles cannot mislead.
void require_possible(const CertificateFields& fields, const TileCertificate& tile) {
  const TileFigures& figures = tile.figures;
  if (figures.lower.has_value() != (tile.number > 1) ||
      figures.upper.has_value() != (tile.number < tile.count))
    fields.fail("tile: has other sides than tile " + std::to_string(tile.number) + " of " +
                std::to_string(tile.count));
  if (figures.lower && figures.upper && !(figures.lower->z < figures.upper->z))
    fields.fail("tile: its lower side lies above its upper side");
  if ((3 * figures.triangles + figures.border_vertices()) % 2 != 0)
    fields.fail("tile: has triangles whose edges do not add up");
}

TileCertificate read_fields(const CertificateFields& fields) {
  TileCertificate tile;
  tile.count = static_cast<int>(fields.count("count", 1, kMostTiles));
  tile.number = static_cast<int>(fields.count("number", 1, tile.count));
  tile.recipe_sha256 = fields.hash("recipe_sha256");
  tile.resolution = static_cast<int>(fields.count("resolution", 1, kMaxResolution));
  tile.length_unit = fields.text("length_unit");
  tile.file = fields.text("file");
  tile.file_sha256 = fields.hash("file_sha256");
  tile.figures.vertices = fields.count("vertices", 0, kMostElements);
  tile.figures.triangles = fields.count("triangles", 0, kMostElements);
  tile.figures.volume = fields.number("volume");
  if (fields.has("lower")) tile.figures.lower = read_side(fields.object("lower"));
  if (fields.has("upper")) tile.figures.upper = read_side(fields.object("upper"));
  require_possible(fields, tile);
  return tile;
}

Json parse_summary(const fs::path& file) {
  require_plain_file(file);
  if (fs::file_size(file) > kMostSummaryBytes)
    throw InputError(file.string() + ": is larger than 64 kB; give the --summary of synth --tile");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be read; check its permissions");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  // Deep nesting would take the stack.
  const auto refuse_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kMostLevels)
      throw InputError(file.string() + ": is nested too deeply; give the --summary of synth --tile");
    return true;
  };
  Json summary = Json::parse(text, refuse_depth, false);
  if (!summary.is_object())
    throw InputError(file.string() + ": is no whole JSON object; make the tile again with --summary");
  return summary;
}

}  // namespace

TilePlanes tile_planes(const ImplicitField& field, int resolution, MeshTile tile) {
  const SampleGrid grid = make_sample_grid(field.bounds(), resolution);
  const CellWindow window = tile_window<kBlockCells>(grid, tile);
  TilePlanes planes;
  if (tile.index > 0) planes.lower = grid.z(window.first[2] - 1);
  if (tile.index + 1 < tile.count) planes.upper = grid.z(window.last[2]);
  return planes;
}

std::string hash_recipe(Recipe recipe) {
  recipe.description.clear();
  return sha256(recipe_to_json(recipe));
}

Json to_json(const TileCertificate& tile) {
  const TileFigures& figures = tile.figures;
  Json json = {{"number", tile.number},
               {"count", tile.count},
               {"recipe_sha256", tile.recipe_sha256},
               {"resolution", tile.resolution},
               {"length_unit", tile.length_unit},
               {"file", tile.file},
               {"file_sha256", tile.file_sha256},
               {"vertices", figures.vertices},
               {"triangles", figures.triangles},
               {"euler_characteristic", figures.euler_characteristic()},
               {"volume", figures.volume}};
  if (figures.lower) json["lower"] = side_to_json(*figures.lower);
  if (figures.upper) json["upper"] = side_to_json(*figures.upper);
  json["checksum"] = make_checksum(json);
  return json;
}

TileCertificate read_tile_certificate(const fs::path& file) {
  const Json summary = parse_summary(file);
  const CertificateFields top(file, summary, "");
  TileCertificate tile = read_fields(top.object("tile"));
  // Plain JSON does not know an order of fields.
  if (nlohmann::json(summary["tile"]) != nlohmann::json(to_json(tile)))
    throw InputError(file.string() + ": tile: was changed since synth wrote it; make the tile again");
  return tile;
}

}  // namespace astrolith
