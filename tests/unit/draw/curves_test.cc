#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "draw/plot/curves.h"
#include "draw/plot/curves_legend.h"
#include "helpers/font.h"
#include "helpers/table_helpers.h"
#include "stats/curve.h"

namespace synpo {
namespace {

// Methods of `runs` runs each, which rise to 80 %, for seen and unseen pairs.
CurveSet curve_set(int methods, int runs, const std::string& stem = "method ", Band band = Band::kSd) {
  std::vector<MethodRuns> all;
  for (int method = 0; method < methods; ++method) {
    MethodRuns one{stem.empty() ? "" : stem + std::to_string(method), {}};
    for (int run = 0; run < runs; ++run) {
      std::vector<Curve> parts(2);
      for (int part = 0; part < 2; ++part)
        for (int i = 1; i <= 20; ++i) {
          parts[part].x.push_back(i * 250 + run);
          parts[part].y.push_back(80 * (1 - std::exp(-i / (4.0 + method))) - 10 * part + 3 * run);
        }
      one.runs.push_back(parts);
    }
    all.push_back(one);
  }
  return average_runs(all, {"seen", "unseen"}, band);
}

TEST(Curves, NothingIsClippedAndLegendsStandAboveThePlots) {
  for (const int methods : {1, 3, 7})
    for (const int panels : {1, 2})
      for (const double scale : {0.5, 1.0, 2.0}) {
        const CurveSet set =
            curve_set(methods, 1 + methods % 2, methods == 7 ? "a method with a rather long name and number " : "m");
        CurvesStyle style;
        style.scale = scale;
        style.panels = panels;
        style.title = methods == 3 ? ""
                                   : "A title that is rather long for a picture of this size, and is wrapped at its "
                                     "blanks as it has to be";
        style.x_title = "updates";
        style.y_title = "success (%)";
        style.percent = true;
        style.height_pt = 330;
        style.marks = {{82.1, "a label that is much too long to stand beside a plot of this size", "unseen"},
                       {81, "near", ""},
                       {0, "low", ""}};
        const CurvesLayout layout = lay_out_curves(set, style, font());
        const Canvas canvas = draw_curves(set, style, font());
        EXPECT_EQ(canvas.clipped(), 0) << methods << " in " << panels << " at " << scale;
        EXPECT_EQ(layout.panels.size(), size_t(panels));
        const CurvesLegend legend =
            lay_out_curves_legend(set, layout.one_panel, scale, layout.width - 2 * layout.margin, font());
        EXPECT_EQ(legend.entries.size(), panels == 2 ? methods : methods == 1 ? 2u : methods + 2u);
        for (const auto& panel : layout.panels) EXPECT_GE(panel.area.y, layout.legend_y + legend.height);
      }
}

TEST(Curves, LinesAreWhereTheirValuesAreInTheirColours) {
  const CurveSet set = curve_set(2, 1);
  CurvesStyle style;
  style.percent = true;
  const CurvesLayout layout = lay_out_curves(set, style, font());
  const Canvas canvas = draw_curves(set, style, font());
  ASSERT_EQ(layout.panels.size(), 2u);
  for (size_t method = 0; method < 2; ++method)
    for (size_t part = 0; part < 2; ++part) {
      const MeanCurve& curve = *set.methods[method].parts[part];
      const Point at = layout.axes.place(layout.panels[part].plot, curve.x[10], curve.mean[10]);
      const Rgb found = canvas.at(int(at.x), int(at.y)), expected = curve_look(set, false, method, part).colour;
      EXPECT_NEAR(found.r, expected.r, 12);
      EXPECT_NEAR(found.g, expected.g, 12);
      EXPECT_NEAR(found.b, expected.b, 12);
    }
}

TEST(Curves, OneValueAloneIsSeen) {
  const CurveSet set = average_runs({{"", {{{{100}, {40}}}}}}, {"seen"}, Band::kSd);
  CurvesStyle style;
  style.percent = true;
  const CurvesLayout layout = lay_out_curves(set, style, font());
  const Canvas canvas = draw_curves(set, style, font());
  const Point at = layout.axes.place(layout.panels[0].plot, 100, 40);
  // Two and a half points left of it, where a line of one and a half would not reach.
  EXPECT_EQ(canvas.at(int(at.x - 2.5 * style.scale), int(at.y)), curve_look(set, false, 0, 0).colour);
}

TEST(Curves, ThePapersMethodsLookAlikeInEveryPicture) {
  const auto looks = [](const std::vector<std::string>& labels) {
    std::vector<MethodRuns> methods;
    for (const std::string& label : labels) methods.push_back({label, {{{{1, 2}, {3, 4}}}}});
    const CurveSet set = average_runs(methods, {""}, Band::kSd);
    std::vector<CurveLook> out;
    for (size_t i = 0; i < labels.size(); ++i) out.push_back(curve_look(set, true, i, 0));
    return out;
  };
  const auto all = looks({"SynPo", "MLP", "MTL", "ModuleNet", "SF"}), two = looks({"sf", "mlp"});
  EXPECT_EQ(two[0].colour, all[4].colour);
  EXPECT_EQ(two[0].marker, all[4].marker);
  EXPECT_EQ(two[1].colour, all[1].colour);
  // Others have what is left, in their order.
  const auto mixed = looks({"ours", "SynPo", "theirs"});
  EXPECT_EQ(mixed[1].colour, all[0].colour);
  EXPECT_EQ(mixed[0].colour, all[1].colour);
  EXPECT_EQ(mixed[2].colour, all[2].colour);
  const auto seven = looks({"a", "b", "c", "d", "e", "f", "g"});
  for (size_t i = 0; i < 7; ++i)
    for (size_t j = 0; j < i; ++j) {
      EXPECT_NE(seven[i].marker, seven[j].marker) << "told apart in grey";
      EXPECT_FALSE(seven[i].colour == seven[j].colour);
    }
  EXPECT_EQ(looks({"SynPo"})[0].marker, Marker::kNone) << "one line needs none";
}

TEST(Curves, ALogarithmicAxisReachesFromPowerToPower) {
  const CurveSet set = average_runs({{"", {{{{100, 1000, 10000}, {0.03, 5, 70}}}}}}, {""}, Band::kSd);
  CurvesStyle style;
  style.log_x = style.log_y = true;
  const CurvesLayout layout = lay_out_curves(set, style, font());
  const Box plot = layout.panels[0].plot;
  EXPECT_NEAR(layout.axes.place(plot, 1000, 1).x, plot.x + plot.width / 2.0, 0.5);
  EXPECT_NEAR(layout.axes.place(plot, 100, 0.01).x, plot.x, 0.5);
  EXPECT_NEAR(layout.axes.place(plot, 100, 0.01).y, plot.bottom(), 0.5);
  EXPECT_NEAR(layout.axes.place(plot, 100, 100).y, plot.y, 0.5);
  EXPECT_EQ(draw_curves(set, style, font()).clipped(), 0);
  const CurveSet none = average_runs({{"", {{{{1, 2}, {0, -3}}}}}}, {""}, Band::kSd);
  style.y_title = "reward";
  EXPECT_EQ(thrown([&] { lay_out_curves(none, style, font()); }),
            "65 a logarithmic axis of reward needs values above 0");
}

TEST(Curves, PanelsAreChosenByTheNumberOfMethodsAndParts) {
  EXPECT_EQ(lay_out_curves(curve_set(1, 2), {}, font()).panels.size(), 1u);
  EXPECT_EQ(lay_out_curves(curve_set(2, 2), {}, font()).panels.size(), 2u);
  MethodRuns seen_only{"a", {{{{1, 2}, {3, 4}}, {}}}};
  const CurveSet set = average_runs({seen_only, {"b", seen_only.runs}}, {"seen", "unseen"}, Band::kSd);
  EXPECT_EQ(set.parts, (std::vector<std::string>{"seen"}));
  EXPECT_EQ(lay_out_curves(set, {}, font()).panels.size(), 1u);
  EXPECT_THROW(lay_out_curves(curve_set(8, 1), {}, font()), Error);
}

TEST(Curves, TheAxisEndsAtTheRoundNumberThatTheLongestRunAlmostReaches) {
  // Where the axis ends, by a run's last point.
  const auto end = [](double last, double given) {
    CurvesStyle style;
    style.x.high = given;
    const CurvesLayout layout =
        lay_out_curves(average_runs({{"", {{{{last / 2, last}, {3, 4}}}}}}, {""}, Band::kSd), style, font());
    const Box plot = layout.panels[0].plot;
    const double left = layout.axes.place(plot, 0, 0).x, right = layout.axes.place(plot, last, 0).x;
    return last * plot.width / (right - left);
  };
  const double chosen = std::nan("");
  EXPECT_NEAR(end(1999872, chosen), 2e6, 1);
  EXPECT_NEAR(end(9999872, chosen), 1e7, 1);
  EXPECT_NEAR(end(28.9, chosen), 29, 1e-6);
  EXPECT_NEAR(end(19531, chosen), 19531, 1e-3);  // 2.4 % short of 20,000
  EXPECT_NEAR(end(5000, chosen), 5000, 1e-3);
  EXPECT_NEAR(end(1999872, 1999900), 1999900, 1);
}

TEST(Curves, AMarkOfOnePanelLeavesThePlotsAsWideAsOneAnother) {
  CurvesStyle style;
  style.marks = {{50, "a mark of the unseen pairs alone", "unseen"}};
  const CurvesLayout layout = lay_out_curves(curve_set(2, 2), style, font());
  ASSERT_EQ(layout.panels.size(), 2u);
  const CurvesLayout::Panel &seen = layout.panels[0], &unseen = layout.panels[1];
  EXPECT_EQ(seen.plot.width, unseen.plot.width);
  EXPECT_GT(unseen.area.right() - unseen.plot.right(), seen.area.right() - seen.plot.right() + layout.mark_space);
  EXPECT_NEAR(unseen.area.right(), layout.width - layout.margin, 1);  // there are no half pixels
}

TEST(Curves, CaptionSaysWhatTheBandIs) {
  const auto caption = [](int runs, Band band) {
    CurvesStyle style;
    style.band = band;
    std::string out;
    const CurvesLayout layout = lay_out_curves(curve_set(2, runs, "m", band), style, font());
    for (const std::string& line : layout.heading.caption()) out += line;
    return out;
  };
  EXPECT_EQ(caption(1, Band::kSd), "");
  EXPECT_EQ(caption(3, Band::kSd), "mean of 3 runs; band: standard deviation (divisor n \u2212 1)");
  EXPECT_EQ(caption(3, Band::kRange), "mean of 3 runs; band: lowest to highest run");
  EXPECT_EQ(caption(3, Band::kNone), "mean of 3 runs");
  CurvesStyle smooth;
  smooth.smooth = 5;
  EXPECT_EQ(lay_out_curves(curve_set(1, 1), smooth, font()).heading.caption(),
            (std::vector<std::string>{"each point the mean of the last 5 of its run"}));
}

TEST(Curves, ASizeWithoutRoomOrAMarkOutsideIsRefused) {
  CurvesStyle style;
  style.width_pt = style.height_pt = 60;
  EXPECT_THROW(lay_out_curves(curve_set(1, 1), style, font()), Error);
  EXPECT_TRUE(fails_for(kNoRoomForAxes, [&] { lay_out_curves(curve_set(1, 1), style, font()); }));
  CurvesStyle ranged;
  ranged.percent = true;
  ranged.y.low = 200;
  EXPECT_EQ(thrown([&] { lay_out_curves(curve_set(1, 1), ranged, font()); }),
            "64 the range leaves nothing between 200 and 100");
  CurvesStyle marked;
  marked.percent = true;
  marked.marks = {{101, "", ""}};
  EXPECT_THROW(lay_out_curves(curve_set(1, 1), marked, font()), Error);
  EXPECT_TRUE(fails_for(kMarkOutside, [&] { lay_out_curves(curve_set(1, 1), marked, font()); }));
}

}  // namespace
}  // namespace synpo
