#include "format/trajectory.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "format/json_text.h"
#include "format/kind.h"

namespace synpo {
namespace {

using Json = nlohmann::json;

constexpr char kFormat[] = "synpo-trajectory", kEndFormat[] = "synpo-end";
constexpr int kPlaceLimit = 1 << 20;

const Json& need(const Json& object, const char* field) {
  const auto found = object.find(field);
  if (found == object.end()) fail(Exit::kData, "no field '", field, "'");
  return *found;
}

[[noreturn]] void wrong(const char* field, const Json& found, const std::string& expected) {
  fail(Exit::kData, "field '", field, "': found ", quoted(found.dump(-1, ' ', false, Json::error_handler_t::replace)),
       ", expected ", expected);
}

std::string text(const Json& object, const char* field) {
  const Json& value = need(object, field);
  if (!value.is_string()) wrong(field, value, "a string");
  return value.get<std::string>();
}

// A name, fit to be written again.
std::string name(const Json& object, const char* field) {
  std::string value = text(object, field);
  if (const std::string fault = fault_of_name(value); !fault.empty()) fail(Exit::kData, "field '", field, "': ", fault);
  return value;
}

int64_t whole(const char* field, const Json& value, int64_t low, int64_t high) {
  const bool fits =
      value.is_number_unsigned() ? value.get<uint64_t>() <= uint64_t(INT64_MAX) : value.is_number_integer();
  if (!fits || value.get<int64_t>() < low || value.get<int64_t>() > high)
    wrong(field, value, concat("a whole number from ", low, " to ", high));
  return value.get<int64_t>();
}

bool truth(const Json& object, const char* field) {
  const Json& value = need(object, field);
  if (!value.is_boolean()) wrong(field, value, "true or false");
  return value.get<bool>();
}

std::vector<uint8_t> action_list(const Json& value, const char* field, int step_limit) {
  if (!value.is_array() || value.empty() || value.size() > size_t(step_limit))
    wrong(field, value, concat("an array of 1 to ", step_limit, " actions"));
  std::vector<uint8_t> list;
  list.reserve(value.size());
  for (const Json& action : value) list.push_back(uint8_t(whole(field, action, 0, kMostActions - 1)));
  return list;
}

void check_version(const Json& object) {
  const int64_t version = whole("version", need(object, "version"), 0, INT32_MAX);
  if (version < 1 || version > kTrajectoryVersion)
    fail(Exit::kData, "version ", version, ", this build reads 1 to ", kTrajectoryVersion);
}

// An array for each step, of numbers with as many digits as tell them apart from all others of their type.
template <class T>
void append_steps(std::string& to, const char* name, const std::vector<T>& values, int actions) {
  to += concat(",\"", name, "\":[");
  char text[32];
  for (size_t i = 0; i < values.size(); ++i) {
    if (i % size_t(actions) == 0) to += i == 0 ? "[" : "],[";
    if (i % size_t(actions) != 0) to += ',';
    if (std::isfinite(values[i]))
      to.append(text, std::to_chars(text, text + sizeof text, values[i]).ptr);
    else
      to += "null";
  }
  to += "]]";
}

}  // namespace

std::string format_trajectory(const Trajectory& t) {
  nlohmann::ordered_json line;
  line["format"] = kFormat;
  line["version"] = kTrajectoryVersion;
  line["world"] = t.world;
  line["rules"] = t.rules;
  line["env"] = t.env;
  line["task"] = t.task;
  line["env_hash"] = hex(t.env_hash);
  line["window"] = t.window;
  line["seed"] = t.seed;
  line["episode"] = t.episode;
  nlohmann::ordered_json& start = line["start"];
  for (const auto& [name, place] : t.start) start[name] = {place.first, place.second};
  line["actions"] = t.actions;
  if (!t.labels.empty()) line["labels"] = t.labels;
  std::vector<double> rewards(t.reward_cents.size());
  int64_t sum = 0;
  for (size_t i = 0; i < rewards.size(); ++i) {
    rewards[i] = t.reward_cents[i] / 100.0;
    sum += t.reward_cents[i];
  }
  line["rewards"] = rewards;
  line["return"] = sum / 100.0;
  line["success"] = t.success;
  line["terminated"] = t.terminated;
  line["truncated"] = t.truncated;
  std::string text = line.dump();
  if (t.policy.scores.empty()) return text;
  text.pop_back();
  text += concat(",\"temperature\":", Json(t.policy.temperature).dump());
  append_steps(text, "scores", t.policy.scores, t.policy.actions);
  append_steps(text, "probabilities", t.policy.probabilities, t.policy.actions);
  return text + "}";
}

Trajectory parse_trajectory(const std::string& line, int step_limit) {
  const Json object = [&] {
    try {
      return parse_json(line);
    } catch (const Error& error) {
      fail(error.code(), "found ", line.empty() ? "an empty line" : error.what(), ", expected a JSON object",
           another_kind(line, FileKind::kTrajectories));
    }
  }();
  if (!object.is_object()) fail(Exit::kData, "found ", quoted(line), ", expected a JSON object");
  if (text(object, "format") != kFormat) wrong("format", object["format"], kFormat);
  check_version(object);
  Trajectory t;
  t.world = name(object, "world");
  t.rules = int(whole("rules", need(object, "rules"), 0, INT32_MAX));
  t.env = name(object, "env");
  t.task = name(object, "task");
  t.env_hash = parse_hex(text(object, "env_hash"));
  t.window = int(whole("window", need(object, "window"), 0, 1000));
  const Json& seed = need(object, "seed");
  if (!seed.is_number_unsigned()) wrong("seed", seed, concat("a whole number from 0 to ", UINT64_MAX));
  t.seed = seed.get<uint64_t>();
  t.episode = whole("episode", need(object, "episode"), 0, INT64_MAX);
  const Json& start = need(object, "start");
  if (!start.is_object() || start.size() > 64) wrong("start", start, "an object of places");
  for (const auto& [name, place] : start.items()) {
    if (!place.is_array() || place.size() != 2) wrong("start", place, "[row, column]");
    t.start[name] = {int(whole("start", place[0], -kPlaceLimit, kPlaceLimit)),
                     int(whole("start", place[1], -kPlaceLimit, kPlaceLimit))};
  }
  t.actions = action_list(need(object, "actions"), "actions", step_limit);
  if (object.contains("labels")) t.labels = action_list(object["labels"], "labels", step_limit);
  if (!t.labels.empty() && t.labels.size() != t.actions.size())
    fail(Exit::kData, "found ", t.labels.size(), " labels for ", t.actions.size(), " actions");
  const Json& rewards = need(object, "rewards");
  if (!rewards.is_array() || rewards.size() != t.actions.size())
    wrong("rewards", rewards, concat("an array of ", t.actions.size(), " rewards"));
  t.reward_cents.reserve(rewards.size());
  for (const Json& reward : rewards) {
    const double cents = reward.is_number() ? reward.get<double>() * 100 : NAN;
    if (!(std::abs(cents) < 1e6) || std::abs(cents - std::round(cents)) > 1e-3)
      wrong("rewards", reward, "a multiple of 0.01");
    t.reward_cents.push_back(int(std::lround(cents)));
  }
  t.success = truth(object, "success");
  t.terminated = truth(object, "terminated");
  t.truncated = truth(object, "truncated");
  return t;
}

std::string format_end(uint64_t trajectories) {
  nlohmann::ordered_json line;
  line["format"] = kEndFormat;
  line["version"] = kTrajectoryVersion;
  line["trajectories"] = trajectories;
  return line.dump();
}

bool TrajectoryLines::next(std::string& line) {
  while (input_.line(line)) {
    if (is_end(line)) continue;
    ++count_;
    return true;
  }
  if (ends_ > 0 && said_ != count_)
    fail(Exit::kData, input_.whole_name(), ": found ", count_, " trajectories, expected ", said_,
         ends_ == 1 ? " as its end says" : " as its ends say", ": lines are missing, or some were chosen");
  return false;
}

void TrajectoryLines::check_end() const {
  if (ends_ == 0)
    fail(Exit::kData, kNoEnd, input_.whole_name(), ": it ended after ", count_,
         " trajectories, expected a last line that says its end");
}

// Takes it in.
bool TrajectoryLines::is_end(const std::string& line) {
  if (line.find(kEndFormat) == std::string::npos) return false;
  Json object;
  try {
    object = parse_json(line);
  } catch (const Error&) {
    return false;  // parse_trajectory() will say what it is
  }
  if (!object.is_object() || !object.contains("format") || object["format"] != kEndFormat) return false;
  try {
    check_version(object);
    said_ += uint64_t(whole("trajectories", need(object, "trajectories"), 0, INT64_MAX - int64_t(said_)));
  } catch (const Error& error) {
    input_.bad_line(error);
  }
  ++ends_;
  return true;
}

}  // namespace synpo
