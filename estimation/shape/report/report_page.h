// The HTML page of a fit's report, with tables and with pictures that lie beside the page.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace astrolith {

struct PagePicture {
  std::string file;  // name of a file in the folder of the page
  std::string caption;
};

struct PageTable {
  std::vector<std::string> head;               // one text per column
  std::vector<std::vector<std::string>> rows;  // each as long as the head
};

struct ReportPage {
  std::string title;
  std::string summary;  // one sentence
  std::vector<PageTable> tables;
  std::vector<PagePicture> pictures;
};

// Writes one HTML file that needs nothing but its pictures. Text is escaped. Throws as OutputFile does.
void write_report_page(const ReportPage& page, const std::filesystem::path& file);

}  // namespace astrolith
