#include "stats/pca.h"

#include <Eigen/SVD>
#include <algorithm>

namespace synpo {

Pca principal_components(const std::vector<double>& values, int rows, int columns, int components) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix centred = Eigen::Map<const Matrix>(values.data(), rows, columns);
  centred.rowwise() -= centred.colwise().mean().eval();
  const Eigen::JacobiSVD<Matrix, Eigen::HouseholderQRPreconditioner> svd(centred,
                                                                         Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& singular = svd.singularValues();
  const double variance = singular.squaredNorm();

  Pca out;
  out.scores.resize(size_t(rows) * components);
  out.axes.resize(size_t(components) * columns);
  out.explained.resize(components);
  for (int k = 0; k < std::min(components, int(singular.size())); ++k) {
    const auto axis = svd.matrixV().col(k);
    Eigen::Index largest;
    axis.cwiseAbs().maxCoeff(&largest);
    const double sign = axis(largest) < 0 ? -1 : 1;
    for (int column = 0; column < columns; ++column) out.axes[size_t(k) * columns + column] = sign * axis(column);
    for (int row = 0; row < rows; ++row)
      out.scores[size_t(row) * components + k] = sign * svd.matrixU()(row, k) * singular(k);
    out.explained[k] = variance > 0 ? singular(k) * singular(k) / variance : 0;
  }
  return out;
}

}  // namespace synpo
