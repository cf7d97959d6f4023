// The HTML page of a report: one file that needs no other, with tables, pictures and surfaces to turn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// The most vertices of a surface in a page; decimated (geometry/surface/decimated_mesh.h) brings larger
// meshes below it. Indices then take 16 bits, and a page of two surfaces takes about 3 MB.
inline constexpr std::size_t kMostPageVertices = 60000;

struct TurnableSurface {
  std::string caption;
  TriangleMesh mesh;              // at most kMostPageVertices vertices
  std::vector<std::uint8_t> rgb;  // (#V x 3) sRGB, or empty: grey
};

// Both surfaces have the same unit and frame, so that they lie over each other.
struct TurnableSurfaces {
  TurnableSurface left, right;
  // What the colours from sequential_color(0) to sequential_color(1) (synthesis/picture/colormap.h) stand
  // for. Left empty where the colours are the surfaces' own.
  std::string scale_caption, scale_low, scale_high;
};

// A figure of each pair for a page of HTML, with their viewer, which the page fetches from nowhere; nothing
// without pairs. Figures stay hidden without scripts or WebGL. Throws std::invalid_argument
// for surfaces that are empty or too large.
std::string turnable_surfaces_html(const std::vector<TurnableSurfaces>& pairs);

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
