// The HTML page of a report: one file that needs no other, with tables, pictures and surfaces to turn.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "estimation/page/turnable_surfaces.h"

namespace astrolith {

struct PagePicture {
  std::string file;  // name of a PNG file in the folder of the page, which takes a copy of it
  std::string caption;
};

struct PageTable {
  std::vector<std::string> head;               // one text per column
  std::vector<std::vector<std::string>> rows;  // each as long as the head
};

struct ReportPage {
  std::string title;
  std::string summary;                     // one sentence
  std::vector<TurnableSurfaces> surfaces;  // pairs
  std::vector<PageTable> tables;
  std::vector<PagePicture> pictures;
};

// Writes the page. Text is escaped. Throws InputError where a picture cannot be read, and as OutputFile does.
void write_report_page(const ReportPage& page, const std::filesystem::path& file);

}  // namespace astrolith
