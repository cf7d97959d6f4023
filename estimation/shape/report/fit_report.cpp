#include "estimation/shape/report/fit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "descriptor/surface/surface_statistics.h"
#include "estimation/page/report_page.h"
#include "estimation/shape/report/fit_plots.h"
#include "geometry/surface/decimated_mesh.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/triangle_mesh.h"
#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/figure.h"
#include "synthesis/picture/preview.h"

namespace astrolith {
namespace {

// A surface in a figure.
struct NamedSurface {
  const std::string& name;
  const TriangleMesh& mesh;
  const SurfaceStatistics& statistics;
};

constexpr Ink kInkA{0.16, 0.35, 0.63}, kInkB{0.83, 0.37, 0.10};

std::vector<double> sorted_values(const LocalStatistic& statistic) {
  std::vector<double> sorted = statistic.values;
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

std::vector<std::pair<double, double>> quantile_curve(const std::vector<double>& sorted) {
  std::vector<std::pair<double, double>> curve;
  for (int percent = 1; percent <= 99; ++percent) {
    curve.emplace_back(percent, sorted_quantile(sorted, 0.01 * percent));
  }
  return curve;
}

std::string make_heading(const LocalStatistic& statistic) {
  const char* heading = quantity_traits(statistic.quantity).heading;
  return statistic.radius > 0.0 ? fmt::format("{}, {:g} edges", heading, statistic.radius) : heading;
}

void draw_quantiles(Figure& page, const Rectangle& at, const LocalStatistic& a, const LocalStatistic& b) {
  const std::vector<double> sorted_a = sorted_values(a), sorted_b = sorted_values(b);
  const double low = std::min(sorted_quantile(sorted_a, 0.01), sorted_quantile(sorted_b, 0.01)),
               high = std::max(sorted_quantile(sorted_a, 0.99), sorted_quantile(sorted_b, 0.99));
  const double room = std::max(0.05 * (high - low), 1e-9);
  const Axis x = linear_axis(0.0, 100.0, ""), y = linear_axis(low - room, high + room, "");
  page.text(at.x, at.y - 5.0, make_heading(a), 8.0);
  page.axes(at, x, y);
  page.curve(at, x, y, quantile_curve(sorted_a), kInkA);
  page.curve(at, x, y, quantile_curve(sorted_b), kInkB);
}

// The roughness at every vertex: the mean over all places, with weights that fall as the fourth power of the
// distance beyond the radius of the statistic.
std::vector<double> roughness_at_vertices(const NamedSurface& surface, const LocalStatistic& roughness) {
  const double scale = surface.statistics.edge * roughness.radius;
  const std::vector<Vec3d>& places = surface.statistics.places;
  std::vector<double> values(surface.mesh.vertices.size());
  parallel_for(
      0, static_cast<std::int64_t>(values.size()),
      [&](std::int64_t i) {
        const auto v = static_cast<std::size_t>(i);
        double sum = 0.0, weights = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k) {
          const double x = squared_norm(places[k] - surface.mesh.vertices[v]) / (scale * scale);
          const double weight = 1.0 / (0.01 + x * x);
          sum += weight * roughness.values[k];
          weights += weight;
        }
        values[v] = sum / weights;
      },
      64);
  return values;
}

const LocalStatistic& mapped_roughness(const SurfaceStatistics& surface) {
  const LocalStatistic* roughness = surface.find(SurfaceQuantity::roughness, 6.0);
  return roughness != nullptr ? *roughness : surface.local.front();
}

CaptionedPicture roughness_map(const NamedSurface& surface, double low, double high) {
  PreviewOptions options;
  options.width = 800;
  options.height = 600;
  options.ambient = 0.5;  // keeps colours readable in the shadows
  options.vertex_colors =
      sequential_colors(roughness_at_vertices(surface, mapped_roughness(surface.statistics)), low, high);
  return {render_preview(surface.mesh, options), surface.name};
}

// Writes a PNG with the quantile curves of both surfaces, a diagram for each statistic that both have: the
// value over the share of places below it, from 1 % to 99 %. Throws InputError where the file cannot be
// written.
void write_quantile_curves(const NamedSurface& a, const NamedSurface& b, const std::filesystem::path& file) {
  constexpr double kWidth = 150.0, kHeight = 100.0, kLeft = 44.0, kTop = 52.0, kAcross = 200.0, kDown = 142.0;
  constexpr int kColumns = 4;
  std::vector<std::pair<const LocalStatistic*, const LocalStatistic*>> both;
  for (const LocalStatistic& statistic_a : a.statistics.local) {
    const LocalStatistic* statistic_b = b.statistics.find(statistic_a.quantity, statistic_a.radius);
    if (statistic_b != nullptr) both.emplace_back(&statistic_a, statistic_b);
  }
  const std::size_t rows = (both.size() + kColumns - 1) / kColumns;
  Figure page(kColumns * kAcross + 10.0, kTop + static_cast<double>(rows) * kDown);
  page.text(kLeft, 20.0, a.name, 10.0, Figure::Align::kLeft, true, kInkA);
  page.text(kLeft + kAcross, 20.0, b.name, 10.0, Figure::Align::kLeft, true, kInkB);
  page.text(page.width() - 10.0, 20.0, "values over the share of places below them, %", 9.0,
            Figure::Align::kRight);
  for (std::size_t k = 0; k < both.size(); ++k) {
    const std::size_t column = k % kColumns, row = k / kColumns;
    const double x = kLeft + static_cast<double>(column) * kAcross,
                 y = kTop + static_cast<double>(row) * kDown;
    draw_quantiles(page, {x, y, kWidth, kHeight}, *both[k].first, *both[k].second);
  }
  page.write_png(file, 144.0);
}

// Writes a PNG with both bodies, coloured by the roughness within 6 edges (or the smallest radius) around
// each place. The colours run from the 5 % to the 95 % quantile of the first. Throws as above.
void write_roughness_maps(const NamedSurface& a, const NamedSurface& b, const std::filesystem::path& file) {
  const std::vector<double> sorted = sorted_values(mapped_roughness(a.statistics));
  const double low = sorted_quantile(sorted, 0.05),
               high = std::max(sorted_quantile(sorted, 0.95), low + 1e-6);
  const double radius = mapped_roughness(a.statistics).radius;
  CaptionedPicture left = roughness_map(a, low, high), right = roughness_map(b, low, high);
  left.caption += fmt::format(": roughness within {:g} edges, dark {:.2g} %, light {:.2g} % of that radius",
                              radius, 100.0 * portable::exp(low), 100.0 * portable::exp(high));
  write_captioned_pictures({left, right}, file);
}

PreviewOptions small_preview() {
  PreviewOptions options;
  options.width = 800;
  options.height = 600;
  return options;
}

// The distance of every vertex of the mesh from another surface, as a fraction of the diagonal.
std::vector<double> vertex_distances(const SurfaceTree& other, const TriangleMesh& mesh) {
  std::vector<double> distances(mesh.vertices.size());
  parallel_for(
      0, static_cast<std::int64_t>(distances.size()),
      [&](std::int64_t i) {
        const auto v = static_cast<std::size_t>(i);
        distances[v] = other.closest(mesh.vertices[v]).distance;
      },
      64);
  return distances;
}

std::string percent(double fraction) { return fmt::format("{:.3f} %", 100.0 * fraction); }

void write_target_and_fit(const TargetBody& target, const ShapeFitResult& fit,
                          const std::filesystem::path& file) {
  std::vector<CaptionedPicture> pictures{{render_preview(target.mesh, small_preview()), "target"}};
  const std::string metaballs = std::to_string(fit.body.num_metaballs()) + " metaballs";
  const bool has_details = !fit.base_mesh.triangles.empty();
  if (has_details) pictures.push_back({render_preview(fit.base_mesh, small_preview()), metaballs + " alone"});
  pictures.push_back({render_preview(fit.check.mesh, small_preview()),
                      (has_details ? "with details" : metaballs) + ", mean distance " +
                          percent(fit.check.distance.mean) + " of the diagonal"});
  write_captioned_pictures(pictures, file);
}

void write_distance_map(const TargetBody& target, const ShapeFitResult& fit,
                        const std::filesystem::path& file) {
  PreviewOptions options = small_preview();
  options.vertex_colors = sequential_colors(vertex_distances(target.tree, fit.check.mesh), 0.0,
                                            std::max(fit.check.distance.p99, 1e-9));
  options.ambient = 0.5;  // keeps colours readable in the shadows
  write_picture_with_scale(
      {render_preview(fit.check.mesh, options), "distance from the fit to the target, of the diagonal"},
      {"0", percent(fit.check.distance.p99)}, file);
}

TriangleMesh for_page(const TriangleMesh& mesh) {
  constexpr std::size_t kManyTimes = 4;  // more vertices than these would take minutes
  if (mesh.vertices.size() <= kMostPageVertices) return mesh;
  return decimated(clustered(mesh, kManyTimes * kMostPageVertices), kMostPageVertices);
}

TurnableSurface colored_surface(const std::string& caption, TriangleMesh mesh, const SurfaceTree& other,
                                double largest) {
  TurnableSurface surface{caption, std::move(mesh), {}};
  for (const Vec3<float>& c : sequential_colors(vertex_distances(other, surface.mesh), 0.0, largest)) {
    surface.rgb.insert(surface.rgb.end(), {srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z)});
  }
  return surface;
}

// Target and fit, each coloured by its distance from the other.
TurnableSurfaces target_beside_fit(const TargetBody& target, const TriangleMesh& page_target,
                                   const ShapeFitResult& fit) {
  const double largest = std::max(fit.check.distance.p99, 1e-9);
  return {colored_surface("target", page_target, SurfaceTree(fit.check.mesh), largest),
          colored_surface("fit", for_page(fit.check.mesh), target.tree, largest),
          "the distance from the other body, of the bounding-box diagonal", "0", percent(largest)};
}

TurnableSurfaces target_beside_likeness(const TargetBody& target, const TriangleMesh& page_target,
                                        TriangleMesh likeness) {
  for (Vec3d& p : likeness.vertices) p = (1.0 / target.diagonal) * (p - target.center);
  return {{"target", page_target, {}}, {"another body of its kind", for_page(likeness), {}}, "", "", ""};
}

// The pairs to turn, but for bodies of very many small parts, which cannot be decimated for a page.
std::vector<TurnableSurfaces> surface_pairs(const TargetBody& target, const ShapeFitResult& fit,
                                            const TriangleMesh* likeness) {
  const TriangleMesh page_target = for_page(target.mesh);
  std::vector<TurnableSurfaces> pairs{target_beside_fit(target, page_target, fit)};
  if (likeness != nullptr) pairs.push_back(target_beside_likeness(target, page_target, *likeness));
  std::erase_if(pairs, [](const TurnableSurfaces& pair) {
    return std::max(pair.left.mesh.vertices.size(), pair.right.mesh.vertices.size()) > kMostPageVertices;
  });
  return pairs;
}

// Signed distances from the target at points spread evenly over the fit, as fractions of the diagonal.
std::vector<double> sampled_distances(const TargetBody& target, const TriangleMesh& mesh) {
  constexpr std::int64_t kSamples = 50000;
  const std::vector<Vec3d> points = sample_surface(mesh, kSamples, 1).points;
  std::vector<double> distances(points.size());
  parallel_for(
      0, kSamples,
      [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        distances[k] = target.tree.signed_distance(points[k]);
      },
      64);
  return distances;
}

PageTable distance_table(const SurfaceDistanceReport& d) {
  const auto row = [](const char* name, double mean, double p99, double max) {
    return std::vector<std::string>{name, percent(mean), percent(p99), percent(max)};
  };
  return {{"distance, of the bounding-box diagonal", "mean", "99 of 100 within", "largest"},
          {row("from the target to the fit", d.from_a_to_b.mean, d.from_a_to_b.p99, d.from_a_to_b.max),
           row("from the fit to the target", d.from_b_to_a.mean, d.from_b_to_a.p99, d.from_b_to_a.max),
           row("both", d.mean, d.p99, d.max)}};
}

PageTable likeness_table(const ShapeFitResult& fit) {
  const auto stated = [&](double MeasuredSimilarity::*figure) {
    return fit.similarity ? percent((*fit.similarity).*figure) : "not measured";
  };
  return {{"likeness", ""},
          {{"similarity of the shape histograms (ahd)", stated(&MeasuredSimilarity::value)},
           {"similarity of two samplings of the target", stated(&MeasuredSimilarity::floor)},
           {"volume of the fit over that of the target", fmt::format("{:.5f}", fit.check.volume_ratio)}}};
}

PageTable body_table(const TargetBody& target, const ShapeFitResult& fit) {
  return {{"body", "target", "fit"},
          {{"components", std::to_string(target.components), std::to_string(fit.check.topology.components)},
           {"handles", "", std::to_string(fit.check.topology.genus)},
           {"triangles or metaballs", std::to_string(target.mesh.triangles.size()),
            std::to_string(fit.body.num_metaballs())},
           {"subtractive metaballs", "", std::to_string(fit.body.subtract.size())},
           {"sharpness m a of the blend", "", fmt::format("{:.4g}", fit.body.blend_exponent * fit.body.a)}}};
}

std::string statistic_words(const StatisticComparison& c, double edge, const LengthWords& lengths) {
  if (c.correlation) {
    return "correlation of roughness, " + fmt::format("{:.3g}", c.radius * edge * lengths.scale) + " to " +
           fmt::format("{:.3g}", c.reach * edge * lengths.scale) + " " + lengths.unit + " apart";
  }
  const std::string name = quantity_name(c.quantity);
  return c.radius > 0.0
             ? name + " within " + fmt::format("{:.3g}", c.radius * edge * lengths.scale) + " " + lengths.unit
             : name;
}

PageTable realism_table(const ReportedRealism& realism) {
  PageTable table{{"surface", "target", "fit", "distance", "p"}, {}};
  for (const StatisticComparison& c : realism.verdict.statistics) {
    table.rows.push_back({statistic_words(c, realism.verdict.edge, realism.lengths),
                          fmt::format("{:.3f}", c.middle_a), fmt::format("{:.3f}", c.middle_b),
                          fmt::format("{:.3f}", c.distance),
                          fmt::format("{:.3f}", c.p) + (c.counts_in_p ? "" : " (not counted)")});
  }
  return table;
}

PageTable verdict_table(const ReportedRealism& realism) {
  PageTable table{{"whether the surface passes for the target's", ""}, {}};
  for (const std::string& words : realism_words(realism.verdict, realism.lengths)) {
    table.rows.push_back({words, ""});
  }
  table.rows.push_back({"p of the whole, at least 0.05 to pass", fmt::format("{:.3f}", realism.verdict.p)});
  table.rows.push_back(
      {"largest distance, at most 0.13 to pass", fmt::format("{:.3f}", realism.verdict.largest_distance)});
  return table;
}

void add_realism(const TargetBody& target, const ReportedRealism& realism,
                 const std::filesystem::path& folder, ReportPage& page) {
  const std::string target_name = "target", fit_name = "fit";
  const NamedSurface a{target_name, target.surface, realism.target}, b{fit_name, realism.mesh, realism.fit};
  write_quantile_curves(a, b, folder / "quantile_curves.png");
  write_roughness_maps(a, b, folder / "roughness_maps.png");
  page.tables.push_back(verdict_table(realism));
  page.tables.push_back(realism_table(realism));
  page.pictures.push_back({"roughness_maps.png", "Roughness of target and fit from place to place."});
  page.pictures.push_back({"quantile_curves.png", "Local statistics of both surfaces."});
}

}  // namespace

