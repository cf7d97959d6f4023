#include "estimation/gabor/texture_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace astrolith {
namespace {

constexpr int kReliefSide = 240;        // vertices along a side; 240 x 240 stay below kMostPageVertices
constexpr double kReliefHeight = 0.05;  // from black to white, of the side

struct Rgb {
  double red = 0.0, green = 0.0, blue = 0.0;  // 0 .. 255
  double grey() const { return (red + green + blue) / 3.0; }
};

// The mean of a square of pixels.
Rgb mean_color(const ReportPicture& picture, int x, int y, int side) {
  Rgb sum;
  for (int row = y; row < y + side; ++row) {
    for (int column = x; column < x + side; ++column) {
      const std::size_t i = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                                 static_cast<std::size_t>(column));
      sum.red += picture.rgb[i];
      sum.green += picture.rgb[i + 1];
      sum.blue += picture.rgb[i + 2];
    }
  }
  const double pixels = static_cast<double>(side) * side;
  return {sum.red / pixels, sum.green / pixels, sum.blue / pixels};
}

// The middle of the picture as a relief in the plane of x and z, which looks along -y. Lengths are vertices.
TurnableSurface relief(const ReportPicture& picture, const std::string& caption) {
  const int shorter = std::min(picture.width, picture.height);
  const int pixels = std::max(1, shorter / (2 * kReliefSide));  // a vertex shows pixels x pixels of them
  const int side = std::min(kReliefSide, shorter / pixels);
  const int left = (picture.width - side * pixels) / 2, top = (picture.height - side * pixels) / 2;
  TurnableSurface surface{caption, {}, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Rgb color = mean_color(picture, left + x * pixels, top + y * pixels, pixels);
      const double height = kReliefHeight * side * (color.grey() / 255.0 - 0.5);
      surface.mesh.vertices.push_back({static_cast<double>(x), -height, static_cast<double>(side - 1 - y)});
      for (const double part : {color.red, color.green, color.blue}) {
        surface.rgb.push_back(static_cast<std::uint8_t>(part + 0.5));
      }
    }
  }
  const auto n = static_cast<std::uint32_t>(side);
  for (std::uint32_t y = 0; y + 1 < n; ++y) {
    for (std::uint32_t x = 0; x + 1 < n; ++x) {
      const std::uint32_t corner = y * n + x;
      surface.mesh.triangles.push_back({corner, corner + n, corner + 1});
      surface.mesh.triangles.push_back({corner + 1, corner + n, corner + n + 1});
    }
  }
  return surface;
}

}  // namespace

PageTable choice_table(const ModelChoice& choice) {
  PageTable table{{"difference from unseen squares", "values", "filters", "sum", "scatter of the sum"}, {}};
  const auto add = [&](std::string name, const HeldOutScore& score) {
    table.rows.push_back({std::move(name), fmt::format("{:.3f}", score.mean.values),
                          fmt::format("{:.3f}", score.mean.filters), fmt::format("{:.3f}", score.mean.sum()),
                          fmt::format("{:.3f}", score.scatter)});
  };
  for (const TextureModel model : kTextureModels) {
    add(fmt::format("{}{}", model_word(model), model == choice.taken ? " (taken)" : ""),
        choice.scores[static_cast<std::size_t>(model)]);
  }
  add("the photo's own squares", choice.photo);
  return table;
}

PageTable lobe_table(const FittedChannel& channel) {
  const GaborFit& fit = channel.fit;
  const LobeQuality& quality = fit.quality;
  return {{"fit", ""},
          {{"lobes", std::to_string(fit.lobes.size())},
           {"distance from the photo's true spectrum, 0 is perfect",
            fmt::format("{:.3f}; a fit is weak above {:.3f}", quality.residual, quality.weak_above)},
           {"variance in the right octave", fmt::format("{:.1f} %", 100.0 * quality.band_overlap)},
           {"photo's pixels, width x height",
            fmt::format("{} x {}", channel.exemplar.width, channel.exemplar.height)}}};
}

PageTable gaussianity_table(const Gaussianity& g) {
  const auto row = [](const char* name, double value, const char* gaussian) {
    return std::vector<std::string>{name, fmt::format("{:.2f}", value), gaussian};
  };
  return {{"can noise be this photo?", "photo", "Gaussian texture"},
          {row("skewness of the grey values", g.skewness, "0"),
           row("excess kurtosis of the grey values", g.excess_kurtosis, "0"),
           row("excess kurtosis of differences (edges)", g.edge_kurtosis, "0"),
           row("spread of the variance over the photo", g.variance_spread, "1"),
           row("chance that a Gaussian texture is as unusual", g.p_value, "above 0.05")}};
}

void write_texture_page(const TextureReport& report, const std::string& layer, const std::string& verdict,
                        std::vector<PageTable> tables, const std::filesystem::path& folder) {
  const TurnableSurfaces reliefs{relief(report.photo, "photo"), relief(report.texture, layer), "", "", ""};
  write_report_page({report.title,
                     verdict,
                     {reliefs},
                     std::move(tables),
                     {{"report.png", "Photo and texture, and the spectra of both."}}},
                    folder / "index.html");
}

}  // namespace astrolith
