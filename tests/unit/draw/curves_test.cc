#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "draw/canvas/stroke.h"
#include "draw/canvas/ticks.h"
#include "draw/plot/curves.h"
#include "draw/plot/curves_legend.h"
#include "format/run_log.h"
#include "helpers/table_helpers.h"
#include "stats/curve.h"

namespace synpo {
namespace {

const Font& font() {
  static const Font shared;
  return shared;
}

std::vector<std::string> labels(double low, double high, int most) {
  const Ticks ticks = nice_ticks(low, high, most);
  std::vector<std::string> out;
  for (const double at : ticks.at) out.push_back(tick_text(at, ticks.step));
  return out;
}

using Texts = std::vector<std::string>;

TEST(Ticks, StandAtOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_EQ(labels(0, 100, 6), (Texts{"0", "20", "40", "60", "80", "100"}));
  EXPECT_EQ(labels(0, 100, 5), (Texts{"0", "50", "100"}));
  EXPECT_EQ(labels(0, 1, 11), (Texts{"0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1.0"}));
  EXPECT_EQ(labels(-3.2, 9.7, 5), (Texts{"0", "5"}));
  EXPECT_EQ(labels(-6, 3, 7), (Texts{"\u22126", "\u22124", "\u22122", "0", "2"}));
  EXPECT_EQ(labels(0.0012, 0.0031, 3), (Texts{"0.002", "0.003"}));
  EXPECT_EQ(labels(1e9, 2e9, 3), (Texts{"1e+09", "1.5e+09", "2e+09"}));
}

TEST(Ticks, AreInsideEvenlySpacedAndNoMoreThanAskedFor) {
  for (const double low : {-123.4, -1.0, 0.0, 0.037, 55.5})
    for (const double range : {1e-5, 0.013, 0.7, 1.0, 9.99, 480.0, 3e8})
      for (int most = 2; most <= 12; ++most) {
        const Ticks ticks = nice_ticks(low, low + range, most);
        ASSERT_LE(int(ticks.at.size()), most);
        // At worst half as many as there may be, less one for where they happen to lie.
        EXPECT_GE(int(ticks.at.size()), std::max(0, (most - 1) * 2 / 5 - 1)) << low << " + " << range << ", " << most;
        for (size_t i = 0; i < ticks.at.size(); ++i) {
          EXPECT_GE(ticks.at[i], low - 1e-6 * range);
          EXPECT_LE(ticks.at[i], low + range + 1e-6 * range);
          if (i > 0) {
            EXPECT_NEAR(ticks.at[i] - ticks.at[i - 1], ticks.step, 1e-6 * ticks.step);
          }
        }
      }
  EXPECT_THROW(nice_ticks(1, 1, 5), Error);
  EXPECT_THROW(nice_ticks(-1e300, 1e300, 5), Error);
  EXPECT_THROW(nice_ticks(1e9, 1e9 + 1e-3, 5), Error);
}

TEST(Ticks, CountsAreWrittenInThousandsAndMillions) {
  const Axis axis = count_axis("states", 0, 8.7e6);
  EXPECT_EQ(axis.title, "states (millions)");
  const Ticks ticks = axis.ticks(10);
  EXPECT_EQ(axis.label(ticks.at[1], ticks), "1");
  EXPECT_EQ(count_axis("updates", 0, 17000).title, "updates");
  EXPECT_EQ(count_axis("updates", 0, 200000).title, "updates (thousands)");
}

TEST(Ticks, AxesOfValuesEndAtTicks) {
  EXPECT_DOUBLE_EQ(value_axis("", -2.9, 9.1, 7).low, -4);
  EXPECT_DOUBLE_EQ(value_axis("", -2.9, 9.1, 7).high, 10);
  EXPECT_DOUBLE_EQ(value_axis("", 0.5, 4.6, 6).low, 0);
  EXPECT_DOUBLE_EQ(value_axis("", 4.1, 4.6, 6).low, 4.1);
  const Axis flat = value_axis("", 7, 7, 5);
  EXPECT_LT(flat.low, 7);
  EXPECT_GT(flat.high, 7);
}

TEST(MeanCurve, OverRunsOnDifferentGrids) {
  const Curve a = {{0, 10, 20}, {0, 1, 0}}, b = {{5, 15, 40}, {0.5, 0.5, 3}};
  const MeanCurve mean = mean_curve({a, b}, Band::kSd);
  // Where both have values: from b's first x to a's last.
  EXPECT_EQ(mean.x, (std::vector<double>{5, 10, 15, 20}));
  EXPECT_EQ(mean.runs, 2);
  EXPECT_EQ(mean.longest, 40);
  const double expected[] = {0.5, 0.75, 0.5, (0 + 1.0) / 2};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(mean.mean[i], expected[i], 1e-12) << i;
  // 1 and 0.5 at x = 10: the sd with divisor 1 is 0.5 / sqrt 2.
  EXPECT_NEAR(mean.high[1] - mean.mean[1], 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(mean.mean[1] - mean.low[1], 0.5 / std::sqrt(2.0), 1e-12);
  const MeanCurve range = mean_curve({a, b}, Band::kRange);
  EXPECT_EQ(range.low[1], 0.5);
  EXPECT_EQ(range.high[1], 1);
}

TEST(MeanCurve, OneRunIsItselfAndHasNoBand) {
  const MeanCurve mean = mean_curve({{{1, 2, 4}, {5, 6, 7}}}, Band::kSd);
  EXPECT_EQ(mean.x, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(mean.mean, (std::vector<double>{5, 6, 7}));
  EXPECT_TRUE(mean.low.empty());
  EXPECT_TRUE(mean_curve({{{1}, {5}}, {{1}, {6}}}, Band::kNone).low.empty());
  EXPECT_THROW(mean_curve({{{1, 2}, {0, 0}}, {{3, 4}, {0, 0}}}, Band::kSd), Error);
}

std::string log_text(const std::string& rows) {
  return "update\tstates\tseconds\tstates_per_s\tpolicy\tseen_success\n" + rows;
}

RunLogTable read_log(const std::string& rows, RunLogAxis axis) {
  return read_text(log_text(rows), [&](Input& input) { return read_run_log(input, axis, {"policy", "seen_success"}); });
}

TEST(ReadRunLog, TakesColumnsByNameAndNaAsNothing) {
  const RunLogTable log = read_log("10\t100\t1\t100\t2.5\tNA\n20\t200\t2\t100\tNA\t0.25\n", RunLogAxis::kStates);
  EXPECT_EQ(log.x, (std::vector<double>{100, 200}));
  EXPECT_EQ(log.columns[0][0], 2.5);
  EXPECT_TRUE(std::isnan(log.columns[0][1]));
  EXPECT_TRUE(std::isnan(log.columns[1][0]));
  EXPECT_EQ(log.columns[1][1], 0.25);
}

TEST(ReadRunLog, OfUpdatesDoneAgainTheLaterRowsCount) {
  const std::string first = "1\t10\t1\t10\t9\tNA\n2\t20\t2\t10\t8\tNA\n3\t30\t3\t10\t7\tNA\n";
  const RunLogTable log = read_log(first + "2\t20\t1\t10\t6\tNA\n4\t40\t3\t10\t5\tNA\n", RunLogAxis::kUpdates);
  EXPECT_EQ(log.x, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(log.columns[0], (std::vector<double>{9, 6, 5}));
}

TEST(ReadRunLog, MinutesGoOnWhereARunIsResumed) {
  // 6000 states at 100 a second are a minute. The second process begins at 12000 states; its clock begins at 0, and its
  // second row comes after an evaluation of half a minute.
  const RunLogTable log =
      read_log("1\t6000\t60\t100\t1\t0\n2\t12000\t120\t100\t1\t0\n3\t18000\t60\t100\t1\t0\n4\t24000\t150\t100\t1\t0\n",
               RunLogAxis::kMinutes);
  EXPECT_EQ(log.x.size(), 4u);
  EXPECT_DOUBLE_EQ(log.x[2], 3);
  EXPECT_DOUBLE_EQ(log.x[3], 4.5);
  // Its first row after more seconds than the first process had: less time has passed than the states took.
  EXPECT_DOUBLE_EQ(read_log("1\t600\t6\t100\t1\t0\n2\t6600\t60\t100\t1\t0\n", RunLogAxis::kMinutes).x[1], 1.1);
  // Killed and done again: the time up to the row that is kept.
  const RunLogTable killed =
      read_log("1\t6000\t60\t100\t1\t0\n2\t12000\t120\t100\t1\t0\n2\t12000\t60\t100\t1\t0\n", RunLogAxis::kMinutes);
  EXPECT_DOUBLE_EQ(killed.x[1], 2);
}

TEST(ReadRunLog, NamesThePlaceOfWhatIsWrong) {
  const auto message = [](const std::string& rows, RunLogAxis axis) { return thrown([&] { read_log(rows, axis); }); };
  const RunLogAxis updates = RunLogAxis::kUpdates, states = RunLogAxis::kStates, minutes = RunLogAxis::kMinutes;
  EXPECT_EQ(message("1\t10\t1\t10\tnan\tNA\n", updates),
            "65 IN: line 2, column 5 ('policy'): found 'nan', expected a finite number, or NA");
  EXPECT_EQ(message("1\t10\t1\t10\t1\t1.01\n", updates),
            "65 IN: line 2, column 6 ('seen_success'): found '1.01', expected a rate from 0 to 1, or NA");
  EXPECT_EQ(message("1\t10\t1\t10\t1\tNA\n2\t10\t2\t10\t1\tNA\n", states),
            "65 IN: line 3, column 2 ('states'): found '10', expected more than the 10 of the row before");
  EXPECT_EQ(message("1\t10\t1\t0\t1\tNA\n", minutes),
            "65 IN: line 2, column 4 ('states_per_s'): found '0', expected a rate above 0");
  EXPECT_EQ(message("1\t10\t-1\t10\t1\tNA\n", minutes),
            "65 IN: line 2, column 3 ('seconds'): found '-1', expected a time of at least 0");
  EXPECT_EQ(message("x\t10\t1\t10\t1\tNA\n", updates).substr(0, 37), "65 IN: line 2, column 1 ('update'): f");
  const auto columns = [](const std::string& text) {
    return thrown(
        [&] { read_text(text, [](Input& input) { return read_run_log(input, RunLogAxis::kMinutes, {"policy"}); }); });
  };
  EXPECT_EQ(columns("env\ttask\na\tb\n"), "65 IN: line 1: no column 'update', found 'env', 'task'");
  EXPECT_EQ(columns("update\tstates\n"), "65 IN: line 1: no column 'seconds', found 'update', 'states'");
}

int ink(const Mask& mask, int x, int y) {
  return mask.coverage[size_t(y - mask.box.y) * mask.box.width + (x - mask.box.x)];
}

TEST(Stroke, CoversItsWidthAndStaysInItsBox) {
  const Box box = {10, 10, 40, 20};
  const Mask mask = stroke_mask({{-1e300, 20}, {1e300, 20}}, 4, {}, box);
  ASSERT_EQ(mask.coverage.size(), 800u);
  for (int x = 10; x < 50; ++x) {
    EXPECT_EQ(ink(mask, x, 16), 0);
    EXPECT_EQ(ink(mask, x, 18), 255);
    EXPECT_EQ(ink(mask, x, 21), 255);
    EXPECT_EQ(ink(mask, x, 23), 0);
  }
  const Mask dashed = stroke_mask({{10, 20}, {50, 20}}, 2, {6, 8}, box);
  EXPECT_EQ(ink(dashed, 13, 20), 255);
  EXPECT_EQ(ink(dashed, 20, 20), 0);
  EXPECT_EQ(ink(dashed, 26, 20), 255);
  EXPECT_EQ(ink(stroke_mask({{30, 20}}, 4, {}, box), 30, 20), 255);
}

TEST(Stroke, BandsLieBetweenTheirLines) {
  const Mask mask = band_mask({{12, 15}, {22, 15}, {40, 12}}, {{12, 18.5}, {22, 18.5}, {40, 25}}, {10, 10, 40, 20});
  EXPECT_EQ(ink(mask, 11, 16), 0);
  EXPECT_EQ(ink(mask, 14, 14), 0);
  EXPECT_EQ(ink(mask, 14, 15), 255);
  EXPECT_EQ(ink(mask, 14, 17), 255);
  EXPECT_NEAR(ink(mask, 14, 18), 128, 1);
  EXPECT_EQ(ink(mask, 14, 19), 0);
  EXPECT_EQ(ink(mask, 39, 20), 255);
  EXPECT_EQ(ink(mask, 41, 20), 0);
}

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
  EXPECT_NEAR(unseen.area.right(), layout.width - layout.margin, 1);  // half of a pixel is none
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
}

TEST(Curves, ASizeWithoutRoomOrAMarkOutsideIsRefused) {
  CurvesStyle style;
  style.width_pt = style.height_pt = 60;
  EXPECT_THROW(lay_out_curves(curve_set(1, 1), style, font()), Error);
  CurvesStyle marked;
  marked.percent = true;
  marked.marks = {{101, "", ""}};
  EXPECT_THROW(lay_out_curves(curve_set(1, 1), marked, font()), Error);
}

}  // namespace
}  // namespace synpo
