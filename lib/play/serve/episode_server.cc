#include "play/serve/episode_server.h"

#include <bit>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/random.h"
#include "play/episode.h"

namespace synpo {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kFormat[] = "synpo-play";
constexpr int kVersion = 1;
constexpr uint32_t kMostPlaces = 65536;
constexpr Purpose kStarts[] = {Purpose::kEpisodeStart, Purpose::kEvaluation, Purpose::kTrainingStart};

enum Request : char { kReset = 'r', kStep = 's', kExpert = 'x' };
enum Flag : uint8_t { kSuccess = 1, kTerminated = 2, kTruncated = 4 };

static_assert(std::endian::native == std::endian::little, "numbers are sent as they lie in memory");

template <class T>
void take(Input& input, T* to, size_t count) {
  const size_t size = count * sizeof(T), got = input.read(to, size);
  if (got < size) fail(Exit::kData, input.name(), ": it ends at byte ", input.offset(), ", in the middle of a request");
}

template <class T>
T take(Input& input) {
  T value;
  take(input, &value, 1);
  return value;
}

template <class T>
void send(Output& output, const std::vector<T>& values) {
  output.write({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

[[noreturn]] void wrong(const Input& input, const char* what, uint64_t found, uint64_t most) {
  fail(Exit::kData, input.name(), ": byte ", input.offset(), ": ", what, ": found ", found,
       ", expected a whole number from 0 to ", most);
}

}  // namespace

EpisodeServer::EpisodeServer(const World& world, std::vector<EnvTask> pairs, int window)
    : world_(world), pairs_(std::move(pairs)), window_(window), episodes_(world) {}

std::string EpisodeServer::greeting() const {
  Json out;
  out["format"] = kFormat;
  out["version"] = kVersion;
  out["world"] = world_.name();
  out["rules"] = world_.rules();
  out["window"] = window_;
  out["step_limit"] = kStepLimit;
  Json& envs = out["envs"] = Json::array();
  for (const Environment& env : world_.environments()) envs.push_back({{"name", env.name}, {"hash", hex(env.hash)}});
  out["tasks"] = world_.task_names();
  out["actions"] = world_.action_names();
  Json& pairs = out["pairs"] = Json::array();
  for (const EnvTask& pair : pairs_) pairs.push_back({pair.env, pair.task});
  const ObservationSpec& spec = world_.observation_spec();
  Json& observation = out["observation"];
  observation["bytes"] = spec.bytes();
  observation["history"] = kHistory;
  if (spec.sight == Sight::kPictures) {
    observation["side"] = spec.side;
    Json& palette = observation["palette"] = Json::array();
    for (const Rgb& colour : spec.palette) palette.push_back({colour.r, colour.g, colour.b});
  } else {
    observation["view"] = spec.view;
    observation["objects"] = spec.objects;
    observation["extractor"] = world_.extractor();
  }
  return out.dump() + "\n";
}

void EpisodeServer::serve(Input& input, Output& output) {
  output.write(greeting());
  output.flush();
  for (char request; input.read(&request, 1) == 1; output.flush()) {
    if (request == kReset)
      reset(input, output);
    else if (request == kStep)
      step(input, output);
    else if (request == kExpert)
      expert(input, output);
    else
      fail(Exit::kData, input.name(), ": byte ", input.offset(), ": found the request ", int(uint8_t(request)),
           ", expected r, s or x");
  }
}

void EpisodeServer::reset(Input& input, Output& output) {
  const auto place = take<uint32_t>(input), env = take<uint32_t>(input), task = take<uint32_t>(input);
  const auto seed = take<uint64_t>(input), number = take<uint64_t>(input);
  const auto starts = take<uint8_t>(input);
  if (place >= kMostPlaces) wrong(input, "the place", place, kMostPlaces - 1);
  if (env >= uint32_t(world_.envs())) wrong(input, "the environment", env, uint32_t(world_.envs()) - 1);
  if (task >= uint32_t(world_.task_count())) wrong(input, "the task", task, uint32_t(world_.task_count()) - 1);
  if (number > uint64_t(INT64_MAX)) wrong(input, "the episode", number, INT64_MAX);
  if (starts >= std::size(kStarts)) wrong(input, "the use", starts, std::size(kStarts) - 1);
  if (place >= uint32_t(episodes_.size())) {
    episodes_.resize(int(place) + 1);
    running_.resize(place + 1);
  }
  const EnvTask pair = {int(env), int(task)};
  episodes_[int(place)].start(pair, episode_start(world_, pair, seed, kStarts[starts], int64_t(number)));
  running_[place] = true;
  write_observations({int(place)}, output);
}

void EpisodeServer::step(Input& input, Output& output) {
  const std::vector<int> places = read_running(input);
  std::vector<uint8_t> actions(places.size()), flags;
  take(input, actions.data(), actions.size());
  for (const uint8_t action : actions)
    if (action >= world_.actions()) wrong(input, "an action", action, uint64_t(world_.actions()) - 1);
  std::vector<int32_t> rewards;
  for (size_t i = 0; i < places.size(); ++i) {
    check_running(input, uint32_t(places[i]));  // a place that is there twice may have ended
    const WorldStep step = episodes_[places[i]].step(world_, actions[i]);
    rewards.push_back(step.reward_cents);
    flags.push_back(uint8_t(step.success * kSuccess | step.terminated * kTerminated | step.truncated * kTruncated));
    running_[size_t(places[i])] = !step.ended();
  }
  send(output, rewards);
  send(output, flags);
  write_observations(places, output);
}

void EpisodeServer::expert(Input& input, Output& output) {
  std::vector<uint8_t> labels;
  for (const int place : read_running(input))
    labels.push_back(uint8_t(world_.expert(episodes_[place].pair, episodes_[place].now())));
  send(output, labels);
}

// A number, and so many places, in each of which an episode goes on.
std::vector<int> EpisodeServer::read_running(Input& input) {
  const auto count = take<uint32_t>(input);
  if (count > uint32_t(episodes_.size())) wrong(input, "the number of places", count, uint64_t(episodes_.size()));
  std::vector<uint32_t> places(count);
  take(input, places.data(), places.size());
  for (const uint32_t place : places) check_running(input, place);
  return {places.begin(), places.end()};
}

void EpisodeServer::check_running(const Input& input, uint32_t place) const {
  if (place >= running_.size() || !running_[place])
    fail(Exit::kData, input.name(), ": byte ", input.offset(), ": no episode goes on in the place ", place);
}

void EpisodeServer::write_observations(const std::vector<int>& places, Output& output) {
  std::vector<uint8_t> bytes(places.size() * world_.observation_size());
  episodes_.observe(places, window_, bytes.data());
  send(output, bytes);
}

}  // namespace synpo
