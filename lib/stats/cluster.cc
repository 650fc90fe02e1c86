#include "stats/cluster.h"

#include <algorithm>
#include <utility>

namespace synpo {
namespace {

struct Cluster {
  size_t node;  // leaf or merge
  size_t row;   // of the distances; its lowest leaf
  size_t leaves;
  double weight;  // sum
  double mean() const { return weight / double(leaves); }
};

}  // namespace

std::vector<size_t> Dendrogram::order() const {
  std::vector<size_t> leaves_in_order, open = {2 * merges.size()};
  while (!open.empty()) {
    const size_t node = open.back();
    open.pop_back();
    if (node < leaves()) {
      leaves_in_order.push_back(node);
    } else {
      open.push_back(merges[node - leaves()].second);
      open.push_back(merges[node - leaves()].first);
    }
  }
  return leaves_in_order;
}

Dendrogram average_linkage(std::vector<double> distances, const std::vector<double>& weights) {
  const size_t n = weights.size();
  const auto distance = [&](const Cluster& a, const Cluster& b) -> double& { return distances[a.row * n + b.row]; };
  std::vector<Cluster> clusters;
  for (size_t leaf = 0; leaf < n; ++leaf) clusters.push_back({leaf, leaf, 1, weights[leaf]});
  Dendrogram tree;
  while (clusters.size() > 1) {
    size_t nearest_a = 0, nearest_b = 1;
    for (size_t a = 0; a < clusters.size(); ++a)
      for (size_t b = a + 1; b < clusters.size(); ++b)
        if (distance(clusters[a], clusters[b]) < distance(clusters[nearest_a], clusters[nearest_b])) {
          nearest_a = a;
          nearest_b = b;
        }
    Cluster& a = clusters[nearest_a];
    const Cluster b = clusters[nearest_b];
    // Rounding must not let a merge lie below those it joins.
    const double height = std::max(distance(a, b), tree.height());
    const bool a_first = a.mean() >= b.mean();
    tree.merges.push_back({a_first ? a.node : b.node, a_first ? b.node : a.node, height});
    for (const Cluster& other : clusters)
      if (other.row != a.row && other.row != b.row) {
        const double mean = (double(a.leaves) * distance(a, other) + double(b.leaves) * distance(b, other)) /
                            double(a.leaves + b.leaves);
        distance(a, other) = distance(other, a) = mean;
      }
    a = {n + tree.merges.size() - 1, a.row, a.leaves + b.leaves, a.weight + b.weight};
    clusters.erase(clusters.begin() + std::ptrdiff_t(nearest_b));
  }
  return tree;
}

}  // namespace synpo
