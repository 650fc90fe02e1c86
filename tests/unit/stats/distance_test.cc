#include "stats/distance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace synpo {
namespace {

TEST(Distances, ByHand) {
  const std::vector<double> rows = {3, 4, 6, 8, -4, 3, -3, -4, 0, 0};
  const std::vector<double> cosine = distances(rows, 5, 2, Distance::kCosine),
                            euclidean = distances(rows, 5, 2, Distance::kEuclidean);
  EXPECT_NEAR(cosine[1], 0, 1e-15);
  EXPECT_NEAR(cosine[2], 1, 1e-15);
  EXPECT_NEAR(cosine[3], 2, 1e-15);
  EXPECT_EQ(cosine[4], 1);
  EXPECT_EQ(euclidean[1], 5);
  EXPECT_EQ(euclidean[3], 10);
  EXPECT_EQ(euclidean[4], 5);
  for (int a = 0; a < 5; ++a) {
    EXPECT_EQ(cosine[6 * a], 0);
    for (int b = 0; b < 5; ++b) EXPECT_EQ(euclidean[5 * a + b], euclidean[5 * b + a]);
  }
  EXPECT_EQ(distances({0, 0, 0, 0}, 2, 2, Distance::kCosine), (std::vector<double>(4, 0)));
}

}  // namespace
}  // namespace synpo
