// Converts feature vectors to a matrix of OpenCV.
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

#include "descriptor/classification/principal_components.h"

namespace astrolith {

// A matrix (#rows x #columns) of floats. Rows must be equally long.
inline cv::Mat row_matrix(const FeatureRows& rows) {
  cv::Mat matrix(static_cast<int>(rows.size()), static_cast<int>(rows.front().size()), CV_32F);
  for (int i = 0; i < matrix.rows; ++i) {
    std::copy(rows[static_cast<std::size_t>(i)].begin(), rows[static_cast<std::size_t>(i)].end(),
              matrix.ptr<float>(i));
  }
  return matrix;
}

}  // namespace astrolith
