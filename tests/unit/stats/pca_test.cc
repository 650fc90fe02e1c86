#include "stats/pca.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/random.h"

namespace synpo {
namespace {

// Three points on the line (1, 2) + t (3, 4), at t = -1, 0, 4, so with t - 1 = -2, -1, 3 from their mean and a length
// of 5 for each unit.
const std::vector<double> kOnALine = {-2, -2, 1, 2, 13, 18};

TEST(Pca, OfALineByHand) {
  const Pca pca = principal_components(kOnALine, 3, 2, 2);
  EXPECT_NEAR(pca.axes[0], 0.6, 1e-12);
  EXPECT_NEAR(pca.axes[1], 0.8, 1e-12);
  const double along[] = {-10, -5, 15};
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(pca.scores[2 * row], along[row], 1e-12);
    EXPECT_NEAR(pca.scores[2 * row + 1], 0, 1e-12);
  }
  EXPECT_NEAR(pca.explained[0], 1, 1e-12);
  EXPECT_NEAR(pca.explained[1], 0, 1e-12);
}

// Corners (+-3, +-1) of a rectangle: variances 9 and 1.
TEST(Pca, OfARectangleByHand) {
  const Pca pca = principal_components({3, 1, 3, -1, -3, 1, -3, -1}, 4, 2, 2);
  EXPECT_NEAR(pca.explained[0], 0.9, 1e-12);
  EXPECT_NEAR(pca.explained[1], 0.1, 1e-12);
  EXPECT_NEAR(pca.scores[0], 3, 1e-12);
  EXPECT_NEAR(pca.scores[1], 1, 1e-12);
}

TEST(Pca, SignsComeFromTheAxesAndNotFromTheOrderOfTheRows) {
  const std::vector<double> backwards = {13, 18, 1, 2, -2, -2};
  const Pca pca = principal_components(kOnALine, 3, 2, 1), other = principal_components(backwards, 3, 2, 1);
  EXPECT_NEAR(pca.axes[0], other.axes[0], 1e-12);
  for (int row = 0; row < 3; ++row) EXPECT_NEAR(pca.scores[row], other.scores[2 - row], 1e-12);
}

TEST(Pca, AgreesWithTheEigenvectorsOfTheCovariance) {
  constexpr int kRows = 20, kColumns = 128;
  Random random(3, Purpose::kNoise);
  std::vector<double> values;
  for (int i = 0; i < kRows * kColumns; ++i) values.push_back(random.uniform() * (i % kColumns < 5 ? 10 : 1));
  const Pca pca = principal_components(values, kRows, kColumns, 2);

  Eigen::MatrixXd centred = Eigen::Map<Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>>(values.data());
  centred.rowwise() -= centred.colwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred);
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd axis = solver.eigenvectors().col(kColumns - 1 - k);
    EXPECT_NEAR(pca.explained[k], solver.eigenvalues()(kColumns - 1 - k) / solver.eigenvalues().sum(), 1e-10);
    double along = 0;
    for (int i = 0; i < kColumns; ++i) along += axis(i) * pca.axes[size_t(k) * kColumns + i];
    EXPECT_NEAR(std::abs(along), 1, 1e-8);
    for (int row = 0; row < kRows; ++row)
      EXPECT_NEAR(pca.scores[2 * row + k], centred.row(row).dot(axis) * along, 1e-8);
  }
}

TEST(Pca, OfEqualRowsAndOfFewerComponentsThanAskedForIsZero) {
  const Pca equal = principal_components({1, 2, 1, 2}, 2, 2, 2);
  EXPECT_EQ(equal.explained, (std::vector<double>{0, 0}));
  EXPECT_EQ(equal.scores, (std::vector<double>(4, 0)));
  const Pca one_column = principal_components({1, 2, 6}, 3, 1, 2);
  EXPECT_NEAR(one_column.explained[0], 1, 1e-12);
  EXPECT_EQ(one_column.explained[1], 0);
  EXPECT_NEAR(one_column.scores[4], 3, 1e-12);
}

}  // namespace
}  // namespace synpo
