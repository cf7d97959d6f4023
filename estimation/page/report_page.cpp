#include "estimation/page/report_page.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "estimation/page/page_internal.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
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
  std::string html = "<figure class=\"turnable\" id=\"" + id +
                     "\" hidden>\n<canvas class=\"canvas\" tabindex=\"0\" aria-label=\"both surfaces; arrow "
                     "keys turn them\"></canvas>\n";
  html += "<input class=\"slider\" type=\"range\" aria-label=\"border between the surfaces\" hidden>\n";
  html += "<div class=\"names\"><span>" + escaped_html(surfaces.left.caption) + "</span><span>" +
          escaped_html(surfaces.right.caption) + "</span></div>\n" + scale_html(surfaces);
  html +=
      "<figcaption>Drag to turn both, with the right button to move the sun, and roll the wheel to come "
      "nearer.<br>\n"
      "<label><input class=\"overlaid\" type=\"checkbox\"> one over the other, with a slider between "
      "them</label>\n";
  html += std::string("<label") + (colored ? "" : " hidden") +
          "><input class=\"colored\" type=\"checkbox\" checked> colours</label></figcaption>\n</figure>\n";
  html += "<script>\nshowSurfaces(document.getElementById(\"" + id + "\"), [" +
          surface_script(surfaces.left, cube) + ",\n" + surface_script(surfaces.right, cube) +
          "]);\n</script>\n";
  return html;
}

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<style>\n"
    "body { font: 16px/1.5 sans-serif; color: #222; max-width: 62em; margin: 2em auto; padding: 0 1em }\n"
    "img { max-width: 100%; display: block }\nfigure { margin: 2em 0 }\nfigcaption { color: #555 }\n"
    "table { border-collapse: collapse; margin: 1.5em 0 }\n"
    "th, td { text-align: left; padding: .2em 1.2em .2em 0; border-bottom: 1px solid #ddd }\n"
    "td { font-variant-numeric: tabular-nums }\n</style>\n";

std::string picture_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  if (bytes.empty()) throw InputError(file.string() + ": cannot be read for the report; free its folder");
  return base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

std::string figure_html(const PagePicture& picture, const std::filesystem::path& folder) {
  const std::string caption = escaped_html(picture.caption);
  return "<figure><img src=\"data:image/png;base64," + picture_text(folder / picture.file) + "\" alt=\"" +
         caption + "\"><figcaption>" + caption + "</figcaption></figure>\n";
}

std::string row(const std::vector<std::string>& cells, const std::string& tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += "<" + tag + ">" + escaped_html(cell) + "</" + tag + ">";
  return text + "</tr>\n";
}

}  // namespace

std::string turnable_surfaces_html(const std::vector<TurnableSurfaces>& pairs) {
  if (pairs.empty()) return "";
  std::string html = kStyle;
  html += "<script>" + std::string(surface_viewer_script()) + "</script>\n";
  for (std::size_t i = 0; i < pairs.size(); ++i)
    html += figure_html(pairs[i], "turnable" + std::to_string(i));
  return html;
}

void write_report_page(const ReportPage& page, const std::filesystem::path& file) {
  std::string html = kHead;
  html += "<title>" + escaped_html(page.title) + "</title>\n</head>\n<body>\n<h1>" +
          escaped_html(page.title) + "</h1>\n";
  html += "<p>" + escaped_html(page.summary) + "</p>\n";
  html += turnable_surfaces_html(page.surfaces);
  for (const PagePicture& picture : page.pictures) html += figure_html(picture, file.parent_path());
  for (const PageTable& table : page.tables) {
    html += "<table>\n" + row(table.head, "th");
    for (const std::vector<std::string>& cells : table.rows) html += row(cells, "td");
    html += "</table>\n";
  }
  html += "</body>\n</html>\n";
  write_file(file, html);
}

std::string escaped_html(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  // OpenSSL counts in int: pieces of a multiple of three bytes need no padding between them.
  constexpr std::size_t kPiece = std::size_t{3} << 20;
  std::string text;
  for (std::size_t start = 0; start < bytes.size(); start += kPiece) {
    const std::size_t count = std::min(kPiece, bytes.size() - start);
    std::string piece(4 * ((count + 2) / 3) + 1, '\0');  // and OpenSSL's final zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(piece.data()), bytes.data() + start,
                    static_cast<int>(count));
    piece.pop_back();
    text += piece;
  }
  return text;
}

}  // namespace astrolith
