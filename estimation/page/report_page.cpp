#include "estimation/page/report_page.h"

#include <cstdint>
#include <fstream>
#include <iterator>

#include "estimation/page/page_internal.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"

namespace astrolith {
namespace {

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

}  // namespace astrolith
