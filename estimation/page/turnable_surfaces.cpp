#include "estimation/page/turnable_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "estimation/page/page_internal.h"
#include "synthesis/picture/colormap.h"

namespace astrolith {
namespace {

// The cube into which both surfaces are put, so that steps of 16 bits reach its faces.
struct SceneCube {
  Vec3d center;
  double half_width;
};

SceneCube cube_around(const TurnableSurfaces& surfaces) {
  Box box = surfaces.left.mesh.bounds();
  for (const Vec3d& p : surfaces.right.mesh.vertices) box.extend(p);
  const Vec3d center = box.center(), half = box.max - center;
  const double half_width = std::max({half.x, half.y, half.z});
  if (!(half_width > 0.0)) throw std::invalid_argument("turnable surfaces without extent");
  return {center, half_width};
}

template <typename T>
void append(std::vector<std::uint8_t>& bytes, T value) {
  const std::size_t start = bytes.size();
  bytes.resize(start + sizeof value);
  std::memcpy(bytes.data() + start, &value, sizeof value);
}

std::string position_text(const TriangleMesh& mesh, const SceneCube& cube) {
  std::vector<std::uint8_t> bytes;
  for (const Vec3d& vertex : mesh.vertices) {
    const Vec3d p = (32767.0 / cube.half_width) * (vertex - cube.center);
    for (const double x : {p.x, p.y, p.z}) append(bytes, static_cast<std::int16_t>(std::lround(x)));
  }
  return base64(bytes);
}

std::string triangle_text(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> bytes;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) append(bytes, static_cast<std::uint16_t>(v));
  }
  return base64(bytes);
}

std::string surface_script(const TurnableSurface& surface, const SceneCube& cube) {
  std::string script = "{positions: \"" + position_text(surface.mesh, cube) + "\",\ntriangles: \"" +
                       triangle_text(surface.mesh) + "\"";
  if (!surface.rgb.empty()) script += ",\ncolors: \"" + base64(surface.rgb) + "\"";
  return script + "}";
}

std::string css_color(double t) {
  const Vec3<float> c = sequential_color(t);
  const auto part = [](float value) { return std::to_string(static_cast<int>(srgb_byte(value))); };
  return "rgb(" + part(c.x) + "," + part(c.y) + "," + part(c.z) + ")";
}

std::string scale_html(const TurnableSurfaces& surfaces) {
  if (surfaces.scale_caption.empty()) return "";
  std::string gradient;
  for (int k = 0; k <= 8; ++k) gradient += ", " + css_color(k / 8.0);
  return "<div class=\"scale\">" + escaped_html(surfaces.scale_low) +
         " <span style=\"background:linear-gradient(to right" + gradient + ")\"></span> " +
         escaped_html(surfaces.scale_high) + ", " + escaped_html(surfaces.scale_caption) + "</div>\n";
}

void check(const TurnableSurface& surface) {
  const std::size_t vertices = surface.mesh.vertices.size();
  if (vertices == 0 || vertices > kMostPageVertices) {
    throw std::invalid_argument("a page shows surfaces of 1 to " + std::to_string(kMostPageVertices) +
                                " vertices");
  }
  if (!surface.rgb.empty() && surface.rgb.size() != 3 * vertices) {
    throw std::invalid_argument("a page's surface needs one colour for each vertex");
  }
}

constexpr const char* kStyle =
    "<style>\n.turnable canvas { width: 100%; height: 31em; display: block; cursor: grab }\n"
    ".turnable .names { display: flex }\n.turnable .names span { flex: 1; text-align: center }\n"
    ".turnable .slider { width: 100% }\n.turnable label { margin-right: 2em }\n"
    ".turnable .scale span { display: inline-block; width: 10em; height: .8em }\n</style>\n";

std::string figure_html(const TurnableSurfaces& surfaces, const std::string& id) {
  check(surfaces.left);
  check(surfaces.right);
  const SceneCube cube = cube_around(surfaces);
  const bool colored = !surfaces.left.rgb.empty() || !surfaces.right.rgb.empty();
  std::string html =
      "<figure class=\"turnable\" id=\"" + id + "\" hidden>\n<canvas class=\"canvas\"></canvas>\n";
  html += "<input class=\"slider\" type=\"range\" aria-label=\"border between the surfaces\" hidden>\n";
  html += "<div class=\"names\"><span>" + escaped_html(surfaces.left.caption) + "</span><span>" +
          escaped_html(surfaces.right.caption) + "</span></div>\n" + scale_html(surfaces);
  html +=
      "<figcaption>Drag to turn both, and roll the wheel to come nearer.<br>\n"
      "<label><input class=\"overlaid\" type=\"checkbox\"> one over the other, with a slider between "
      "them</label>\n";
  html += std::string("<label") + (colored ? "" : " hidden") +
          "><input class=\"colored\" type=\"checkbox\" checked> colours</label></figcaption>\n</figure>\n";
  html += "<script>\nshowSurfaces(document.getElementById(\"" + id + "\"), [" +
          surface_script(surfaces.left, cube) + ",\n" + surface_script(surfaces.right, cube) +
          "]);\n</script>\n";
  return html;
}

}  // namespace

std::string turnable_surfaces_html(const std::vector<TurnableSurfaces>& pairs) {
  if (pairs.empty()) return "";
  std::string html = kStyle;
  html += "<script>" + std::string(three_script()) + "</script>\n<script>" + trackball_script() +
          "</script>\n<script>" + surface_viewer_script() + "</script>\n";
  for (std::size_t i = 0; i < pairs.size(); ++i)
    html += figure_html(pairs[i], "turnable" + std::to_string(i));
  return html;
}

}  // namespace astrolith
