// synpo-render curves: run logs as learning curves.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "draw/canvas/font.h"
#include "draw/plot/curves.h"
#include "format/run_log.h"
#include "render/render.h"
#include "stats/curve.h"

using namespace synpo;

namespace {

// The meaning of -y: the log's columns, one for each part, and the axis.
struct Measure {
  std::vector<std::string> columns, parts;
  std::string title;
  bool percent;
};

Measure find_measure(const std::string& name, const std::string& pairs) {
  if (name == "success" || name == "reward") {
    Measure measure{{}, {}, name == "success" ? "success (%)" : "reward of an episode", name == "success"};
    for (const std::string part : {"seen", "unseen"})
      if (pairs == "both" || pairs == part) {
        measure.columns.push_back(part + "_" + name);
        measure.parts.push_back(part);
      }
    return measure;
  }
  static const Measure known[] = {
      {{"loss"}, {}, "loss", false},
      {{"learning_rate"}, {}, "learning rate", false},
      {{"states_per_s"}, {}, "states per second", false},
      {{"policy"}, {}, "policy loss (nats)", false},
      {{"env"}, {}, "environment loss (nats)", false},
      {{"task"}, {}, "task loss (nats)", false},
      {{"right_move"}, {}, "right moves (%)", true},
      {{"right_pick"}, {}, "right picks (%)", true},
      {{"right_walk_on"}, {}, "right walking on (%)", true},
      {{"right_start"}, {}, "right starts (%)", true},
  };
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  Measure measure{{name == "reward_loss" ? "reward" : name}, {}, title, false};
  for (const Measure& candidate : known)
    if (candidate.columns[0] == name) measure = candidate;
  measure.parts = {""};
  return measure;
}

// The curves of one log, one for each part; empty where a part has no values.
std::vector<Curve> read_curves(const std::string& path, RunLogAxis axis, double unit, const Measure& measure,
                               const std::string& name) {
  Input input(path);
  const RunLogTable log = read_run_log(input, axis, measure.columns);
  std::vector<Curve> curves(measure.columns.size());
  size_t values = 0;
  for (size_t i = 0; i < log.x.size(); ++i)
    for (size_t column = 0; column < curves.size(); ++column)
      if (const double y = log.columns[column][i]; !std::isnan(y)) {
        curves[column].x.push_back(log.x[i] * unit);
        curves[column].y.push_back(measure.percent ? 100 * y : y);
        ++values;
      }
  if (values == 0)
    fail(Exit::kData, input.name(), ": no value of ", name, " in ", log.x.size(), log.x.size() == 1 ? " row" : " rows",
         measure.parts[0].empty() ? "" : ": the run made no evaluation");
  return curves;
}

}  // namespace

int curves(int argc, char** argv) {
  CurvesStyle style;
  PictureOptions picture;
  std::string x = "updates", y = "success", pairs = "both", band = "sd", log_axis = "none";
  double rate = 0;
  Options options(
      "synpo-render curves", "[OPTION]... [[LABEL=]LOG[,LOG]...]...",
      "Draws run logs as curves. Logs of one label are runs of one method: their mean, and a band around it.");
  options.choice('x', "across", "AXIS", "updates, states or minutes", x, {"updates", "states", "minutes"})
      .text('y', "up", "COLUMN", "success, reward, reward_loss, or any column of the log", y)
      .choice(0, "pairs", "WHICH", "seen, unseen or both", pairs, {"seen", "unseen", "both"})
      .integer(0, "panels", "N", "1: seen dashed, unseen drawn through; 2: side by side; 0: 2 for several methods",
               style.panels, 0, 2)
      .choice(0, "band", "KIND", "over the runs: sd, range (lowest to highest) or none", band, {"sd", "range", "none"})
      .real(0, "rate", "X", "states per second, from which minutes are computed; 0: the log's clock", rate, 0, 1e12)
      .call(0, "mark", "Y=LABEL",
            "a dotted line across; seen:Y=LABEL, unseen:Y=LABEL for these pairs alone; repeatable",
            [&](const std::string& text) { style.marks.push_back(parse_curve_mark(drawable(text))); })
      .call(0, "x-range", "LOW:HIGH", "ends of the axis across, in updates, states or minutes",
            [&](const std::string& text) { style.x = parse_axis_range(text); })
      .call(0, "y-range", "LOW:HIGH", "ends of the axis up; in percent for rates",
            [&](const std::string& text) {
              style.y = parse_axis_range(text);
              style.y.name = "--y-range";
            })
      .choice(0, "log-axis", "AXES", "logarithmic: none, x, y or xy", log_axis, {"none", "x", "y", "xy"})
      .integer(0, "smooth", "N", "each point the mean of the last N of its run", style.smooth, 1, 10000)
      .call(0, "title", "TEXT", "title above the picture", drawn(style.title))
      .call(0, "size", "WxH", "width and height in points [380x270, 620x270 for two panels]",
            [&](const std::string& text) { parse_curves_size(text, style); });
  picture.add_to(options);
  const std::vector<LabelledFiles> logs = labelled_files(options.parse(argc, argv, 0, 1000));
  picture.settle(options);
  style.scale = picture.scale;
  style.band = band == "sd" ? Band::kSd : band == "range" ? Band::kRange : Band::kNone;
  if (rate > 0 && x != "minutes") fail(Exit::kUsage, "--rate is for -x minutes");
  const Measure measure = find_measure(y, pairs);
  if (measure.parts[0].empty())
    for (const char* option : {"pairs", "panels"})
      if (options.given(option)) fail(Exit::kUsage, "--", option, " is for -y success and -y reward");
  for (const CurveMark& mark : style.marks)
    if (!mark.part.empty() && std::find(measure.parts.begin(), measure.parts.end(), mark.part) == measure.parts.end())
      fail(Exit::kUsage, "a mark for ", mark.part, " pairs, which are not drawn");
  style.log_x = log_axis.find('x') != std::string::npos;
  style.log_y = log_axis.find('y') != std::string::npos;
  style.x_title = x;
  style.y_title = measure.title;
  style.percent = measure.percent;
  const RunLogAxis axis = x == "updates"              ? RunLogAxis::kUpdates
                          : x == "states" || rate > 0 ? RunLogAxis::kStates
                                                      : RunLogAxis::kMinutes;

  Output output = picture.open();
  const Font font(picture.font);
  std::vector<MethodRuns> methods;
  for (const LabelledFiles& method : logs) {
    methods.push_back({method.label, {}});
    for (const std::string& path : method.paths)
      methods.back().runs.push_back(read_curves(path, axis, rate > 0 ? 1 / rate / 60 : 1, measure, y));
    for (std::vector<Curve>& run : methods.back().runs)
      for (Curve& curve : run) curve = running_mean(curve, style.smooth);
  }
  picture.finish(output, draw_curves(average_runs(methods, measure.parts, style.band, measure.percent), style, font));
  return 0;
}
