#include "draw/plot/embedding_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/ticks.h"
#include "draw/colour.h"
#include "draw/plot/axes.h"
#include "draw/plot/labels.h"
#include "stats/pca.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

constexpr double kMarginPt = 12, kBetweenPt = 22, kNamePt = 7.5, kSmallestPt = 4.5;
constexpr double kPlotPt = 270, kMatrixPt = 300, kLargestCellPt = 30, kBarPt = 9, kBarTextPt = 8.5;
constexpr int kMostTicks = 8;
constexpr Rgb kDot = {0, 114, 178};

void check(const std::vector<Embeddings>& panels) {
  for (const Embeddings& panel : panels)
    if (panel.names.size() < 2) fail(Exit::kData, "fewer than two ", panel.title, ": nothing to compare");
}

void draw_dot(Canvas& canvas, const Box& box) { canvas.disc(box.centre(), box.width * 0.36, kDot); }

void draw_marker(Canvas& canvas, const Box& box, const Embeddings& panel, size_t i) {
  if (panel.marks.empty())
    draw_dot(canvas, box);
  else
    panel.marks[i](canvas, box);
}

// Axes with one unit, around the scores.
Axes score_axes(const Pca& pca, double scale, const Font& font) {
  double low[2], high[2], span = 0;
  for (int k = 0; k < 2; ++k) {
    low[k] = std::numeric_limits<double>::infinity();
    high[k] = -low[k];
    for (size_t i = size_t(k); i < pca.scores.size(); i += 2) {
      low[k] = std::min(low[k], pca.scores[i]);
      high[k] = std::max(high[k], pca.scores[i]);
    }
    span = std::max(span, high[k] - low[k]);
  }
  if (span <= 0) span = 1;  // all points are one
  const auto axis = [&](int k) {
    const double middle = (low[k] + high[k]) / 2, half = 0.58 * span;
    return Axis{middle - half, middle + half, 1,
                concat("component ", k + 1, " (", percent(pca.explained[k]), " % of the variance)")};
  };
  return Axes(axis(0), axis(1), scale, font);
}

void draw_scores(Canvas& canvas, const Box& plot, const Embeddings& panel, const Pca& pca, const Axes& axes,
                 const Pixels& px) {
  axes.draw(canvas, plot);
  axes.frame(canvas, plot);
  const int side = px(panel.marks.empty() ? 7 : 9), size = px(kNamePt);
  std::vector<LabelledPoint> points;
  const std::vector<std::string> names = canvas.font().fitted_apart(panel.names, size, plot.width / 3);
  for (size_t i = 0; i < panel.names.size(); ++i) {
    const Point at = axes.place(plot, pca.scores[2 * i], pca.scores[2 * i + 1]);
    points.push_back({{int(std::lround(at.x)) - side / 2, int(std::lround(at.y)) - side / 2, side, side}, names[i]});
  }
  const std::vector<Box> labels = place_labels(points, size, plot, canvas.font());
  for (size_t i = 0; i < points.size(); ++i) draw_marker(canvas, points[i].marker, panel, i);
  for (size_t i = 0; i < points.size(); ++i)
    canvas.text(labels[i].x + labels[i].width / 2, labels[i].y + labels[i].height / 2, points[i].name, size, kInk,
                Across::kCentre, Upright::kMiddle);
}

// Sizes of one matrix of distances, in pixels.
struct MatrixPlan {
  int cell, name_size, names, marker, value_size, bar_labels;  // `names` and `bar_labels`: room for the longest
  std::vector<double> values;
  Axis bar;
  int side(const Embeddings& panel) const { return cell * int(panel.names.size()); }
  int before() const { return names + marker; }
};

MatrixPlan plan_matrix(const Embeddings& panel, Distance kind, const Pixels& px, const Font& font) {
  MatrixPlan plan{};
  const int count = int(panel.names.size());
  plan.cell = px(std::min(kLargestCellPt, kMatrixPt / count));
  plan.name_size = std::clamp(plan.cell * 5 / 6, px(kSmallestPt), px(kNamePt));
  for (const std::string& name : panel.names) plan.names = std::max(plan.names, font.width(name, plan.name_size));
  plan.names = std::min(plan.names, px(100)) + px(4);
  plan.marker = panel.marks.empty() ? 0 : std::min(plan.cell, px(9)) + px(3);
  plan.values = distances(panel.values, count, panel.size, kind);
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (int i = 0; i < count * count; ++i)
    if (i / count != i % count) {
      low = std::min(low, plan.values[i]);
      high = std::max(high, plan.values[i]);
    }
  plan.bar = high > 0 ? value_axis("", low, high, kMostTicks) : Axis{0, 1, 1, ""};
  const Ticks ticks = plan.bar.ticks(kMostTicks);
  for (const double at : ticks.at)
    plan.bar_labels = std::max(plan.bar_labels, font.width(plan.bar.label(at, ticks), px(kBarTextPt)));
  plan.value_size = px(kNamePt);
  while (plan.value_size >= px(kSmallestPt) && font.width("0.88", plan.value_size) > plan.cell - px(2))
    --plan.value_size;
  if (plan.value_size < px(kSmallestPt)) plan.value_size = 0;
  return plan;
}

// Near is dark. `share` of the way from the nearest to the farthest.
Rgb distance_colour(double share) { return ramp_colour(find_scheme("safe").seen, 1 - share); }

