#include "draw/plot/curves_legend.h"

#include <algorithm>
#include <cstddef>

#include "draw/colour.h"

namespace synpo {
namespace {

constexpr double kTextPt = 8.5, kSamplePt = 24, kSpacePt = 5, kBetweenPt = 14, kRowPt = 14;

}  // namespace

CurvesLegend lay_out_curves_legend(const CurveSet& set, bool one_panel, double scale, int width, const Font& font) {
  const Pixels px{scale};
  CurvesLegend legend;
  legend.band_opacity = band_opacity(set);
  const auto add = [&](const std::string& name, const CurveLook& look, bool band) {
    legend.entries.push_back({name, look, band, 0, 0});
  };
  const auto banded = [&](const CurveSet::Method& method) {
    return std::any_of(method.parts.begin(), method.parts.end(),
                       [](const auto& part) { return part && !part->low.empty(); });
  };
  const bool styles = one_panel && set.parts.size() == 2;
  for (size_t method = 0; method < set.methods.size(); ++method) {
    const std::string& label = set.methods[method].label;
    if (set.methods.size() == 1 && styles) {
      for (size_t part = 0; part < 2; ++part)
        add(label.empty() ? set.parts[part] + " pairs" : label + ", " + set.parts[part] + " pairs",
            curve_look(set, one_panel, 0, part),
            set.methods[0].parts[part] && !set.methods[0].parts[part]->low.empty());
    } else if (!label.empty()) {
      const CurveLook look = curve_look(set, false, method, 0);
      add(label, {look.colour, false, look.marker}, banded(set.methods[method]));
    }
  }
  if (set.methods.size() > 1 && styles)
    for (size_t part = 0; part < 2; ++part)
      add(set.parts[part] + " pairs", {kSoftInk, curve_look(set, true, 0, part).dashed, Marker::kNone}, false);

  std::vector<std::string> names;
  for (const CurvesLegend::Entry& entry : legend.entries) names.push_back(entry.name);
  names = font.fitted_apart(names, px(kTextPt), width - px(kSamplePt + kSpacePt));
  for (size_t i = 0; i < names.size(); ++i) legend.entries[i].name = names[i];

  int x = 0, y = 0;
  for (CurvesLegend::Entry& entry : legend.entries) {
    const int wide = px(kSamplePt + kSpacePt) + font.width(entry.name, px(kTextPt));
    if (x > 0 && x + wide > width) {
      x = 0;
      y += px(kRowPt);
    }
    entry.x = x;
    entry.y = y;
    x += wide + px(kBetweenPt);
  }
  legend.height = legend.entries.empty() ? 0 : y + px(kRowPt);
  return legend;
}

void draw_curves_legend(Canvas& canvas, const CurvesLegend& legend, int x, int y, double scale) {
  const Pixels px{scale};
  for (const CurvesLegend::Entry& entry : legend.entries) {
    const Box sample = {x + entry.x, y + entry.y, px(kSamplePt), px(kTextPt)};
    const double middle = sample.y + sample.height / 2.0;
    const double left = sample.x, right = sample.right(), top = sample.y, bottom = sample.bottom();
    if (entry.band)
      canvas.polygon({{left, top}, {right, top}, {right, bottom}, {left, bottom}}, entry.look.colour,
                     legend.band_opacity);
    const std::vector<Point> line = {{sample.x + scale, middle}, {sample.right() - scale, middle}};
    canvas.line(line, kCurvePt * scale, entry.look.colour, curve_dash(entry.look, scale), sample);
    draw_curve_marker(canvas, {sample.x + sample.width / 2.0, middle}, entry.look, scale);
    canvas.text(sample.right() + px(kSpacePt), sample.y + sample.height / 2, entry.name, px(kTextPt), kInk,
                Across::kLeft, Upright::kMiddle);
  }
}

}  // namespace synpo
