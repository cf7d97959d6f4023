#include "estimation/shape/report/report_page.h"

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

std::string escaped(const std::string& text) {
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

std::string row(const std::vector<std::string>& cells, const std::string& tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += "<" + tag + ">" + escaped(cell) + "</" + tag + ">";
  return text + "</tr>\n";
}

}  // namespace

void write_report_page(const ReportPage& page, const std::filesystem::path& file) {
  std::string html = kHead;
  html +=
      "<title>" + escaped(page.title) + "</title>\n</head>\n<body>\n<h1>" + escaped(page.title) + "</h1>\n";
  html += "<p>" + escaped(page.summary) + "</p>\n";
  for (const PagePicture& picture : page.pictures) {
    html += "<figure><img src=\"" + escaped(picture.file) + "\" alt=\"" + escaped(picture.caption) +
            "\"><figcaption>" + escaped(picture.caption) + "</figcaption></figure>\n";
  }
  for (const PageTable& table : page.tables) {
    html += "<table>\n" + row(table.head, "th");
    for (const std::vector<std::string>& cells : table.rows) html += row(cells, "td");
    html += "</table>\n";
  }
  html += "</body>\n</html>\n";
  OutputFile output(file);
  output.write(html.data(), html.size());
  output.commit();
}

}  // namespace astrolith