void draw_distances(Canvas& canvas, int x, int y, const Embeddings& panel, const MatrixPlan& plan, const Pixels& px) {
  const int count = int(panel.names.size()), side = plan.side(panel), cell = plan.cell,
            gap = cell >= px(8) ? px(0.75) : 0;
  const int left = x + plan.before(), below = y + side + px(3), marker = plan.marker - px(3);
  const std::vector<std::string> names = canvas.font().fitted_apart(panel.names, plan.name_size, plan.names - px(4));
  for (int i = 0; i < count; ++i) {
    const std::string& name = names[size_t(i)];
    const int middle = i * cell + cell / 2;
    canvas.text(x + plan.names - px(4), y + middle, name, plan.name_size, kInk, Across::kRight, Upright::kMiddle);
    canvas.text_up(left + middle, below + plan.marker, name, plan.name_size, kInk, Across::kRight);
    if (panel.marks.empty()) continue;
    panel.marks[i](canvas, {x + plan.names - px(1), y + middle - marker / 2, marker, marker});
    panel.marks[i](canvas, {left + middle - marker / 2, below - px(1), marker, marker});
  }
  // Beneath cells without a gap, lest seams between them show.
  if (gap == 0) {
    std::vector<Rgb> colours;
    for (int i = 0; i < count * count; ++i)
      colours.push_back(i / count == i % count ? kPaper : distance_colour(plan.bar.place(plan.values[size_t(i)])));
    canvas.squares(left, y, cell, count, colours);
  }
  for (int row = 0; row < count; ++row)
    for (int column = 0; column < count; ++column) {
      if (row == column) continue;
      const double value = plan.values[size_t(row) * count + column];
      const Box box = {left + column * cell, y + row * cell, cell - gap, cell - gap};
      const Rgb ground = distance_colour(plan.bar.place(value));
      canvas.fill(box, ground);
      if (plan.value_size > 0)
        canvas.text(box.x + box.width / 2, box.y + box.height / 2, decimal(value, value < 9.995 ? 2 : 1),
                    plan.value_size, ink_on(ground), Across::kCentre, Upright::kMiddle);
    }
  const Box bar = {left + side + px(10), y, px(kBarPt), side};
  canvas.shades(bar, [](double share) { return distance_colour(1 - share); });
  const Ticks ticks = plan.bar.ticks(kMostTicks);
  for (const double at : ticks.at) {
    const int tick = bar.bottom() - int(std::lround(plan.bar.place(at) * bar.height));
    canvas.fill({bar.right(), tick, px(3), px(0.6)}, kSoftInk);
    canvas.text(bar.right() + px(5), tick, plan.bar.label(at, ticks), px(kBarTextPt), kInk, Across::kLeft,
                Upright::kMiddle);
  }
}

}  // namespace

Canvas draw_embedding_map(const std::vector<Embeddings>& panels, const EmbeddingStyle& style, const Font& font) {
  check(panels);
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), side = px(kPlotPt), title = px(kPanelTitlePt);
  std::vector<Pca> pcas;
  std::vector<Axes> axes;
  int inside = px(kBetweenPt) * (int(panels.size()) - 1), below = 0;
  for (const Embeddings& panel : panels) {
    pcas.push_back(principal_components(panel.values, int(panel.names.size()), panel.size, 2));
    axes.push_back(score_axes(pcas.back(), style.scale, font));
    const Axes::Margins margins = axes.back().margins(side, side);
    inside += margins.left + side + margins.right;
    below = std::max(below, margins.bottom);
  }
  const Heading heading(style.title, style.caption, inside, style.scale, font);
  const int titles_y = margin + heading.height() + px(2), plot_y = titles_y + title + px(7);
  Canvas canvas(inside + 2 * margin, plot_y + side + below + margin, font, style.scale);
  heading.draw(canvas, margin, margin);
  int x = margin;
  for (size_t i = 0; i < panels.size(); ++i) {
    const Axes::Margins margins = axes[i].margins(side, side);
    const Box plot = {x + margins.left, plot_y, side, side};
    canvas.text(plot.x + side / 2, titles_y, panels[i].title, title, kInk, Across::kCentre);
    draw_scores(canvas, plot, panels[i], pcas[i], axes[i], px);
    x = plot.right() + margins.right + px(kBetweenPt);
  }
  return canvas;
}

Canvas draw_embedding_distances(const std::vector<Embeddings>& panels, Distance kind, const EmbeddingStyle& style,
                                const Font& font) {
  check(panels);
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), title = px(kPanelTitlePt);
  std::vector<MatrixPlan> plans;
  std::vector<int> widths;
  int inside = px(kBetweenPt) * (int(panels.size()) - 1), height = 0;
  for (const Embeddings& panel : panels) {
    const MatrixPlan plan = plan_matrix(panel, kind, px, font);
    widths.push_back(plan.before() + plan.side(panel) + px(10) + px(kBarPt) + px(5) + plan.bar_labels);
    inside += widths.back();
    height = std::max(height, plan.side(panel) + px(3) + plan.before());
    plans.push_back(plan);
  }
  const Heading heading(style.title, style.caption, inside, style.scale, font);
  const int titles_y = margin + heading.height() + px(2), y = titles_y + title + px(7);
  Canvas canvas(inside + 2 * margin, y + height + margin, font, style.scale);
  heading.draw(canvas, margin, margin);
  int x = margin;
  for (size_t i = 0; i < panels.size(); ++i) {
    canvas.text(x + plans[i].before() + plans[i].side(panels[i]) / 2, titles_y, panels[i].title, title, kInk,
                Across::kCentre);
    draw_distances(canvas, x, y, panels[i], plans[i], px);
    x += widths[i] + px(kBetweenPt);
  }
  return canvas;
}

}  // namespace synpo
