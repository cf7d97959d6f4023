#include "descriptor/classification/principal_components.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>

#include "descriptor/classification/row_matrix_internal.h"
#include "numerics/errors.h"

namespace astrolith {

std::vector<float> PrincipalComponents::apply(std::span<const float> features) const {
  std::vector<float> result;
  result.reserve(axes.size());
  for (const std::vector<float>& axis : axes) {
    double sum = 0;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      sum += static_cast<double>(axis[i]) * (static_cast<double>(features[i]) - static_cast<double>(mean[i]));
    }
    result.push_back(static_cast<float>(sum));
  }
  return result;
}

PrincipalComponents principal_components(const FeatureRows& rows, int components) {
  const std::size_t most = rows.empty() ? 0 : std::min(rows.size() - 1, rows.front().size());
  if (components < 1 || static_cast<std::size_t>(components) > most) {
    throw InputError("principal components: " + std::to_string(components) + " of " +
                     std::to_string(rows.size()) + " shapes; give between 1 and " + std::to_string(most));
  }
  const cv::PCA pca(row_matrix(rows), cv::noArray(), cv::PCA::DATA_AS_ROW, components);
  PrincipalComponents result;
  result.mean.assign(pca.mean.begin<float>(), pca.mean.end<float>());
  for (int i = 0; i < pca.eigenvectors.rows; ++i) {
    const cv::Mat axis = pca.eigenvectors.row(i);
    result.axes.emplace_back(axis.begin<float>(), axis.end<float>());
  }
  return result;
}

}  // namespace astrolith
