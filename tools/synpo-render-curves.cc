// synpo-render curves: run logs as learning curves.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"
#include "draw/curves.h"
#include "format/run_log.h"
#include "synpo-render.h"

using namespace synpo;

namespace {

// What -y means: the log's columns, one for each part, and the axis.
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
      {{"policy"}, {}, "policy loss (nats)", false},
      {{"env"}, {}, "environment loss (nats)", false},
      {{"task"}, {}, "task loss (nats)", false},
      {{"right_move"}, {}, "right moves (%)", true},
      {{"right_pick"}, {}, "right picks (%)", true},
      {{"right_walk_on"}, {}, "right walking on (%)", true},
      {{"right_start"}, {}, "right starts (%)", true},
  };
  Measure measure{{name == "reward_loss" ? "reward" : name}, {}, name == "reward_loss" ? "reward loss" : name, false};
  for (const Measure& candidate : known)
    if (candidate.columns[0] == name) measure = candidate;
  measure.parts = {""};
  return measure;
}

double number(const std::string& text, const char* expected) {
  size_t end = 0;
  double value = NAN;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
  }
  if (!(std::abs(value) <= 1e15) || end != text.size() || std::isspace(uint8_t(text[0]))) throw std::invalid_argument(expected);
  return value;
}

// "LOW:HIGH", either may be missing.
AxisRange parse_range(const std::string& text) {
  constexpr char kExpected[] = "expected LOW:HIGH, such as 0:100, 20: or :1e6";
  const size_t colon = text.find(':');
  if (colon == std::string::npos) throw std::invalid_argument(kExpected);
  AxisRange range;
  if (colon > 0) range.low = number(text.substr(0, colon), kExpected);
  if (colon + 1 < text.size()) range.high = number(text.substr(colon + 1), kExpected);
  if (range.high - range.low <= 1e-9 * std::max(std::abs(range.low), std::abs(range.high)))
    throw std::invalid_argument("expected LOW below HIGH");
  return range;
}

// "VALUE", "VALUE=LABEL", "seen:VALUE=LABEL".
CurveMark parse_mark(const std::string& text) {
  CurveMark mark;
  const size_t equals = std::min(text.find('='), text.size()), colon = text.find(':');
  if (equals < text.size()) mark.label = text.substr(equals + 1);
  const size_t begin = colon < equals ? colon + 1 : 0;
  if (begin > 0) mark.part = text.substr(0, colon);
  constexpr char kExpected[] = "expected VALUE=LABEL, seen:VALUE=LABEL or unseen:VALUE=LABEL";
  if (begin > 0 && mark.part != "seen" && mark.part != "unseen") throw std::invalid_argument(kExpected);
  mark.value = number(text.substr(begin, equals - begin), kExpected);
  return mark;
}

void parse_size(const std::string& text, CurvesStyle& style) {
  constexpr char kExpected[] = "expected WIDTHxHEIGHT in points, such as 380x270, each from 20 to 10000";
  const size_t cross = text.find('x');
  if (cross == std::string::npos) throw std::invalid_argument(kExpected);
  style.width_pt = number(text.substr(0, cross), kExpected);
  style.height_pt = number(text.substr(cross + 1), kExpected);
  if (std::min(style.width_pt, style.height_pt) < 20 || std::max(style.width_pt, style.height_pt) > 10000)
    throw std::invalid_argument(kExpected);
}

struct LogFile {
  std::string path, label;
  bool labelled;
};

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

// FILE, LABEL=FILE[,FILE]..., or LABEL= in front of FILEs. Where there is a file of just that name, it is meant.
std::vector<LogFile> parse_operands(std::vector<std::string> operands) {
  std::vector<LogFile> files;
  if (operands.empty()) operands.push_back("-");
  std::string label;
  bool labelled = false;  // by an operand LABEL=
  for (const std::string& operand : operands) {
    const size_t equals = operand.find('=');
    if (equals == std::string::npos || is_file(operand)) {
      files.push_back({operand, label, labelled});
      continue;
    }
    label = operand.substr(0, equals);
    labelled = equals + 1 == operand.size();
    if (label.empty()) fail(Exit::kUsage, "the operand ", quoted(operand), " has no label before the =");
    if (labelled) continue;
    for (size_t begin = equals + 1; begin <= operand.size();) {
      size_t end = std::min(operand.find(',', begin), operand.size());
      if (is_file(operand.substr(begin))) end = operand.size();
      if (begin == end) fail(Exit::kUsage, "the operand ", quoted(operand), " names an empty file");
      files.push_back({operand.substr(begin, end - begin), label, true});
      begin = end + 1;
    }
  }
  if (files.empty()) fail(Exit::kUsage, "no file follows the label ", quoted(operands.back()));
  if (std::count_if(files.begin(), files.end(), [](const LogFile& file) { return file.path == "-"; }) > 1)
    fail(Exit::kUsage, "standard input can be read only once");
  return files;
}

