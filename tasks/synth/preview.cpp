#include "tasks/synth/preview.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "numerics/files/npy_file.h"
#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/feature_list.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/surface_labels.h"
#include "synthesis/picture/picture_maps.h"
#include "tasks/job/output_names.h"
#include "tasks/job/pixel_size.h"

namespace astrolith {
namespace {

PixelSize parse_maps_size(const std::string& text) {
  return parse_pixel_size("--maps-size", text, kLeastPictureSide, kMostPictureSide);
}

// Pictures of members are smaller unless a size is given: many are made, of meshes of few triangles. Pictures
// for training show the body alone, and their pixels are those of their maps.
PreviewOptions picture_options(const Job& job, const PreviewRequest& request, const TriangleMesh& mesh,
                               const std::string& unit) {
  PreviewOptions options = request.look.options(job, mesh, unit);
  const bool is_member = job.options.option("--members").count() > 0;
  if (is_member && request.look.size.empty()) options.width = 640, options.height = 480;
  if (is_member || !request.maps.empty()) options.marks = {};
  return options;
}

// The cameras of the request with the size of its maps.
PreviewOptions maps_options(const Job& job, const PreviewRequest& request, const TriangleMesh& mesh) {
  PreviewOptions options = picture_options(job, request, mesh, "");
  options.marks = {};
  if (request.maps_size.empty()) return options;
  const PixelSize size = parse_maps_size(request.maps_size);
  options.width = size.width;
  options.height = size.height;
  return options;
}

// An array of an NPZ file, its last index running fastest. It does not own its values.
struct NpzArray {
  template <class T>
  NpzArray(std::string its_name, std::vector<int> its_shape, const std::vector<T>& of)
      : name(std::move(its_name)),
        type(std::is_same_v<T, float>    ? "<f4"
             : std::is_same_v<T, double> ? "<f8"
             : sizeof(T) == 1            ? "|i1"
                                         : "<i4"),
        shape(std::move(its_shape)),
        values(std::as_bytes(std::span(of))) {}

  std::string name, type;  // numpy's word for the type
  std::vector<int> shape;  // empty for a single number
  std::span<const std::byte> values;
};

constexpr int kLevel = 1;                          // of zlib; higher levels save some percent only
constexpr std::uint16_t kFirstDay = (1 << 5) | 1;  // 1 January 1980, where the dates of zip archives begin

struct DiscardArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Archive = std::unique_ptr<zip_t, DiscardArchive>;
using Source = std::unique_ptr<zip_source_t, FreeSource>;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw WorkError(file.string() + ": cannot be packed: " + reason);
}

Source make_source(const void* data, std::size_t bytes, const std::filesystem::path& file) {
  zip_error_t error;
  zip_error_init(&error);
  Source source(zip_source_buffer_create(data, bytes, 0, &error));
  if (!source) fail(file, zip_error_strerror(&error));
  return source;
}

std::string npy_bytes(const NpzArray& array) {
  return npy_header(array.type, array.shape)
      .append(reinterpret_cast<const char*>(array.values.data()), array.values.size());
}

// The archive only refers to `bytes`, which must live until it is closed.
void add(zip_t* archive, const std::string& name, const std::string& bytes,
         const std::filesystem::path& file) {
  Source source = make_source(bytes.data(), bytes.size(), file);
  const zip_int64_t index = zip_file_add(archive, (name + ".npy").c_str(), source.get(), ZIP_FL_ENC_UTF_8);
  if (index < 0) fail(file, zip_strerror(archive));
  static_cast<void>(source.release());  // the archive owns it now
  const auto number = static_cast<zip_uint64_t>(index);
  if (zip_set_file_compression(archive, number, ZIP_CM_DEFLATE, kLevel) != 0 ||
      zip_file_set_dostime(archive, number, 0, kFirstDay, 0) != 0) {
    fail(file, zip_strerror(archive));
  }
}

void copy(zip_source_t* packed, const std::filesystem::path& file) {
  OutputFile out(file);
  if (zip_source_open(packed) != 0) fail(file, zip_error_strerror(zip_source_error(packed)));
  std::array<char, 1 << 16> buffer;
  zip_int64_t bytes = 0;
  while ((bytes = zip_source_read(packed, buffer.data(), buffer.size())) > 0) {
    out.write(buffer.data(), static_cast<std::size_t>(bytes));
  }
  zip_source_close(packed);
  if (bytes < 0) fail(file, zip_error_strerror(zip_source_error(packed)));
  out.commit();
}

// Writes the arrays, compressed, in their order. The file has no time stamps: equal arrays give equal bytes.
// It appears whole or not at all. Throws InputError where the target cannot be written, and WorkError where
// memory or the disk is full.
void write_npz(std::span<const NpzArray> arrays, const std::filesystem::path& file) {
  std::vector<std::string> contents;
  for (const NpzArray& array : arrays) {
    const std::size_t value_bytes = static_cast<std::size_t>(array.type.back() - '0');
    if (array.values.size() != npy_size(array.shape) * value_bytes)
      throw WorkError(file.string() + ": " + array.name + ": the array does not have the stated shape");
    contents.push_back(npy_bytes(array));
  }
  const Source packed = make_source(nullptr, 0, file);
  zip_error_t error;
  zip_error_init(&error);
  zip_source_keep(packed.get());  // read once the archive, which owns one reference, is closed
  Archive archive(zip_open_from_source(packed.get(), ZIP_TRUNCATE, &error));
  if (!archive) {
    zip_source_free(packed.get());
    fail(file, zip_error_strerror(&error));
  }
  for (std::size_t i = 0; i < contents.size(); ++i) add(archive.get(), arrays[i].name, contents[i], file);
  if (zip_close(archive.get()) != 0) fail(file, zip_strerror(archive.get()));
  static_cast<void>(archive.release());
  copy(packed.get(), file);
}

constexpr std::int32_t kNothing = -1;

// What the layers made, for each pixel.
struct LayerMaps {
  std::vector<std::int32_t> layer, instance;
};

// The pixels of a band of rows that show the surface, and their points in the frame of the mesh.
struct SeenPixels {
  std::vector<std::size_t> pixels;
  std::vector<MeshVertex> points;
};

SeenPixels seen_in_rows(const PictureMaps& maps, int first, int end) {
  SeenPixels seen;
  for (int y = first; y < end; ++y) {
    for (int x = 0; x < maps.width; ++x) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(maps.width) + static_cast<std::size_t>(x);
      if (!maps.shows_surface(i)) continue;
      seen.pixels.push_back(i);
      seen.points.push_back({to_float(maps.point(x, y)), {}});
    }
  }
  return seen;
}

