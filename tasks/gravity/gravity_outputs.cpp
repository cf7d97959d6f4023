#include "tasks/gravity/gravity_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "geometry/io/ply_values.h"
#include "gravity/surface_gravity.h"
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

// The arrays of a .vtp: what its header says of each, and the bytes behind it, one after another, each with
// its length in front.
class VtpArrays {
 public:
  template <typename T>
  std::string add(const char* type, const std::string& name, int components, const std::vector<T>& values) {
    const std::string line = fmt::format(
        R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)", type,
        name, components, bytes_.size());
    const std::uint64_t length = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
    bytes_.append(reinterpret_cast<const char*>(values.data()), length);
    return line + "\n";
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// The mesh with the columns as values of its facets or of its vertices (VTK File Formats, PolyData in XML).
void write_vtp(const std::vector<GravityColumn>& columns, const GravityBody& body, bool at_facets,
               const std::filesystem::path& file, const std::string& tool) {
  const TriangleMesh& mesh = body.mesh;
  std::vector<double> points;
  for (const Vec3d& p : mesh.vertices) points.insert(points.end(), {p.x, p.y, p.z});
  std::vector<std::int64_t> corners, ends;
  for (const Triangle& t : mesh.triangles) {
    corners.insert(corners.end(), t.begin(), t.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  VtpArrays arrays;
  const char* const kind = at_facets ? "CellData" : "PointData";
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<!-- length unit: {}; gravity by {} -->\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData><Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n<Points>\n",
      body.unit, tool, mesh.vertices.size(), mesh.triangles.size());
  text += arrays.add("Float64", "Points", 3, points) + "</Points>\n<Polys>\n";
  text += arrays.add("Int64", "connectivity", 1, corners);
  text += arrays.add("Int64", "offsets", 1, ends);
  text += fmt::format("</Polys>\n<{}>\n", kind);
  for (std::size_t k = 3; k < columns.size(); ++k)
    text += arrays.add("Float64", columns[k].name, 1, columns[k].values);
  text += fmt::format("</{}>\n</Piece></PolyData>\n<AppendedData encoding=\"raw\">\n_", kind);
  write_file(file, text + arrays.bytes() + "\n</AppendedData>\n</VTKFile>\n");
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

void write_gravity(const std::vector<GravityColumn>& columns, const GravityBody& body, bool at_facets,
                   const std::filesystem::path& file, const std::string& tool) {
  if (file.extension() == ".csv") return write_csv(columns, file);
  if (file.extension() == ".npy") return write_table(columns, file);
  if (file.extension() == ".vtp") return write_vtp(columns, body, at_facets, file, tool);
  std::vector<VertexValues> quantities;
  for (std::size_t k = 3; k < columns.size(); ++k) quantities.push_back({columns[k].name, columns[k].values});
  write_ply_values(body.mesh, quantities, file, {body.unit, "as the input's", "gravity by " + tool, {}});
}

void write_harmonics(const nlohmann::ordered_json& figures, const std::filesystem::path& file,
                     const std::string& name) {
  const auto& harmonics = figures["harmonics"];
  const auto& rows = harmonics["degree_order_c_s"];
  const double radius = harmonics["reference_radius_m"],
               gm = kGravitationalConstant * figures["body"]["mass_kg"].get<double>();
  const int degree = rows.back()[0];
  std::string word = name;  // of the file's name
  std::replace(word.begin(), word.end(), ' ', '_');
  const bool icgem = file.extension() == ".gfc";
  std::string text =
      icgem ? fmt::format(
                  "product_type gravity_field\nmodelname {}\nearth_gravity_constant {:.16e}\nradius {:.16e}\n"
                  "max_degree {}\nerrors no\nnorm fully_normalized\ntide_system unknown\nkey L M C S\n"
                  "end_of_head\n",
                  word, gm, radius, degree)
            : fmt::format("{:23.16E},{:23.16E},{:23.16E},{:5},{:5},{:5},{:23.16E},{:23.16E}\r\n",
                          radius / 1e3, gm / 1e9, 0.0, degree, degree, 1, 0.0, 0.0);
  for (const auto& row : rows) {
    const int l = row[0], m = row[1];
    const double c = row[2], s = row[3];
    if (icgem) {
      text += fmt::format("gfc {:4} {:4} {:23.16e} {:23.16e}\n", l, m, c, s);
    } else if (l > 0) {  // that of degree 0 is 1
      text += fmt::format("{:5},{:5},{:23.16E},{:23.16E},{:23.16E},{:23.16E}\r\n", l, m, c, s, 0.0, 0.0);
    }
  }
  write_file(file, text);
}

void write_gravity_preview(const Job& job, const GravityBody& body, const GravityColumn& column,
                           const std::vector<LandingSite>& sites, const PictureOptions& look,
                           const std::filesystem::path& file) {
  const std::vector<double> values = vertex_values(body.mesh, column.values);
  const ValueRange range = value_range(values);
  PreviewOptions options = look.options(job, body.mesh, body.unit);
  options.vertex_colors = sequential_colors(values, range.low, range.high);
  options.marks.values = {range.low, range.high, column_title(column.name)};
  options.colors_are_values = true;
  paint_sites(body.mesh, sites, options.vertex_colors);
  for (std::size_t i = 0; i < sites.size() && !look.no_marks; ++i)
    options.marks.labels.push_back({sites[i].center, std::to_string(i + 1)});
  if (!sites.empty() && !PictureOptions::chooses_view(job)) options.views = views_from_above(sites);
  look.write(job, render_picture(body.mesh, options, job.progress("preview")), file);
  job.say(
      fmt::format("{}: {}; colours from {:.4g} to {:.4g}, the 1st and 99th percentile, of {:.4g} to {:.4g}",
                  file.string(), column.name, range.low, range.high, range.least, range.most));
}

}  // namespace astrolith
