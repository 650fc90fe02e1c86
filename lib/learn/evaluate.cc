#include "learn/evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "learn/running_episode.h"
#include "nn/loss.h"
#include "nn/softmax.h"

namespace synpo {
namespace {

constexpr int kLanes = Policy<float>::kInferenceUnit;

// One running episode.
struct Lane {
  size_t job;  // in the list of episodes
  Episode played;
  RunningEpisode running;
  std::vector<int> rewards;
  int64_t reward_cents = 0;
};

// The best action, or one drawn from softmax(scores / temperature) where that is over 0; uniform() gives a number in [0, 1).
template <class Uniform>
int choose(const float* scores, int actions, double temperature, Uniform&& uniform) {
  if (temperature == 0) return argmax(scores, actions);
  std::array<double, kMostActions> p;
  softmax(scores, actions, temperature, p.data());
  return draw(p.data(), actions, uniform());
}

}  // namespace

void PairResult::add(const PairResult& other) {
  episodes += other.episodes;
  successes += other.successes;
  wrong += other.wrong;
  timeouts += other.timeouts;
  reward_cents += other.reward_cents;
  length += other.length;
}

std::vector<PairResult> evaluate(Parallel& parallel, Policy<float>& policy, const World& world, const std::vector<EnvTask>& pairs,
                                 const std::vector<EvalEpisode>& episodes, const EvalOptions& options, const EpisodeSink& sink,
                                 const std::function<void(size_t)>& progress) {
  // Shards keep their lanes filled from a list of their own. Few long lists waste little at their ends.
  const int total = int(episodes.size()), actions = world.actions();
  const size_t observation = world.observation_size();
  const int size = std::clamp(shard_count(total, 16), kLanes, 2048);
  const int shards = shard_count(total, size);
  std::vector<std::vector<PairResult>> results(shards);
  std::vector<std::vector<Trajectory>> records(sink ? shards : 0);
  std::mutex mutex;
  size_t done = 0;
  int next_to_write = 0;
  std::vector<bool> finished(shards, false);

  parallel.run(shards, [&](int shard, int thread) {
    const Range range = shard_range(total, size, shard);
    std::vector<PairResult>& result = results[shard];
    result.resize(pairs.size());
    std::vector<Trajectory> record(sink ? range.size() : 0);
    std::vector<uint8_t> observations(kLanes * observation);
    std::vector<float> logits(size_t(kLanes) * actions);
    std::vector<int> pair_of(kLanes, 0);
    std::vector<Lane> lanes;
    size_t next = size_t(range.begin);
    const auto start = [&](Lane& lane) {
      const EvalEpisode& job = episodes[next];
      const EnvTask pair = pairs[job.pair];
      lane = Lane{next++, {pair, episode_start(world, pair, options.seed, Purpose::kEvaluation, job.number), {}, {}}, {}, {}, 0};
      lane.running.start(pair, lane.played.start);
    };
    while (lanes.size() < kLanes && next < size_t(range.end)) start(lanes.emplace_back());
    while (!lanes.empty()) {
      for (size_t i = 0; i < lanes.size(); ++i) {
        world.observe(lanes[i].running.pair.env, lanes[i].running.history, options.window, observations.data() + i * observation);
        pair_of[i] = episodes[lanes[i].job].pair;
      }
      policy.infer(thread, int(lanes.size()), observations.data(), pair_of.data(), logits.data());
      for (size_t i = 0; i < lanes.size();) {
        Lane& lane = lanes[i];
        const EnvTask pair = lane.running.pair;
        const int action = choose(logits.data() + i * actions, actions, options.temperature, [&] {
          const EvalEpisode& job = episodes[lane.job];
          return Random(options.seed, Purpose::kSample, world.pair_number(pair), uint64_t(job.number) << 16 | lane.running.now().steps).uniform();
        });
        if (sink) {
          lane.played.labels.push_back(uint8_t(world.expert(pair, lane.running.now())));
          lane.played.actions.push_back(uint8_t(action));
        }
        const WorldStep step = lane.running.step(world, action);
        lane.reward_cents += step.reward_cents;
        if (sink) lane.rewards.push_back(step.reward_cents);
        if (!step.ended()) {
          ++i;
          continue;
        }
        result[pair_of[i]].add({1, step.success, step.wrong, step.truncated, lane.reward_cents, lane.running.now().steps});
        if (sink)
          record[lane.job - range.begin] = to_trajectory(world, lane.played, lane.rewards, step, options.seed, episodes[lane.job].number, options.window);
        if (progress) {
          std::lock_guard lock(mutex);
          progress(++done);
        }
        if (next < size_t(range.end)) {
          start(lane);
          ++i;
        } else {
          // The last lane takes this one's place, and its scores: it has not moved yet.
          std::copy_n(logits.data() + (lanes.size() - 1) * actions, actions, logits.data() + i * actions);
          pair_of[i] = pair_of[lanes.size() - 1];
          if (i + 1 < lanes.size()) lane = std::move(lanes.back());
          lanes.pop_back();
        }
      }
    }
    if (!sink) return;
    std::lock_guard lock(mutex);
    records[shard] = std::move(record);
    finished[shard] = true;
    for (; next_to_write < shards && finished[next_to_write]; ++next_to_write) {
      for (const Trajectory& trajectory : records[next_to_write]) sink(trajectory);
      records[next_to_write] = {};
    }
  });
  std::vector<PairResult> sum(pairs.size());
  for (const auto& result : results)
    for (size_t p = 0; p < pairs.size(); ++p) sum[p].add(result[p]);
  return sum;
}

RunLogRow::Evaluation evaluate_sample(Parallel& parallel, const World& world, const Model& model, const float* parameters, const float* statistics,
                                      int episodes) {
  std::vector<EnvTask> groups[2];  // unseen, seen
  for (int env = 0; env < world.envs(); ++env)
    for (int task = 0; task < world.task_count(); ++task) groups[model.is_seen({env, task})].push_back({env, task});
  double success[2], reward[2];
  for (int seen = 0; seen < 2; ++seen) {
    success[seen] = reward[seen] = std::nan("");
    if (groups[seen].empty()) continue;
    std::vector<std::pair<int, int>> pairs;
    for (const EnvTask& pair : groups[seen]) pairs.emplace_back(pair.env, pair.task);
    std::vector<EvalEpisode> jobs;
    Random random(model.seed, Purpose::kEvaluationPairs, uint64_t(seen));
    for (int i = 0; i < episodes; ++i) jobs.push_back({int(random.below(uint32_t(pairs.size()))), i});
    model.policy->prepare_inference(parallel, parameters, statistics, pairs);
    PairResult sum;
    for (const PairResult& result :
         evaluate(parallel, *model.policy, world, groups[seen], jobs, {model.seed, model.window, model.policy->temperature()}))
      sum.add(result);
    success[seen] = double(sum.successes) / sum.episodes;
    reward[seen] = sum.reward_cents / 100.0 / sum.episodes;
  }
  return {success[1], reward[1], success[0], reward[0]};
}

}  // namespace synpo