LayerMaps label_pixels(const PictureMaps& maps, const MeshPart& part, double cell, const Progress& progress) {
  const SurfaceLabels labels(part.recipe, part.field, part.region.cube());
  const FeatureFinder landforms(part.field, part.recipe, part.region.cube(), cell);
  const Vec3d origin = part.region.center;
  LayerMaps made{std::vector<std::int32_t>(maps.depth.size(), kNothing),
                 std::vector<std::int32_t>(maps.depth.size(), kNothing)};
  constexpr int kBand = 32;  // rows between two reports of progress
  for (int first = 0; first < maps.height; first += kBand) {
    const SeenPixels seen = seen_in_rows(maps, first, std::min(first + kBand, maps.height));
    std::vector<VertexLabel> label(seen.points.size());
    std::vector<float> ground(seen.points.size());
    labels.label(origin, seen.points, label, ground);
    parallel_for(0, static_cast<std::int64_t>(seen.pixels.size()), [&](std::int64_t k) {
      const auto at = static_cast<std::size_t>(k);
      const Vec3f& p = seen.points[at].position;
      made.layer[seen.pixels[at]] = label[at].label;
      made.instance[seen.pixels[at]] = landforms.row_at(origin + Vec3d{p.x, p.y, p.z}, ground[at]);
    });
    if (!report(progress, double(first) / maps.height, "labels"))
      throw WorkError("preview-maps: stopped before the maps were complete");
  }
  report(progress, 1.0, "");
  return made;
}

std::vector<double> flat(const std::vector<Vec3d>& vectors) {
  std::vector<double> numbers;
  for (const Vec3d& v : vectors) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return numbers;
}

}  // namespace