void write_fit_report(const TargetBody& target, const ShapeFitResult& fit, const std::string& title,
                      const std::filesystem::path& folder, const ReportedRealism* realism,
                      const TriangleMesh* likeness) {
  make_output_folder(folder);
  write_target_and_fit(target, fit, folder / "target_and_fit.png");
  write_distance_map(target, fit, folder / "distance_map.png");
  write_error_histogram(sampled_distances(target, fit.check.mesh),
                        std::max(1.2 * fit.check.distance.p99, 1e-9), folder / "error_histogram.png");
  const std::string shown =
      fit.base_mesh.triangles.empty() ? "Target and fit" : "Target, metaballs alone and the whole fit";
  ReportPage page{title,
                  std::to_string(fit.body.num_metaballs()) + " metaballs, mean distance " +
                      percent(fit.check.distance.mean) + " of the bounding-box diagonal.",
                  surface_pairs(target, fit, likeness),
                  {distance_table(fit.check.distance), likeness_table(fit), body_table(target, fit)},
                  {{"target_and_fit.png", shown + ", from four sides, under the same sun."},
                   {"distance_map.png", "Distance from the fit to the target, on the fit."},
                   {"error_histogram.png", "How the distances are spread over the fit."}}};
  if (realism != nullptr) add_realism(target, *realism, folder, page);
  if (!fit.convergence.empty()) {
    write_convergence_plot(fit.convergence, folder / "convergence.png");
    page.pictures.push_back(
        {"convergence.png", "Mean distance over the samples of the refinement, after each of its stages."});
  }
  write_report_page(page, folder / "index.html");
}

std::vector<std::filesystem::path> fit_report_files(const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path folder : folders) {
    for (const char* name : {"index.html", "target_and_fit.png", "distance_map.png", "error_histogram.png",
                             "convergence.png", "quantile_curves.png", "roughness_maps.png"})
      files.push_back(folder / name);
  }
  return files;
}

}  // namespace astrolith
