#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/ticks.h"
#include "draw/plot/axes.h"
#include "draw/plot/curves.h"
#include "draw/plot/curves_legend.h"
#include "stats/curve.h"

namespace synpo {
namespace {

constexpr double kMarginPt = 10, kBetweenPt = 14, kSmallestPlotPt = 40, kOnePanelPt = 380, kTwoPanelsPt = 620,
                 kHeightPt = 270;

// The range of the values that are drawn.
struct Span {
  double low = INFINITY, high = -INFINITY;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

template <class Visit>
void for_curves(const CurveSet& set, Visit visit) {
  for (const CurveSet::Method& method : set.methods)
    for (const auto& curve : method.parts)
      if (curve) visit(*curve);
}

// A run of whole updates ends a little before the round number of states that was meant: the axis has that number,
// where it is less than 1 % away.
double round_end(double high) {
  const double unit = std::pow(10, std::floor(std::log10(high)) - 1), up = std::ceil(high / unit) * unit;
  return up < 1.01 * high ? up : high;
}

void check_range(const CurvesStyle& style, double low, double high) {
  if (high <= low) fail(Exit::kUsage, style.y.name, " leaves nothing between ", low, " and ", high);
  for (const CurveMark& mark : style.marks)
    if (mark.value < low || mark.value > high)
      fail(Exit::kUsage, kMarkOutside, "the mark at ", mark.value, " lies outside the axis from ", low, " to ", high);
}

void check_log(bool logarithmic, double low, double high, const std::string& what) {
  if (logarithmic && !(low > 0 && high > 0 && std::isfinite(low)))
    fail(Exit::kData, "a logarithmic axis of ", what, " needs values above 0",
         std::isfinite(low) ? concat(", found ", low) : "");
}

Axis x_axis(const CurveSet& set, const CurvesStyle& style) {
  double low = style.x.low, high = style.x.high;
  if (std::isnan(high)) {
    high = 0;
    for_curves(set, [&](const MeanCurve& curve) { high = std::max(high, curve.x.back()); });
    if (high > 0) high = round_end(high);
  }
  if (std::isnan(low) && style.log_x) {
    low = INFINITY;
    for_curves(set, [&](const MeanCurve& curve) {
      for (const double x : curve.x)
        if (x > 0) low = std::min(low, x);
    });
  }
  if (std::isnan(low)) low = 0;
  check_log(style.log_x, low, high, style.x_title);
  if (high <= low) high = style.log_x ? 10 * low : low + std::max(1.0, std::abs(low));
  Axis axis = count_axis(style.x_title, low, high);
  axis.logarithmic = style.log_x;
  return axis;
}

// From the power of ten below the lowest value above 0 to the one above the highest.
Axis log_y_axis(const CurveSet& set, const CurvesStyle& style, const Span& span) {
  double low = style.y.low, high = style.y.high;
  if (std::isnan(high)) high = std::pow(10, std::ceil(std::log10(span.high) - 1e-9));
  if (std::isnan(low)) {
    low = INFINITY;
    for_curves(set, [&](const MeanCurve& curve) {
      for (const double y : curve.mean)
        if (y > 0) low = std::min(low, y);
    });
    check_log(true, low, span.high, style.y_title);
    low = std::pow(10, std::floor(std::log10(low) + 1e-9));
    if (low >= high) high = 10 * low;
  }
  check_log(true, low, high, style.y_title);
  check_range(style, low, high);
  return {low, high, 1, style.y_title, true};
}

Axis y_axis(const CurveSet& set, const CurvesStyle& style, const Axis& x, int most_ticks) {
  Span span;
  for_curves(set, [&](const MeanCurve& curve) {
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (curve.x[i] < x.low || curve.x[i] > x.high) continue;
      span.add(curve.mean[i]);
      if (curve.low.empty()) continue;
      span.add(curve.low[i]);
      span.add(curve.high[i]);
    }
  });
  for (const CurveMark& mark : style.marks) span.add(mark.value);
  if (span.low > span.high) span = {0, 1};  // no point is in sight
  if (style.log_y) return log_y_axis(set, style, span);
  const bool given = !std::isnan(style.y.low) && !std::isnan(style.y.high);
  Axis axis = style.percent || given ? Axis{0, 100, 1, style.y_title}
                                     : value_axis(style.y_title, span.low, span.high, most_ticks);
  if (!std::isnan(style.y.low)) axis.low = style.y.low;
  if (!std::isnan(style.y.high)) axis.high = style.y.high;
  check_range(style, axis.low, axis.high);
  return axis;
}

std::string caption_of(const CurveSet& set, Band band, int64_t smooth) {
  int64_t fewest = INT64_MAX, most = 0;
  bool cut = false;
  for_curves(set, [&](const MeanCurve& curve) {
    fewest = std::min(fewest, curve.runs);
    most = std::max(most, curve.runs);
    cut = cut || curve.longest > curve.x.back() * 1.02;
  });
  const std::string smoothed = smooth > 1 ? concat("each point the mean of the last ", smooth, " of its run") : "";
  if (most < 2) return smoothed;
  std::string out =
      fewest == most ? concat("mean of ", most, " runs") : concat("mean of ", fewest, " to ", most, " runs");
  if (band == Band::kSd) out += "; band: standard deviation (divisor n \u2212 1)";
  if (band == Band::kRange) out += "; band: lowest to highest run";
  if (!smoothed.empty()) out += "; " + smoothed;
  return out + (cut ? "; a mean ends with its shortest run" : "");
}

}  // namespace

CurvesLayout lay_out_curves(const CurveSet& set, const CurvesStyle& style, const Font& font) {
  if (set.methods.size() > size_t(kMostMethods))
    fail(Exit::kUsage, set.methods.size(), " methods, at most ", kMostMethods,
         " can be told apart: give the runs of one method the same label, or draw fewer");
  const Pixels px{style.scale};
  const bool one_panel = set.parts.size() < 2 || style.panels == 1 || (style.panels == 0 && set.methods.size() == 1);
  const int panels = one_panel ? 1 : int(set.parts.size());
  const int width = px(style.width_pt > 0 ? style.width_pt : panels == 1 ? kOnePanelPt : kTwoPanelsPt);
  const int height = px(style.height_pt > 0 ? style.height_pt : kHeightPt);
  const int margin = px(kMarginPt), inside = std::max(1, width - 2 * margin);

  const Axis x = x_axis(set, style), y = y_axis(set, style, x, std::clamp(height / px(32), 2, 11));
  CurvesLayout out{.width = width,
                   .height = height,
                   .heading = {},
                   .margin = margin,
                   .legend_y = 0,
                   .panel_title_size = px(9),
                   .mark_size = px(8),
                   .mark_space = px(9),
                   .one_panel = one_panel,
                   .panels = {},
                   .axes = Axes(x, y, style.scale, font)};
  out.heading = Heading(style.title, caption_of(set, style.band, style.smooth), inside, style.scale, font);
  int top = margin + out.heading.height();
  out.legend_y = top;
  if (const int legend = lay_out_curves_legend(set, one_panel, style.scale, inside, font).height) top += legend + px(3);

  const auto marks_room = [&](const std::vector<int>& parts) {
    int widest = 0;
    for (const CurveMark& mark : style.marks)
      if (mark.part.empty() ||
          std::any_of(parts.begin(), parts.end(), [&](int part) { return set.parts[part] == mark.part; }))
        widest = std::max(widest, font.width(mark.label, out.mark_size));
    return widest > 0 ? std::min(widest, inside / (4 * panels)) + out.mark_space : 0;
  };
  const auto no_room = [&] {
    fail(Exit::kUsage, kNoRoomForAxes, "no room for the axes in a picture of ", width / style.scale, "x",
         height / style.scale, " points");
  };
  // Panels are as wide as one another, and beside each is what the labels of its marks take.
  int for_marks = 0;
  for (int panel = 0; panel < panels; ++panel) {
    CurvesLayout::Panel next;
    for (int part = one_panel ? 0 : panel; part < (one_panel ? int(set.parts.size()) : panel + 1); ++part)
      next.parts.push_back(part);
    for_marks += marks_room(next.parts);
    out.panels.push_back(next);
  }
  const int share = (inside - for_marks - (panels - 1) * px(kBetweenPt)) / panels;
  int left = margin;
  for (CurvesLayout::Panel& next : out.panels) {
    if (next.parts.size() == 1 && !set.parts[next.parts[0]].empty()) next.title = set.parts[next.parts[0]] + " pairs";
    const int title = next.title.empty() ? 0 : out.panel_title_size + px(1.5);
    if (share < px(kSmallestPlotPt) || height - top - margin < px(kSmallestPlotPt)) no_room();
    next.area = {left, top, share + marks_room(next.parts), height - margin - top};
    // Ticks depend on the size of the plot and the plot's size on their labels: the second round has the labels of the
    // first.
    next.plot = next.area;
    for (int round = 0; round < 2; ++round) {
      const Axes::Margins margins = out.axes.margins(next.plot.width, next.plot.height);
      next.plot = {left + margins.left, top + title + margins.top, share - margins.left - margins.right,
                   next.area.height - title - margins.top - margins.bottom};
      if (next.plot.width < px(kSmallestPlotPt) || next.plot.height < px(kSmallestPlotPt)) no_room();
    }
    left = next.area.right() + px(kBetweenPt);
  }
  return out;
}

}  // namespace synpo
