#include "draw/plot/heatmap_legend.h"

#include <algorithm>
#include <cstddef>

#include "base/error.h"
#include "base/text.h"

namespace synpo {
namespace {

constexpr double kHeadingPt = 9, kTextPt = 8.5, kDetailPt = 8;
constexpr double kBarPt = 15, kSwatchPt = 9, kEntryPt = 25, kShortEntryPt = 14, kLongestNamePt = 110;

const char* heading_of(const HeatTable& table) { return table.split ? "pairs" : "success rate"; }

std::string detail_of(const HeatTable& table, const HeatGroup& group) {
  if (table.split) return counted(group.members, "pair");
  if (group.pairs == 0) return "not evaluated";
  return concat("mean ", rate_text(group), ", ", counted(group.pairs, "pair"));
}

// With the space beneath it; pairs without rates need no bar.
int bar_height(const HeatTable& table, const HeatmapLayout& layout) {
  return table.split ? 0 : layout.bar_height + layout.pixels(14);
}

int entry_height(const HeatmapLegend::Entry& entry, const HeatmapLayout& layout) {
  return layout.pixels(entry.detail.empty() ? kShortEntryPt : kEntryPt);
}

void draw_bars(Canvas& canvas, const HeatTable& table, const HeatmapLayout& layout, const Scheme& scheme, int x,
               int y) {
  const auto px = [&](double pt) { return layout.pixels(pt); };
  const int groups = int(table.groups.size());
  for (int group = 0; group < groups; ++group)
    canvas.shades({x + group * px(kBarPt + 2), y, px(kBarPt), layout.bar_height},
                  [&](double share) { return ramp_colour(group_ramp(table, group, scheme), 1 - share); });
  const int ticks_x = x + groups * px(kBarPt + 2);
  for (int quarter = 0; quarter <= 4; ++quarter) {
    const int at = y + (layout.bar_height - 1) * (4 - quarter) / 4;
    canvas.fill({ticks_x - px(2), at, px(4), px(0.5)}, kSoftInk);
    canvas.text(ticks_x + px(5), at, rate_text(quarter, 4), px(kTextPt), kInk, Across::kLeft, Upright::kMiddle);
  }
}

}  // namespace

HeatmapLegend lay_out_legend(const HeatFigure& figure, const HeatmapLayout& layout, const Font& font) {
  using Mark = HeatmapLegend::Mark;
  const HeatTable& table = figure.panels[0].table;
  const bool several = figure.panels.size() > 1;
  const auto px = [&](double pt) { return layout.pixels(pt); };
  HeatmapLegend legend{};
  const auto add = [&](Mark mark, const std::vector<HeatGroup>& groups, const std::string& before) {
    for (size_t i = 0; i < groups.size(); ++i)
      legend.entries.push_back({mark, int(i), font.fitted(before + groups[i].name, px(kTextPt), px(kLongestNamePt)),
                                several ? "" : detail_of(table, groups[i])});
  };
  add(Mark::kRamp, table.groups, table.by_part ? "part " : "");
  if (!table.by_part) add(Mark::kPart, table.parts, "part ");
  const auto has_gaps = [](const HeatPanel& panel) {
    return std::any_of(panel.table.cells.begin(), panel.table.cells.end(), [&](const HeatCell& cell) {
      return !cell.evaluated() && !(panel.table.split && cell.group >= 0);
    });
  };
  if (std::any_of(figure.panels.begin(), figure.panels.end(), has_gaps))
    legend.entries.push_back({Mark::kEmpty, 0, "not evaluated", ""});

  const int bar = bar_height(table, layout);
  const int bars = int(table.groups.size()) * px(kBarPt + 2);
  legend.width =
      std::max(font.width(heading_of(table), px(kHeadingPt)), bars + px(3) + font.width("1.00", px(kTextPt)));
  legend.height = px(kHeadingPt) + px(9) + bar;
  for (const HeatmapLegend::Entry& entry : legend.entries) {
    const int text = std::max(font.width(entry.name, px(kTextPt)), font.width(entry.detail, px(kDetailPt)));
    legend.width = std::max(legend.width, px(kSwatchPt) + px(5) + text);
    legend.height += entry_height(entry, layout);
  }
  return legend;
}

void draw_empty_cell(Canvas& canvas, const Box& box, int line) {
  canvas.frame(box, line, kHairline);
  const double w = std::max(1.0, line * 0.8);
  const Point low = {double(box.x), double(box.bottom())}, high = {double(box.right()), double(box.y)};
  canvas.polygon({{low.x, low.y - w}, {low.x + w, low.y}, {high.x, high.y + w}, {high.x - w, high.y}}, kHairline);
}

void draw_legend(Canvas& canvas, const HeatFigure& figure, const HeatmapLayout& layout, const Scheme& scheme) {
  using Mark = HeatmapLegend::Mark;
  const HeatTable& table = figure.panels[0].table;
  const auto px = [&](double pt) { return layout.pixels(pt); };
  const HeatmapLegend legend = lay_out_legend(figure, layout, canvas.font());
  const int x = layout.legend.x;
  int y = layout.legend.y;
  canvas.text(x, y, heading_of(table), px(kHeadingPt), kInk);
  y += px(kHeadingPt) + px(9);

  if (!table.split) draw_bars(canvas, table, layout, scheme, x, y);
  y += bar_height(table, layout);

  for (const HeatmapLegend::Entry& entry : legend.entries) {
    const Box swatch = {x, y, px(kSwatchPt), px(kSwatchPt)};
    switch (entry.mark) {
      case Mark::kRamp:
        canvas.fill(swatch, ramp_colour(group_ramp(table, entry.index, scheme), kSplitShade));
        break;
      case Mark::kEmpty:
        draw_empty_cell(canvas, swatch, px(0.5));
        break;
      case Mark::kPart:
        canvas.frame(swatch, px(1.25), kInk);
        break;
    }
    const int text_x = swatch.right() + px(5);
    canvas.text(text_x, y + px(kSwatchPt) / 2, entry.name, px(kTextPt), kInk, Across::kLeft, Upright::kMiddle);
    canvas.text(text_x, y + px(kSwatchPt) + px(3), entry.detail, px(kDetailPt), kSoftInk);
    y += entry_height(entry, layout);
  }
}

}  // namespace synpo
