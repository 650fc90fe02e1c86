// synpo-render curves: run logs as learning curves.
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/cli/options.h"
#include "base/cli/screen.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "draw/canvas/font.h"
#include "draw/plot/curves.h"
#include "draw/terminal/terminal.h"
#include "draw/terminal/text_curves.h"
#include "format/run_log.h"
#include "render/curve_data.h"
#include "render/render.h"
#include "stats/curve.h"

using namespace synpo;

namespace {

// The curves of a picture as a terminal shows them.
std::string text_of(const CurveSet& set, const std::string& note, const CurvesStyle& style, const ScreenSize& size,
                    TerminalColour colour) {
  constexpr int kUsualColumns = 80, kUsualRows = 24;
  TextCurvesStyle text;
  text.title = style.title;
  text.x_title = style.x_title;
  text.note = note;
  text.y_title = style.y_title;
  text.percent = style.percent;
  text.x_low = style.x.low;
  text.x_high = style.x.high;
  text.y_low = style.y.low;
  text.y_high = style.y.high;
  text.columns = size.columns > 0 ? size.columns : kUsualColumns;
  text.rows = (size.rows > 0 ? size.rows : kUsualRows) - 1;  // the shell's line follows
  text.braille = locale_is_utf8();
  text.colour = colour;
  std::vector<TextCurve> curves;
  for (const CurveSet::Method& method : set.methods)
    for (size_t part = 0; part < set.parts.size(); ++part) {
      TextCurve curve{
          method.label + (method.label.empty() || set.parts[part].empty() ? "" : ", ") + set.parts[part], {}, {}};
      if (const auto& mean = method.parts[part]) {
        curve.x = mean->x;
        curve.y = mean->mean;
      }
      curves.push_back(std::move(curve));
    }
  return text_curves(curves, text);
}

// A run that stands twice under its label would count twice in the mean, and make its band narrower.
void check_once(const std::vector<LabelledFiles>& logs) {
  for (const LabelledFiles& method : logs) {
    std::map<std::pair<dev_t, ino_t>, std::string> known;
    for (const std::string& path : method.paths) {
      struct stat status;
      if (path == "-" || stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
      const auto [at, fresh] = known.try_emplace({status.st_dev, status.st_ino}, path);
      if (!fresh)
        fail(Exit::kUsage, "the log ", quoted(path), " stands twice under its label",
             at->second == path ? "" : ", as " + quoted(at->second) + " too", ": a run counts once");
    }
  }
}

// The size and the time of a file's last change, and which file it is: it changes with what can be read there.
std::vector<int64_t> state_of(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0) return {};
  return {int64_t(status.st_dev), int64_t(status.st_ino), int64_t(status.st_size), int64_t(status.st_mtim.tv_sec),
          int64_t(status.st_mtim.tv_nsec)};
}

// Draws anew whenever a log or the size of the terminal has changed, until a signal comes. What cannot be read at that
// moment is said in place of the curves.
[[noreturn]] void follow(const std::vector<LabelledFiles>& logs, Output& output,
                         const std::function<std::string(const ScreenSize&)>& draw) {
  constexpr int kEvery_ms = 250;
  std::vector<std::vector<int64_t>> before;
  while (true) {
    const ScreenSize size = screen_size(1);
    std::vector<std::vector<int64_t>> now = {{size.columns, size.rows}};
    for (const LabelledFiles& method : logs)
      for (const std::string& path : method.paths) now.push_back(state_of(path));
    if (now != before) {
      std::string screen;
      try {
        screen = draw(size);
      } catch (const Error& error) {
        screen = "waiting: " + printable(error.what()) + "\n";
      }
      output.write("\033[H\033[2J" + screen);
      output.flush();
    }
    before = std::move(now);
    pollfd stop = {stop_descriptor(), POLLIN, 0};
    poll(&stop, 1, kEvery_ms);
    if (stop_signal() == SIGINT) {  // the terminal has written ^C
      output.write("\n");
      output.flush();
    }
    stop_if_asked();
  }
}

}  // namespace