void declare_preview_options(Job& job, PreviewRequest& request) {
  job.options
      .add_option("--preview", request.file,
                  "also a picture (.png, .svg, .pdf) of the mesh under sunlight, with shadows: from +x, +y, "
                  "+z and obliquely, a "
                  "patch from above its ground and obliquely")
      .placeholder("FILE.png")
      .writes();
  request.look.add_to(job.options);
  job.options.option("--picture-size").placeholder("WxH (default 1280x960, 640x480 of --members)");
  job.options
      .add_option("--preview-maps", request.maps,
                  "also what each pixel of the picture shows, for numpy.load: depth, normal, layer, and "
                  "instance, the row of the --feature-list; with the cameras")
      .placeholder("FILE.npz")
      .writes();
  job.options.add_option("--maps-size", request.maps_size, "pixels of the maps")
      .placeholder("WxH (default that of the picture)")
      .default_text("");
}

void check_preview(const Job& job, const PreviewRequest& request) {
  const bool has_picture = !request.file.empty(), has_maps = !request.maps.empty();
  request.look.check(job, has_picture, "add --preview FILE.png");
  if (has_maps && !has_picture) {
    throw InputError("--preview-maps: is about a picture; add --preview FILE.png");
  }
  if (has_maps && !request.look.map.empty())
    throw InputError("--preview-maps: has the cameras of views, and --map has none; leave out one of them");
  if (!request.maps_size.empty()) {
    if (!has_maps) throw InputError("--maps-size: is about maps; add --preview-maps FILE.npz");
    parse_maps_size(request.maps_size);
  }
  if (has_picture) {
    request.look.check_file(request.file);
    // Their pictures have no text, and are drawn side by side.
    if (job.options.option("--members").count() > 0 && request.file.extension() != ".png")
      throw InputError("--preview: pictures of members are .png");
    require_writable(request.file);
  }
  if (has_maps) {
    require_extension(request.maps, {".npz"});
    require_writable(request.maps);
  }
}

void require_cameras_outside(const Job& job, const PreviewRequest& request, const ImplicitField& field) {
  if (request.file.empty() || !request.look.has_pinholes()) return;
  constexpr int kCells = 32;  // along the longest side of the body
  MeshStatistics made;
  const TriangleMesh coarse = make_coarse_mesh(field, kCells, &made);
  if (coarse.triangles.empty()) return;
  // Cameras that stand by the body's box are known to about a cell.
  const double deep = 2.0 * made.step;
  for (const Vec3d& place : pinhole_places(coarse, picture_options(job, request, coarse, ""))) {
    if (field.value(place) > deep) fail_inside();
  }
}

void require_cameras_outside(const Job& job, const PreviewRequest& request, const TriangleMesh& mesh) {
  if (request.file.empty() || !request.look.has_pinholes()) return;
  require_cameras_outside(mesh, picture_options(job, request, mesh, ""));
}

void write_preview(const Job& job, const PreviewRequest& request, const TriangleMesh& mesh,
                   const std::string& unit) {
  PreviewOptions options = picture_options(job, request, mesh, unit);
  options.vertex_colors = linear_colors(mesh);
  request.look.write(job, render_picture(mesh, options, job.progress("preview")), request.file);
}

void write_preview_maps(Job& job, const PreviewRequest& request, const TriangleMesh& mesh,
                        const MeshPart& part, double cell) {
  const PictureMaps maps = render_maps(mesh, maps_options(job, request, mesh), job.progress("maps"));
  const int h = maps.height, w = maps.width, views = static_cast<int>(maps.from.size());
  const std::vector<double> right = flat(maps.right), up = flat(maps.up), from = flat(maps.from),
                            corner = flat(maps.corner), eye = flat(maps.eye), pixel{maps.pixel};
  std::vector<NpzArray> arrays{
      {"depth", {h, w}, maps.depth}, {"normal", {h, w, 3}, maps.normal}, {"view", {h, w}, maps.view}};
  LayerMaps layers;
  if (part.recipe.erosion) {
    job.say("note: erosion moves what layers made: " + request.maps.string() +
            " has depth and normal, but neither layer nor instance");
  } else {
    layers = label_pixels(maps, part, cell, job.progress("labels"));
    arrays.push_back({"layer", {h, w}, layers.layer});
    arrays.push_back({"instance", {h, w}, layers.instance});
  }
  arrays.push_back({"right", {views, 3}, right});
  arrays.push_back({"up", {views, 3}, up});
  arrays.push_back({"from", {views, 3}, from});
  arrays.push_back({"corner", {views, 3}, corner});
  arrays.push_back({"eye", {views, 3}, eye});
  arrays.push_back({"pixel", {}, pixel});
  write_npz(arrays, request.maps);
}

}  // namespace astrolith
