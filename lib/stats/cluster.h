// Hierarchical clustering.
#pragma once
#include <cstddef>
#include <vector>

namespace synpo {

// A tree over leaves 0 to n - 1. The branches of a merge are leaves, or earlier merges, n being the first.
struct Dendrogram {
  struct Merge {
    size_t first, second;
    double height;  // the distance between the two; never less than within either
  };
  std::vector<Merge> merges;  // n - 1 of them, lowest first
  size_t leaves() const { return merges.size() + 1; }
  double height() const { return merges.empty() ? 0 : merges.back().height; }
  // The leaves from one end of the tree to the other: at each merge those of its first branch come first.
  std::vector<size_t> order() const;
};

// Average linkage (UPGMA; Sokal and Michener 1958): the two clusters whose members are nearest on average are merged,
// and so on. Of merges equally near the one that holds the lowest leaf comes first. The first branch is the one with
// the higher mean of `weights`, else the one that holds the lower leaf. `distances` [n, n] is symmetric, without NaN; n
// >= 1.
Dendrogram average_linkage(std::vector<double> distances, const std::vector<double>& weights);

}  // namespace synpo