int curves(int argc, char** argv) {
  CurvesStyle style;
  PictureOptions picture;
  std::string x = "updates", y = "success", pairs = "both", band = "sd", log_axis = "none";
  double rate = 0;
  bool follows = false;
  Options options(
      "synpo-render curves", "[OPTION]... [[LABEL=]LOG[,LOG]...]...",
      "Draws run logs as curves. Logs of one label are runs of one method: their mean, and a band around it.");
  options.choice('x', "across", "AXIS", "updates, states or minutes", x, {"updates", "states", "minutes"})
      .text('y', "up", "COLUMN", "success, reward, reward_loss, or any column of the log", y)
      .suggest({"success", "reward", "reward_loss", "loss", "policy", "env", "task", "right_move", "right_pick"})
      .choice(0, "pairs", "WHICH", "seen, unseen or both; or training: those that it played itself", pairs,
              {"seen", "unseen", "both", "training"})
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
  picture.add_ansi(options, "text for a terminal instead of a picture");
  options.flag(0, "follow", "--ansi, drawn anew as the logs grow, until Ctrl-C", follows);
  picture.add_to(options);
  const std::vector<LabelledFiles> logs = labelled_files(options.parse(argc, argv, 0, 1000));
  check_once(logs);
  picture.ansi |= follows;
  picture.settle(options, {"size", "mark", "band", "panels", "log-axis"});
  style.scale = picture.scale;
  style.band = band == "sd" ? Band::kSd : band == "range" ? Band::kRange : Band::kNone;
  if (rate > 0 && x != "minutes") fail(Exit::kUsage, "--rate is for -x minutes");
  const Measure measure = find_measure(y, pairs);
  if (measure.own.empty())
    for (const char* option : {"pairs", "panels"})
      if (options.given(option) && !(measure.of_training && option == std::string("pairs")))
        fail(Exit::kUsage, "--", option, " is for -y success and -y reward");
  for (const CurveMark& mark : style.marks)
    if (!mark.part.empty() && std::find(measure.parts.begin(), measure.parts.end(), mark.part) == measure.parts.end())
      fail(Exit::kUsage, "a mark for ", mark.part, " pairs, which are not drawn");
  style.log_x = log_axis.find('x') != std::string::npos;
  style.log_y = log_axis.find('y') != std::string::npos;
  style.x_title = x;
  const RunLogAxis axis = x == "updates"              ? RunLogAxis::kUpdates
                          : x == "states" || rate > 0 ? RunLogAxis::kStates
                                                      : RunLogAxis::kMinutes;

  CurveRequest request{logs, axis, rate > 0 ? 1 / rate / 60 : 1, y, measure, !options.given("up"), follows};
  std::string note;
  const auto read = [&] {
    CurveData data = read_curve_data(request);
    style.y_title = data.measure.title;
    style.percent = data.measure.percent;
    note = data.note;
    for (MethodRuns& method : data.methods)
      for (std::vector<Curve>& run : method.runs)
        for (Curve& curve : run) curve = running_mean(curve, style.smooth);
    return average_runs(data.methods, data.measure.parts, style.band, style.percent);
  };
  Output output = picture.open();
  const TerminalColour colour = picture.colour.of(output);
  const auto draw_text = [&](const ScreenSize& size) {
    const CurveSet set = read();
    return text_of(set, note, style, size, colour);
  };
  if (follows) {
    for (const LabelledFiles& method : logs)
      for (const std::string& path : method.paths)
        if (path == "-") fail(Exit::kUsage, "--follow needs logs that are files, found standard input");
    if (!output.is_stdout() || !isatty(1))
      fail(Exit::kUsage, "--follow draws on a terminal, and standard output is none");
    catch_stop_signals();
    follow(logs, output, draw_text);
  }
  if (picture.ansi) {
    finish(output, draw_text(screen_size(output.is_stdout() ? 1 : -1)));
    return 0;
  }
  const Font font(picture.font);
  const CurveSet set = read();
  picture.finish(output, draw_curves(set, style, font));
  if (!note.empty()) std::fprintf(stderr, "synpo-render: note: %s\n", note.c_str());
  return 0;
}
