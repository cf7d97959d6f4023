#include "apps/synth/synth_preview_maps.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "apps/synth/npz_file.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/feature_list.h"
#include "synthesis/field/surface_labels.h"
#include "synthesis/picture/picture_maps.h"

namespace astrolith {
namespace {

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

LayerMaps label_pixels(const PictureMaps& maps, const MapsSource& source, const Progress& progress) {
  const SurfaceLabels labels(source.recipe, source.field, source.region.cube());
  const FeatureFinder landforms(source.field, source.recipe, source.region.cube(), source.cell);
  const Vec3d origin = source.region.center;
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

void write_preview_maps(Program& program, const PreviewRequest& request, const TriangleMesh& mesh,
                        const MapsSource& source) {
  const PictureMaps maps = render_maps(mesh, maps_options(program, request, mesh), program.progress("maps"));
  const int h = maps.height, w = maps.width, views = static_cast<int>(maps.from.size());
  const std::vector<double> right = flat(maps.right), up = flat(maps.up), from = flat(maps.from),
                            corner = flat(maps.corner), eye = flat(maps.eye), pixel{maps.pixel};
  std::vector<NpzArray> arrays{npz_array("depth", {h, w}, maps.depth),
                               npz_array("normal", {h, w, 3}, maps.normal),
                               npz_array("view", {h, w}, maps.view)};
  LayerMaps layers;
  if (source.recipe.erosion) {
    program.say("note: erosion moves what layers made: " + request.maps.string() +
                " has depth and normal, but neither layer nor instance");
  } else {
    layers = label_pixels(maps, source, program.progress("labels"));
    arrays.push_back(npz_array("layer", {h, w}, layers.layer));
    arrays.push_back(npz_array("instance", {h, w}, layers.instance));
  }
  arrays.push_back(npz_array("right", {views, 3}, right));
  arrays.push_back(npz_array("up", {views, 3}, up));
  arrays.push_back(npz_array("from", {views, 3}, from));
  arrays.push_back(npz_array("corner", {views, 3}, corner));
  arrays.push_back(npz_array("eye", {views, 3}, eye));
  arrays.push_back(npz_array("pixel", {}, pixel));
  write_npz(arrays, request.maps);
}

}  // namespace astrolith
