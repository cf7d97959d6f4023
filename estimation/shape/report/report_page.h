// The page of a fit's report: figures as tables, pictures that lie beside it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace astrolith {

struct PagePicture {
  std::string file;     // beside the page
  std::string caption;  // what it shows
};

struct PageTable {
  std::vector<std::string> head;               // one a column
  std::vector<std::vector<std::string>> rows;  // as long as the head
};

struct ReportPage {
  std::string title;
  std::string summary;  // a sentence
  std::vector<PageTable> tables;
  std::vector<PagePicture> pictures;
};

// One HTML file that needs nothing but its pictures. Text is escaped. Throws as OutputFile does.
void write_report_page(const ReportPage& page, const std::filesystem::path& file);

}  // namespace astrolith
