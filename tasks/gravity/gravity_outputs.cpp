#include "tasks/gravity/gravity_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "geometry/io/ply_values.h"
#include "numerics/files/npy_file.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/preview.h"

namespace astrolith {
namespace {

void write_csv(const std::vector<GravityColumn>& columns, const std::filesystem::path& file) {
  OutputFile out(file);
  std::string text;
  for (const GravityColumn& c : columns) text += (text.empty() ? "" : ",") + c.name;
  text += '\n';
  for (std::size_t i = 0; i < columns.front().values.size(); ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      std::array<char, 32> digits{};
      const char* const end =
          std::to_chars(digits.data(), digits.data() + digits.size(), columns[k].values[i]).ptr;
      if (k > 0) text += ',';
      text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
    }
    text += '\n';
    if (text.size() > 65536) {
      out.write(text.data(), text.size());
      text.clear();
    }
  }
  out.write(text.data(), text.size());
  out.commit();
}

void write_table(const std::vector<GravityColumn>& columns, const std::filesystem::path& file) {
  const std::array<int, 2> shape{static_cast<int>(columns.front().values.size()),
                                 static_cast<int>(columns.size())};
  write_npy(interleave(columns), shape, file);
}

// Values of facets become those of vertices: means over the facets around each.
std::vector<double> vertex_values(const TriangleMesh& mesh, const std::vector<double>& values) {
  if (values.size() == mesh.vertices.size()) return values;
  std::vector<double> sums(mesh.vertices.size()), counts(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) sums[v] += values[i], counts[v] += 1.0;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

void paint_sites(const TriangleMesh& mesh, const std::vector<LandingSite>& sites,
                 std::vector<Vec3<float>>& colors) {
  const Vec3<float> orange{1.0f, 0.3f, 0.0f};
  for (const LandingSite& site : sites) {
    for (const std::uint32_t facet : site.facets) {
      for (const std::uint32_t v : mesh.triangles[facet]) colors[v] = orange;
    }
  }
}

// The first sites, each from above its ground.
std::vector<Camera> views_from_above(const std::vector<LandingSite>& sites) {
  constexpr std::size_t kMostViews = 9;
  std::vector<Camera> views;
  for (std::size_t i = 0; i < std::min(sites.size(), kMostViews); ++i) {
    views.push_back(view_from(sites[i].axes.up));
  }
  return views;
}

}  // namespace

void write_gravity(const std::vector<GravityColumn>& columns, const GravityBody& body,
                   const std::filesystem::path& file, const std::string& tool) {
  if (file.extension() == ".csv") return write_csv(columns, file);
  if (file.extension() == ".npy") return write_table(columns, file);
  std::vector<VertexValues> quantities;
  for (std::size_t k = 3; k < columns.size(); ++k) quantities.push_back({columns[k].name, columns[k].values});
  write_ply_values(body.mesh, quantities, file, {body.unit, "as the input's", "gravity by " + tool, {}});
}

void write_gravity_preview(const Job& job, const GravityBody& body, const GravityColumn& column,
                           const std::vector<LandingSite>& sites, const PictureOptions& look,
                           const std::filesystem::path& file) {
  const std::vector<double> values = vertex_values(body.mesh, column.values);
  const ValueRange range = value_range(values);
  PreviewOptions options = look.options(job, body.mesh, body.unit);
  options.vertex_colors = sequential_colors(values, range.low, range.high);
  options.marks.values = {range.low, range.high, column_title(column.name)};
  paint_sites(body.mesh, sites, options.vertex_colors);
  for (std::size_t i = 0; i < sites.size() && !look.no_marks; ++i)
    options.marks.labels.push_back({sites[i].center, std::to_string(i + 1)});
  if (!sites.empty() && look.cameras.empty() && look.views.empty()) options.views = views_from_above(sites);
  look.write(job, render_picture(body.mesh, options, job.progress("preview")), file);
  job.say(
      fmt::format("{}: {}; colours from {:.4g} to {:.4g}, the 1st and 99th percentile, of {:.4g} to {:.4g}",
                  file.string(), column.name, range.low, range.high, range.least, range.most));
}

}  // namespace astrolith
