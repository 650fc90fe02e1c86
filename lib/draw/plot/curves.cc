#include "draw/plot/curves.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.h"
#include "draw/colour.h"
#include "draw/plot/curves_legend.h"
#include "stats/interval.h"

namespace synpo {
namespace {

constexpr double kMarkLinePt = 0.8, kBandEdgePt = 0.4, kMarkersApartPt = 34;
// Okabe and Ito's palette (2008), which colour-blind readers tell apart, without its yellow, the darker ones first.
constexpr Rgb kColours[kMostMethods] = {{0, 114, 178}, {213, 94, 0},   {0, 158, 115}, {204, 121, 167},
                                        {40, 40, 40},  {86, 180, 233}, {230, 159, 0}};

// The paper's methods in the order of their looks.
constexpr const char* kPaperMethods[] = {"synpo", "mlp", "mtl", "modulenet", "sf"};

// Their own looks for the paper's methods; the first that are left for others.
size_t look_of(const CurveSet& set, size_t method) {
  const auto paper_look = [](const std::string& label) {
    std::string name = label;
    std::transform(name.begin(), name.end(), name.begin(), [](char c) { return char(std::tolower(uint8_t(c))); });
    return size_t(std::find(std::begin(kPaperMethods), std::end(kPaperMethods), name) - std::begin(kPaperMethods));
  };
  std::vector<size_t> looks;
  std::vector<bool> taken(kMostMethods);
  for (const CurveSet::Method& each : set.methods) {
    const size_t look = paper_look(each.label);
    const bool own = look < std::size(kPaperMethods) && !taken[look];
    looks.push_back(own ? look : kMostMethods);
    if (own) taken[look] = true;
  }
  for (size_t& look : looks) {
    if (look < kMostMethods) continue;
    look = size_t(std::find(taken.begin(), taken.end(), false) - taken.begin());
    taken[look] = true;
  }
  return looks[method];
}

std::vector<Point> places(const Axes& axes, const Box& plot, const std::vector<double>& x,
                          const std::vector<double>& y) {
  std::vector<Point> out;
  for (size_t i = 0; i < x.size(); ++i) out.push_back(axes.place(plot, x[i], y[i]));
  return out;
}

// Marks of a panel as dotted lines; the labels beside it, moved apart where they would meet.
void draw_marks(Canvas& canvas, const CurveSet& set, const CurvesLayout& layout, const CurvesLayout::Panel& panel,
                const CurvesStyle& style) {
  std::vector<std::pair<double, const CurveMark*>> marks;
  for (const CurveMark& mark : style.marks) {
    const bool here =
        std::any_of(panel.parts.begin(), panel.parts.end(), [&](int part) { return set.parts[part] == mark.part; });
    if (mark.part.empty() || here) marks.push_back({layout.axes.place(panel.plot, 0, mark.value).y, &mark});
  }
  std::stable_sort(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const int size = layout.mark_size, line = size * 5 / 4, space = layout.mark_space;
  std::vector<double> text;
  for (const auto& [y, mark] : marks) text.push_back(text.empty() ? y : std::max(y, text.back() + line));
  // Labels that were pushed below the plot push back.
  double lowest = panel.plot.bottom();
  for (size_t i = text.size(); i-- > 0;) {
    text[i] = std::min(text[i], lowest);
    lowest = text[i] - line;
  }
  const Box& plot = panel.plot;
  for (size_t i = 0; i < marks.size(); ++i) {
    const double y = marks[i].first, right = plot.right();
    const Dash dots = {1.2 * style.scale, 2.6 * style.scale};
    canvas.line({{double(plot.x), y}, {right, y}}, kMarkLinePt * style.scale, kSoftInk, dots, plot);
    if (marks[i].second->label.empty()) continue;
    const Box beside = {plot.right(), 0, space, canvas.height()};
    canvas.line({{right, y}, {right + space * 2 / 3, text[i]}}, 0.5 * style.scale, kSoftInk, {}, beside);
    const std::string label =
        canvas.font().fitted(marks[i].second->label, size, panel.area.right() - plot.right() - space);
    canvas.text(plot.right() + space, int(std::lround(text[i])), label, size, kSoftInk, Across::kLeft,
                Upright::kMiddle);
  }
}

// A band with thin edges, so that it is seen among others.
void draw_band(Canvas& canvas, std::vector<Point> high, const std::vector<Point>& low, Rgb colour, double opacity,
               double scale, const Box& plot) {
  for (const auto& edge : {high, low}) canvas.line(edge, kBandEdgePt * scale, mix(colour, kPaper, 0.5), {}, plot);
  high.insert(high.end(), low.rbegin(), low.rend());
  canvas.polygon(high, colour, opacity, plot);
}

bool within(const Box& box, Point at) {
  return at.x >= box.x && at.x <= box.right() && at.y >= box.y && at.y <= box.bottom();
}

// At values about as far apart as one another, those of different methods beside one another.
void draw_markers(Canvas& canvas, const std::vector<Point>& line, const CurveLook& look, size_t method, size_t methods,
                  double scale, const Box& plot) {
  const double apart = kMarkersApartPt * scale;
  double next = plot.x + apart * (double(method) + 0.5) / double(methods);
  for (size_t i = 0; i < line.size(); ++i) {
    const Point at = line[i];
    // The value that is nearest to the place.
    if (!within(plot, at) || (i + 1 < line.size() && line[i + 1].x <= next) || at.x < next - apart / 2) continue;
    draw_curve_marker(canvas, at, look, scale);
    while (next <= at.x + apart / 2) next += apart;
  }
}

void draw_mean(Canvas& canvas, const std::vector<Point>& line, const CurveLook& look, size_t method, size_t methods,
               double scale, const Box& plot) {
  // A line along an edge is drawn in its full width.
  const int reach = int(std::ceil(kCurvePt * scale / 2));
  const Box clip = {plot.x - reach, plot.y - reach, plot.width + 2 * reach, plot.height + 2 * reach};
  canvas.line(line, kCurvePt * scale, look.colour, curve_dash(look, scale), clip);
  if (look.marker != Marker::kNone)
    draw_markers(canvas, line, look, method, methods, scale, plot);
  else if (line.size() == 1 && within(plot, line[0]))  // a line without a length
    canvas.disc(line[0], 2 * kCurvePt * scale, look.colour);
}

// The first method is drawn last, on top.
void draw_lines(Canvas& canvas, const CurveSet& set, const CurvesLayout& layout, const CurvesLayout::Panel& panel,
                double scale, bool bands) {
  const Box plot = panel.plot;
  for (size_t method = set.methods.size(); method-- > 0;)
    for (const int part : panel.parts) {
      const auto& curve = set.methods[method].parts[part];
      if (!curve) continue;
      const CurveLook look = curve_look(set, layout.one_panel, method, part);
      if (!bands)
        draw_mean(canvas, places(layout.axes, plot, curve->x, curve->mean), look, method, set.methods.size(), scale,
                  plot);
      else if (!curve->low.empty())
        draw_band(canvas, places(layout.axes, plot, curve->x, curve->high),
                  places(layout.axes, plot, curve->x, curve->low), look.colour, band_opacity(set), scale, plot);
    }
}

}  // namespace

CurveSet average_runs(const std::vector<MethodRuns>& methods, const std::vector<std::string>& parts, Band band,
                      bool percent) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Interval bounds = percent ? Interval{0, 100} : Interval{-kNone, kNone};
  CurveSet set;
  for (const MethodRuns& method : methods) set.methods.push_back({method.label, {}});
  for (size_t part = 0; part < parts.size(); ++part) {
    std::vector<std::optional<MeanCurve>> curves;
    for (const MethodRuns& method : methods) {
      std::vector<Curve> runs;
      for (const auto& run : method.runs)
        if (!run[part].x.empty()) runs.push_back(run[part]);
      try {
        curves.push_back(runs.empty() ? std::nullopt : std::optional(mean_curve(runs, band, bounds)));
      } catch (const Error& error) {
        fail(error.code(), method.label.empty() ? "" : quoted(method.label) + ": ", error.what());
      }
    }
    if (std::none_of(curves.begin(), curves.end(), [](const auto& curve) { return curve.has_value(); })) continue;
    set.parts.push_back(parts[part]);
    for (size_t i = 0; i < curves.size(); ++i) set.methods[i].parts.push_back(std::move(curves[i]));
  }
  if (set.parts.empty()) fail(Exit::kData, "no values to draw");
  return set;
}

CurveLook curve_look(const CurveSet& set, bool one_panel, size_t method, size_t part) {
  const bool styles = one_panel && set.parts.size() == 2;
  if (set.methods.size() == 1) return {kColours[styles ? part : look_of(set, 0)], styles && part == 0, Marker::kNone};
  const size_t look = look_of(set, method);
  return {kColours[look], styles && part == 0, Marker(look + 1)};
}

double band_opacity(const CurveSet& set) { return set.methods.size() <= 2 ? 0.2 : 0.1; }

void draw_curve_marker(Canvas& canvas, Point centre, const CurveLook& look, double scale) {
  constexpr double kRadiusPt = 2.7;
  const auto draw = [&](double radius, Rgb colour) {
    const auto polygon = [&](std::vector<Point> corners) {
      for (Point& p : corners) p = {centre.x + radius * p.x, centre.y + radius * p.y};
      canvas.polygon(corners, colour);
    };
    switch (look.marker) {
      case Marker::kNone:
        break;
      case Marker::kDisc:
      case Marker::kRing:
        canvas.disc(centre, radius, colour);
        break;
      case Marker::kSquare:
        polygon({{-0.88, -0.88}, {0.88, -0.88}, {0.88, 0.88}, {-0.88, 0.88}});
        break;
      case Marker::kTriangle:
        polygon({{0, -1.25}, {1.15, 0.8}, {-1.15, 0.8}});
        break;
      case Marker::kDiamond:
        polygon({{0, -1.35}, {1.2, 0}, {0, 1.35}, {-1.2, 0}});
        break;
      case Marker::kTriangleDown:
        polygon({{0, 1.25}, {1.15, -0.8}, {-1.15, -0.8}});
        break;
      case Marker::kCross:
        polygon({{-0.4, -1.2},
                 {0.4, -1.2},
                 {0.4, -0.4},
                 {1.2, -0.4},
                 {1.2, 0.4},
                 {0.4, 0.4},
                 {0.4, 1.2},
                 {-0.4, 1.2},
                 {-0.4, 0.4},
                 {-1.2, 0.4},
                 {-1.2, -0.4},
                 {-0.4, -0.4}});
        break;
    }
  };
  draw((kRadiusPt + 0.6) * scale, kPaper);
  draw(kRadiusPt * scale, look.colour);
  if (look.marker == Marker::kRing) canvas.disc(centre, 0.5 * kRadiusPt * scale, kPaper);
}

Dash curve_dash(const CurveLook& look, double scale) { return look.dashed ? Dash{2.6 * scale, 3.2 * scale} : Dash{}; }

Canvas draw_curves(const CurveSet& set, const CurvesStyle& style, const Font& font) {
  const CurvesLayout layout = lay_out_curves(set, style, font);
  Canvas canvas(layout.width, layout.height, font, style.scale);
  layout.heading.draw(canvas, layout.margin, layout.margin);
  const CurvesLegend legend =
      lay_out_curves_legend(set, layout.one_panel, style.scale, layout.width - 2 * layout.margin, font);
  draw_curves_legend(canvas, legend, layout.margin, layout.legend_y, style.scale);
  for (const CurvesLayout::Panel& panel : layout.panels) {
    const Box& plot = panel.plot;
    layout.axes.draw(canvas, plot);
    canvas.text(plot.x + plot.width / 2, panel.area.y, panel.title, layout.panel_title_size, kInk, Across::kCentre);
    draw_lines(canvas, set, layout, panel, style.scale, true);
    draw_marks(canvas, set, layout, panel, style);
    layout.axes.frame(canvas, plot);
    draw_lines(canvas, set, layout, panel, style.scale, false);
  }
  return canvas;
}

}  // namespace synpo
