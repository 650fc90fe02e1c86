// Learning curves (Figures 2, 3 and 7): methods against updates, states or minutes, seen and unseen pairs in panels of
// their own or as two styles of line, each method a mean with a band over its runs.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/shapes.h"
#include "draw/plot/axes.h"
#include "stats/curve.h"

namespace synpo {

constexpr int kMostMethods = 7;  // more colours cannot be told apart

struct CurveSet {
  struct Method {
    std::string label;                            // may be empty where there is but one
    std::vector<std::optional<MeanCurve>> parts;  // as `parts`; nothing where no run has values
  };
  std::vector<std::string> parts;  // {"seen", "unseen"}, one of them, or {""} where the pairs are not told apart
  std::vector<Method> methods;
};

// The runs of a method, each with a curve for every part; empty curves are left out.
struct MethodRuns {
  std::string label;
  std::vector<std::vector<Curve>> runs;
};
// Means over the runs. Parts that no method has values for are dropped. Throws kData where nothing is left, or runs of
// a method have no x in common. Bands of values in `percent` stay within 0 and 100.
CurveSet average_runs(const std::vector<MethodRuns>& methods, const std::vector<std::string>& parts, Band band,
                      bool percent = false);

// A line across at a value, with a label beside the plot.
struct CurveMark {
  double value = 0;
  std::string label;
  std::string part;  // seen or unseen: only in its panel; empty: in each
};

// Ends left out (NaN) are chosen by the data.
struct AxisRange {
  double low = std::numeric_limits<double>::quiet_NaN(), high = std::numeric_limits<double>::quiet_NaN();
  std::string name = "the range";  // in messages
};

struct CurvesStyle {
  std::string title, x_title, y_title;
  bool percent = false;  // y runs from 0 to 100 where no range is given
  Band band = Band::kSd;
  AxisRange x, y;
  std::vector<CurveMark> marks;
  int64_t panels = 0;                  // 1 or 2 for two parts; 0: 2 where there are several methods
  double width_pt = 0, height_pt = 0;  // of the picture; 0: by the number of panels
  bool log_x = false, log_y = false;   // logarithmic axes
  int64_t smooth = 1;                  // points of the running mean that the curves are, for the caption
  double scale = 2;                    // pixels per point
};

// "LOW:HIGH", either may be missing; "VALUE", "VALUE=LABEL" or "seen:VALUE=LABEL"; "WIDTHxHEIGHT" in points. Throw
// std::invalid_argument.
AxisRange parse_axis_range(const std::string& text);
CurveMark parse_curve_mark(const std::string& text);
void parse_curves_size(const std::string& text, CurvesStyle& style);

// All in pixels.
struct CurvesLayout {
  struct Panel {
    Box area, plot;  // with titles and labels, and without
    std::string title;
    std::vector<int> parts;  // indices into CurveSet::parts
  };
  int width, height;
  Heading heading;
  int margin, legend_y;
  int panel_title_size;       // height of text
  int mark_size, mark_space;  // a mark's label, and from the plot to it
  bool one_panel;
  std::vector<Panel> panels;
  Axes axes;  // the same for every panel
};

constexpr Cause kNoRoomForAxes{"no room for the axes"}, kMarkOutside{"a mark outside the axis"};

// Throws kData for a logarithmic axis without a value above 0; kUsage where the size leaves no room for the axes
// (kNoRoomForAxes), for more than kMostMethods, for a range that leaves nothing of an axis, and for a mark outside the
// range given (kMarkOutside).
CurvesLayout lay_out_curves(const CurveSet& set, const CurvesStyle& style, const Font& font);
Canvas draw_curves(const CurveSet& set, const CurvesStyle& style, const Font& font);

// How a line is drawn. With several methods the colour and, on paper without colours, the marker tell the method, and
// in one panel seen pairs are dashed. The paper's methods look alike in every picture, whatever stands beside them.
enum class Marker { kNone, kDisc, kSquare, kTriangle, kDiamond, kTriangleDown, kCross, kRing };
struct CurveLook {
  Rgb colour;
  bool dashed;
  Marker marker;
};
CurveLook curve_look(const CurveSet& set, bool one_panel, size_t method, size_t part);
constexpr double kCurvePt = 1.5;
Dash curve_dash(const CurveLook& look, double scale);
// The fewer bands there are, the stronger they may be.
double band_opacity(const CurveSet& set);
void draw_curve_marker(Canvas& canvas, Point centre, const CurveLook& look, double scale);

}  // namespace synpo