// A file without a label has its own name, or its path where another file has that name as well; a file alone needs none.
void name_files(std::vector<LogFile>& files) {
  const auto stem = [](const LogFile& file) {
    return file.path == "-" ? "standard input" : std::filesystem::path(file.path).stem().string();
  };
  const auto takes = [&](const LogFile& file, const std::string& name) { return (file.labelled ? file.label : stem(file)) == name; };
  for (LogFile& file : files)
    if (!file.labelled && files.size() > 1) {
      const auto takers = std::count_if(files.begin(), files.end(), [&](const LogFile& other) { return takes(other, stem(file)); });
      file.label = takers > 1 ? file.path : stem(file);
    }
}

// The curves of one log, one for each part; empty where a part has no values.
std::vector<Curve> read_curves(const LogFile& file, RunLogAxis axis, double unit, const Measure& measure, const std::string& name) {
  Input input(file.path);
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
         measure.parts[0].empty() ? "" : ": synpo-train evaluates with --evaluate-every");
  return curves;
}

}  // namespace

int curves(int argc, char** argv) {
  CurvesStyle style;
  PictureOptions picture;
  std::string x = "updates", y = "success", pairs = "both";
  double rate = 0;
  const auto one_of = [](std::string& value, std::vector<std::string> words) {
    return [&value, words](const std::string& given) {
      if (std::find(words.begin(), words.end(), given) == words.end()) {
        std::string expected = "expected " + words[0];
        for (size_t i = 1; i < words.size(); ++i) expected += (i + 1 < words.size() ? ", " : " or ") + words[i];
        throw std::invalid_argument(expected);
      }
      value = given;
    };
  };
  std::string band = "sd";
  Options options("synpo-render curves", "[OPTION]... [[LABEL=]LOG[,LOG]...]...",
                  "Draws run logs as curves. Logs of one label are runs of one method: their mean, and a band around it.");
  options.call('x', "across", "AXIS", "updates, states or minutes [updates]", one_of(x, {"updates", "states", "minutes"}))
      .text('y', "up", "COLUMN", "success, reward, reward_loss, or any column of the log", y)
      .call(0, "pairs", "WHICH", "seen, unseen or both [both]", one_of(pairs, {"seen", "unseen", "both"}))
      .integer(0, "panels", "N", "1: seen dashed, unseen drawn through; 2: side by side; 0: 2 for several methods", style.panels, 0, 2)
      .call(0, "band", "KIND", "over the runs: sd, range (lowest to highest) or none [sd]", one_of(band, {"sd", "range", "none"}))
      .real(0, "rate", "X", "states per second, from which minutes are computed; 0: the log's clock", rate, 0, 1e12)
      .call(0, "mark", "Y=LABEL", "a dotted line across; seen:Y=LABEL, unseen:Y=LABEL for these pairs alone; repeatable",
            [&](const std::string& text) { style.marks.push_back(parse_mark(text)); })
      .call(0, "x-range", "LOW:HIGH", "ends of the axis across, in updates, states or minutes",
            [&](const std::string& text) { style.x = parse_range(text); })
      .call(0, "y-range", "LOW:HIGH", "ends of the axis up; in percent for rates",
            [&](const std::string& text) { style.y = parse_range(text); })
      .text(0, "title", "TEXT", "title above the picture", style.title)
      .call(0, "size", "WxH", "width and height in points [380x270, 620x270 for two panels]",
            [&](const std::string& text) { parse_size(text, style); });
  picture.add_to(options);
  std::vector<LogFile> files = parse_operands(options.parse(argc, argv, 0, 1000));
  name_files(files);
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
  style.x_title = x;
  style.y_title = measure.title;
  style.percent = measure.percent;
  const RunLogAxis axis = x == "updates" ? RunLogAxis::kUpdates : x == "states" || rate > 0 ? RunLogAxis::kStates : RunLogAxis::kMinutes;

  Output output(picture.output, Output::Kind::kBinary, picture.force);
  const Font font(picture.font);
  std::vector<MethodRuns> methods;
  for (const LogFile& file : files) {
    auto method = std::find_if(methods.begin(), methods.end(), [&](const MethodRuns& other) { return other.label == file.label; });
    if (method == methods.end()) method = methods.insert(methods.end(), {file.label, {}});
    method->runs.push_back(read_curves(file, axis, rate > 0 ? 1 / rate / 60 : 1, measure, y));
  }
  finish(output, draw_curves(average_runs(methods, measure.parts, style.band), style, font));
  return 0;
}
