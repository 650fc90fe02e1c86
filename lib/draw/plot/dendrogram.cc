#include "draw/plot/dendrogram.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "draw/colour.h"

namespace synpo {
namespace {

// Calls stem(along, from, to) for each line away from the leaves, and bar(from, to, height) for each line across, in
// pixels.
template <class Stem, class Bar>
void for_branches(const Dendrogram& tree, int pitch, int depth, Stem stem, Bar bar) {
  struct Node {
    double along, height;
  };
  std::vector<Node> nodes(tree.leaves());
  const std::vector<size_t> order = tree.order();
  for (size_t i = 0; i < order.size(); ++i) nodes[order[i]] = {double(i) * pitch, 0};
  const auto pixel = [](double value) { return int(std::lround(value)); };
  for (const Dendrogram::Merge& merge : tree.merges) {
    const double height = tree.height() > 0 ? merge.height / tree.height() * depth : 0;
    const Node first = nodes[merge.first], second = nodes[merge.second];
    for (const Node& branch : {first, second}) stem(pixel(branch.along), pixel(branch.height), pixel(height));
    bar(pixel(first.along), pixel(second.along), pixel(height));
    nodes.push_back({(first.along + second.along) / 2, height});
  }
}

}  // namespace

void draw_tree_right(Canvas& canvas, const Dendrogram& tree, int x, int y, int pitch, int depth, int line) {
  for_branches(
      tree, pitch, depth - line,
      [&](int along, int from, int to) {
        canvas.fill({x + from, y + along, to - from, line}, kSoftInk);
      },
      [&](int from, int to, int height) {
        canvas.fill({x + height, y + from, line, to - from + line}, kSoftInk);
      });
}

void draw_tree_up(Canvas& canvas, const Dendrogram& tree, int x, int y, int pitch, int depth, int line) {
  for_branches(
      tree, pitch, depth - line,
      [&](int along, int from, int to) {
        canvas.fill({x + along, y - to, line, to - from}, kSoftInk);
      },
      [&](int from, int to, int height) {
        canvas.fill({x + from, y - height - line, to - from + line, line}, kSoftInk);
      });
}

}  // namespace synpo
