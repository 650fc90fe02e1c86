#include "draw/plot/dendrogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "draw/canvas/ticks.h"
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

constexpr double kScaleSpacePt = 4, kScaleTickPt = 2.5, kScaleTextPt = 7, kBetweenLabelsPt = 3;
constexpr int kMostTicks = 3;

// Calls tick(at, label) with the distance from the leaves, in pixels.
template <class Tick>
void for_scale(const Dendrogram& tree, const Ticks& ticks, int depth, Tick tick) {
  for (const double at : ticks.at) tick(int(std::lround(at / tree.height() * depth)), tick_text(at, ticks.step));
}

}  // namespace

Ticks ticks_side_by_side(const Dendrogram& tree, int depth, const Font& font, const Pixels& px) {
  const Ticks ticks = nice_ticks(0, tree.height(), kMostTicks);
  int widest = 0;
  for (const double at : ticks.at) widest = std::max(widest, font.width(tick_text(at, ticks.step), px(kScaleTextPt)));
  const bool room = widest + px(kBetweenLabelsPt) <= ticks.step / tree.height() * depth;
  return room ? ticks : nice_ticks(0, tree.height(), 2);
}

int tree_scale_height(const Pixels& px) {
  return px(kScaleSpacePt) + px(kScaleTickPt) + px(2) + px(kScaleTextPt) * 5 / 4;
}

void draw_scale_beneath(Canvas& canvas, const Dendrogram& tree, int x, int y, int depth, int line, const Pixels& px) {
  if (tree.height() <= 1e-9) return;
  const int top = y + px(kScaleSpacePt), tick = px(kScaleTickPt);
  canvas.fill({x, top, depth, line}, kSoftInk);
  const Ticks ticks = ticks_side_by_side(tree, depth - line, canvas.font(), px);
  for_scale(tree, ticks, depth - line, [&](int at, const std::string& label) {
    canvas.fill({x + at, top, line, tick}, kSoftInk);
    canvas.text(x + at, top + tick + px(2), label, px(kScaleTextPt), kSoftInk, Across::kCentre);
  });
}

void draw_scale_left(Canvas& canvas, const Dendrogram& tree, int x, int y, int depth, int line, const Pixels& px) {
  if (tree.height() <= 1e-9) return;
  const int right = x - px(kScaleSpacePt), tick = px(kScaleTickPt);
  canvas.fill({right, y - depth, line, depth}, kSoftInk);
  for_scale(tree, nice_ticks(0, tree.height(), kMostTicks), depth - line, [&](int at, const std::string& label) {
    canvas.fill({right - tick, y - at - line, tick, line}, kSoftInk);
    canvas.text(right - tick - px(2), y - at, label, px(kScaleTextPt), kSoftInk, Across::kRight, Upright::kMiddle);
  });
}

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
