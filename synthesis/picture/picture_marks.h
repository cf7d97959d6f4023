// What a picture says beside its views: which colour stands for which number, how long lengths are, and where
// the axes of the mesh point.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// The colours of sequential_color() from `low` to `high`.
struct ValueScale {
  double low = 0.0, high = 1.0;
  std::string title;  // quantity and unit, such as "slope [deg]"
};

// The 1st and 99th percentile of the values and their extremes, NaN left out. The percentiles differ: the
// upper one is raised by 1 where all values are alike. A few extremes would leave all other values one
// colour.
struct ValueRange {
  double low = 0.0, high = 1.0, least = 0.0, most = 0.0;
};
ValueRange value_range(std::span<const double> values);

// "slope [deg]" for the column slope_deg, "effective gravity [m/s2]" for effective_gravity_m_s2; names
// without a known unit keep their words.
std::string column_title(const std::string& name);

// A word beside a place of the mesh, in the views that see the place.
struct PlaceLabel {
  Vec3d place;  // in lengths of the mesh
  std::string text;
};

// A circle, laid on the ground along its normal, and drawn where the views see that.
struct PlaceRing {
  Vec3d center, normal;  // in lengths of the mesh; the normal has unit length and looks outwards
  double radius = 0.0;
  double shade = 1.0;  // of its colour, 0 (dark) to 1
};

struct PreviewOptions;

struct PictureMarks {
  std::optional<ValueScale> values;  // a bar below the views
  // The unit of the mesh's lengths, for a scale below orthographic views; none where absent, a plain number
  // where empty.
  std::optional<std::string> length_unit;
  std::vector<PlaceLabel> labels;
  std::vector<PlaceRing> rings;
  bool axes = false;     // x, y and z in a corner of each view that shows nothing else; the degrees of maps
  bool letters = false;  // (a), (b) ... in the upper left corners of the views
};

// Rows below the views that the marks take of a picture: none where nothing stands there, and for pictures
// under 160 x 120 pixels, which have no marks.
int marks_height(const PreviewOptions& options);

}  // namespace astrolith
