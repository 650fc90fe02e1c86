#include <gtest/gtest.h>

#include "stats/cluster.h"

namespace synpo {
namespace {

using Order = std::vector<size_t>;

TEST(Cluster, ByHand) {
  // 0 and 1 are 2 apart; both are 4 from 2; 3 is 10, 8 and 6 from the others, 8 on average over the three.
  const std::vector<double> distances = {0,  2, 4, 10,  //
                                         2,  0, 4, 8,   //
                                         4,  4, 0, 6,   //
                                         10, 8, 6, 0};
  const Dendrogram tree = average_linkage(distances, {0.1, 0.9, 0.2, 0.3});
  ASSERT_EQ(tree.merges.size(), 3u);
  const Dendrogram::Merge expected[] = {{1, 0, 2}, {4, 2, 4}, {5, 3, 8}};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(tree.merges[i].first, expected[i].first) << i;
    EXPECT_EQ(tree.merges[i].second, expected[i].second) << i;
    EXPECT_DOUBLE_EQ(tree.merges[i].height, expected[i].height) << i;
  }
  EXPECT_EQ(tree.leaves(), 4u);
  EXPECT_DOUBLE_EQ(tree.height(), 8);
  EXPECT_EQ(tree.order(), (Order{1, 0, 2, 3}));
  // Whichever has the higher mean comes first: 0.9 against the 0.4 of the three.
  EXPECT_EQ(average_linkage(distances, {0.1, 0.9, 0.2, 0.9}).order(), (Order{3, 1, 0, 2}));
}

TEST(Cluster, TiesGoToTheLowestLeaf) {
  EXPECT_EQ(average_linkage(std::vector<double>(25, 1.0), std::vector<double>(5, 0.5)).order(), (Order{0, 1, 2, 3, 4}));
  // 1 and 2 are as near as 0 and 3.
  EXPECT_EQ(average_linkage({0, 5, 5, 1, 5, 0, 1, 5, 5, 1, 0, 5, 1, 5, 5, 0}, std::vector<double>(4, 0.5)).order(),
            (Order{0, 3, 1, 2}));
}

TEST(Cluster, OneLeafIsATree) {
  const Dendrogram tree = average_linkage({0}, {0.5});
  EXPECT_TRUE(tree.merges.empty());
  EXPECT_EQ(tree.height(), 0);
  EXPECT_EQ(tree.order(), Order{0});
}

TEST(Cluster, HeightsNeverFallAndEveryLeafStandsOnce) {
  constexpr size_t kLeaves = 40;
  std::vector<double> distances(kLeaves * kLeaves), weights;
  for (size_t i = 0; i < kLeaves; ++i) {
    weights.push_back(double(i * 7 % 11));
    for (size_t k = 0; k < i; ++k)
      distances[i * kLeaves + k] = distances[k * kLeaves + i] = double((i * 31 + k * 17) % 53) / 53;
  }
  const Dendrogram tree = average_linkage(distances, weights);
  for (size_t i = 1; i < tree.merges.size(); ++i) EXPECT_GE(tree.merges[i].height, tree.merges[i - 1].height);
  std::vector<int> times(kLeaves);
  for (const size_t leaf : tree.order()) ++times[leaf];
  EXPECT_EQ(times, std::vector<int>(kLeaves, 1));
}

}  // namespace
}  // namespace synpo
