// The page that the report's plots share: 8 x 5 inches, 1600 x 1000 pixels.
#pragma once

#include "estimation/plot/figure.h"

namespace astrolith {

inline constexpr double kPlotWidth = 576.0, kPlotHeight = 360.0;  // points
inline constexpr double kPlotPixelsPerInch = 200.0;
inline constexpr Rectangle kPlotDiagram{54.0, 36.0, 500.0, 284.0};
inline constexpr Ink kPlotCurve{0.16, 0.35, 0.63};

// An empty page with a headline above the diagram.
inline Figure plot_page(const std::string& headline) {
  Figure page(kPlotWidth, kPlotHeight);
  page.text(kPlotDiagram.x, 22.0, headline, 10.0);
  return page;
}

}  // namespace astrolith
