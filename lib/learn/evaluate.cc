#include "learn/evaluate.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "nn/loss.h"
#include "world/view.h"

namespace synpo {
namespace {

constexpr int kLanes = Policy<float>::kInferenceUnit;

// One running episode.
struct Lane {
  size_t job;  // in the list of episodes
  GridEpisode played;
  GridState state;
  GridHistory history;
  std::vector<int> rewards;
  int64_t reward_cents = 0;
};

// The best action, or one drawn from softmax(scores / temperature) where that is over 0; uniform() gives a number in [0, 1).
template <class Uniform>
int choose(const float* scores, double temperature, Uniform&& uniform) {
  if (temperature == 0) return argmax(scores, kGridActions);
  const float top = *std::max_element(scores, scores + kGridActions);
  double weight[kGridActions], sum = 0;
  for (int a = 0; a < kGridActions; ++a) sum += weight[a] = std::exp((scores[a] - top) / temperature);
  double left = uniform() * sum;
  for (int a = 0; a < kGridActions - 1; ++a)
    if ((left -= weight[a]) < 0) return a;
  return kGridActions - 1;
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

std::vector<PairResult> evaluate(Parallel& parallel, Policy<float>& policy, const GridSet& world, const std::vector<EnvTask>& pairs,
                                 const std::vector<EvalEpisode>& episodes, const EvalOptions& options, const EpisodeSink& sink,
                                 const std::function<void(size_t)>& progress) {
  // Shards keep their lanes filled from a list of their own. Few long lists waste little at their ends.
  const int total = int(episodes.size());
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
    std::vector<uint8_t> pictures(size_t(kLanes) * kGridCells * kHistory);
    std::vector<float> logits(size_t(kLanes) * kGridActions);
    std::vector<int> pair_of(kLanes, 0);
    std::vector<Lane> lanes;
    size_t next = size_t(range.begin);
    const auto start = [&](Lane& lane) {
      const EvalEpisode& job = episodes[next];
      lane = Lane{next++, {pairs[job.pair], {}, {}, {}}, {}, {}, {}, 0};
      lane.state = lane.played.start = episode_start(world, pairs[job.pair], options.seed, Purpose::kEvaluation, job.number);
      lane.history.push(lane.state.now);
    };
    while (lanes.size() < kLanes && next < size_t(range.end)) start(lanes.emplace_back());
    while (!lanes.empty()) {
      for (size_t i = 0; i < lanes.size(); ++i) {
        const EnvTask pair = lanes[i].played.pair;
        draw_history(world.maze(pair.env), lanes[i].history, options.window, pictures.data() + i * kGridCells * kHistory);
        pair_of[i] = episodes[lanes[i].job].pair;
      }
      policy.infer(thread, int(lanes.size()), pictures.data(), pair_of.data(), logits.data());
      for (size_t i = 0; i < lanes.size();) {
        Lane& lane = lanes[i];
        const EnvTask pair = lane.played.pair;
        const Task& task = world.tasks()[pair.task];
        const int action = choose(logits.data() + i * kGridActions, options.temperature, [&] {
          const EvalEpisode& job = episodes[lane.job];
          return Random(options.seed, Purpose::kSample, world.pair_number(pair.env, pair.task), uint64_t(job.number) << 16 | lane.state.steps).uniform();
        });
        if (sink) {
          lane.played.labels.push_back(uint8_t(world.planner(pair.env).action(task, lane.state)));
          lane.played.actions.push_back(uint8_t(action));
        }
        GridStep step = grid_step(world.maze(pair.env), task, lane.state, action);
        if (lane.state.steps >= options.step_limit && !step.terminated) step.truncated = true;
        lane.reward_cents += step.reward_cents;
        if (sink) lane.rewards.push_back(step.reward_cents);
        lane.history.push(lane.state.now);
        if (!step.ended()) {
          ++i;
          continue;
        }
        result[pair_of[i]].add({1, step.success, step.wrong_pick, step.truncated, lane.reward_cents, lane.state.steps});
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
          std::copy_n(logits.data() + (lanes.size() - 1) * kGridActions, kGridActions, logits.data() + i * kGridActions);
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

RunLogRow::Evaluation evaluate_sample(Parallel& parallel, const GridSet& world, const Model& model, const float* parameters, const float* statistics,
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
         evaluate(parallel, *model.policy, world, groups[seen], jobs, {model.seed, model.window, kGridStepLimit, model.policy->temperature()}))
      sum.add(result);
    success[seen] = double(sum.successes) / sum.episodes;
    reward[seen] = sum.reward_cents / 100.0 / sum.episodes;
  }
  return {success[1], reward[1], success[0], reward[0]};
}

}  // namespace synpo
