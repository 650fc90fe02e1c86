#include "play/episode.h"

#include <cstdio>
#include <utility>

#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"

namespace synpo {
namespace {

std::string money(int cents) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", cents / 100.0);
  return text;
}

}  // namespace

WorldState episode_start(const World& world, EnvTask pair, uint64_t seed, Purpose purpose, int64_t episode) {
  Random random(seed, purpose, world.pair_number(pair), uint64_t(episode));
  return world.reset(pair.env, random);
}

void EpisodeRecord::add(int label, int action, const WorldStep& step) {
  episode.labels.push_back(uint8_t(label));
  episode.actions.push_back(uint8_t(action));
  reward_cents.push_back(step.reward_cents);
  last = step;
}

Trajectory to_trajectory(const World& world, const EpisodeRecord& record, uint64_t seed, int64_t number, int window) {
  const Episode& episode = record.episode;
  const Environment& env = world.environments()[episode.pair.env];
  Trajectory t;
  t.world = world.name();
  t.rules = world.rules();
  t.env = env.name;
  t.task = world.task_names()[episode.pair.task];
  t.env_hash = env.hash;
  t.window = window;
  t.seed = seed;
  t.episode = number;
  t.start = world.start_places(episode.pair.env, episode.start);
  t.actions = episode.actions;
  if (episode.labels != episode.actions) t.labels = episode.labels;
  t.reward_cents = record.reward_cents;
  t.success = record.last.success;
  t.terminated = record.last.terminated;
  t.truncated = record.last.truncated;
  t.policy = record.policy;
  return t;
}

Trajectory expert_episode(const World& world, EnvTask pair, uint64_t seed, int64_t episode, double noise, int window) {
  Random random(seed, Purpose::kNoise, world.pair_number(pair), uint64_t(episode));
  WorldState state = episode_start(world, pair, seed, Purpose::kEpisodeStart, episode);
  EpisodeRecord record(pair, state);
  while (!record.last.ended()) {
    const int label = world.expert(pair, state);
    const int action = noise > 0 && random.uniform() < noise ? int(random.below(uint32_t(world.moves()))) : label;
    record.add(label, action, world.step(pair, state, action));
  }
  return to_trajectory(world, record, seed, episode, window);
}

Episode replay(const World& world, const Trajectory& t) {
  if (t.world != world.name()) fail(Exit::kData, "world ", quoted(t.world), ", expected ", quoted(world.name()));
  if (t.rules != world.rules()) fail(Exit::kData, "rules version ", t.rules, ", this build has ", world.rules());
  const EnvTask pair = {world.env_index(t.env), world.task_index(t.task)};
  if (pair.env < 0) fail(Exit::kData, kOtherWorld, "unknown env ", quoted(t.env));
  if (pair.task < 0) fail(Exit::kData, "unknown task ", quoted(t.task));
  if (t.env_hash != world.environments()[pair.env].hash)
    fail(Exit::kData, kOtherWorld, "env ", quoted(t.env), " is not the one of that name here");
  for (const auto& [name, list] : {std::pair{"actions", &t.actions}, {"labels", &t.labels}})
    for (const uint8_t action : *list)
      if (action >= world.actions())
        fail(Exit::kData, "field '", name, "': found '", int(action), "', expected a whole number from 0 to ",
             world.actions() - 1);
  Episode episode = {pair, world.start_state(pair.env, t.start), t.actions, t.labels.empty() ? t.actions : t.labels};
  WorldState state = episode.start;
  for (size_t i = 0; i < t.actions.size(); ++i) {
    const WorldStep step = world.step(pair, state, t.actions[i]);
    if (step.reward_cents != t.reward_cents[i])
      fail(Exit::kData, "replay gives reward ", money(step.reward_cents), " at step ", i + 1, ", file says ",
           money(t.reward_cents[i]), ": other maps?");
    const bool last = i + 1 == t.actions.size();
    if (step.ended() && !last) fail(Exit::kData, "replay ends at step ", i + 1, ", file goes on to ", t.actions.size());
    if (last && (step.terminated != t.terminated || step.truncated != t.truncated || step.success != t.success))
      fail(Exit::kData, "replay and file differ in success, terminated or truncated");
  }
  return episode;
}

Trajectory relabelled(const World& world, const Trajectory& trajectory) {
  const Episode episode = replay(world, trajectory);
  Trajectory out = trajectory;
  out.labels.clear();
  WorldState state = episode.start;
  for (const uint8_t action : episode.actions) {
    out.labels.push_back(uint8_t(world.expert(episode.pair, state)));
    world.step(episode.pair, state, action);
  }
  if (out.labels == out.actions) out.labels.clear();
  return out;
}

std::vector<EnvTask> resolve_pairs(const World& world, const std::vector<PairRow>& rows, bool seen_only,
                                   const std::string& file) {
  std::vector<EnvTask> pairs;
  for (const PairRow& row : rows) {
    const EnvTask pair = {world.env_index(row.env), world.task_index(row.task)};
    const auto unknown = [&](const char* what, const std::string& name, const std::vector<std::string>& known) {
      return concat(file, row.line > 0 ? concat(": line ", row.line) : "", ": found the ", what, " ", quoted(name),
                    ", expected one of the world ", quoted(world.name()), ", such as ", quoted(known.front()));
    };
    if (pair.env < 0) {
      const std::string words = unknown("env", row.env, world.env_names()),
                        guess = did_you_mean(row.env, world.env_names());
      if (guess.empty()) fail(Exit::kData, kOtherWorld, words);
      fail(Exit::kData, words, guess);
    }
    if (pair.task < 0)
      fail(Exit::kData, unknown("task", row.task, world.task_names()), did_you_mean(row.task, world.task_names()));
    if (row.seen || !seen_only) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<PairRow> all_pairs(const World& world) {
  std::vector<PairRow> rows;
  for (const Environment& env : world.environments())
    for (const std::string& task : world.task_names()) rows.push_back({env.name, task, false, ""});
  return rows;
}

std::vector<PairRow> read_pairs(const std::string& path) {
  Input input(path);
  return read_pairs(input);
}

std::vector<EnvTask> read_seen_pairs(const World& world, const std::string& path) {
  std::vector<EnvTask> pairs = resolve_pairs(world, read_pairs(path), true, path);
  if (pairs.empty()) fail(Exit::kData, "no pair with seen = 1 in '", path, "'");
  return pairs;
}

Trajectory ExpertStream::trajectory(const World& world, int64_t number) const {
  if (per_pair > 0)
    return expert_episode(world, pairs[size_t(number / per_pair)], seed, number % per_pair, noise, window);
  Random random(seed, Purpose::kPairOrder, 0, uint64_t(number));
  return expert_episode(world, pairs[random.below(uint32_t(pairs.size()))], seed, number, noise, window);
}

}  // namespace synpo
