#include "play/evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

#include "base/error.h"
#include "nn/loss.h"
#include "nn/softmax.h"
#include "play/running_episode.h"

namespace synpo {
namespace {

constexpr int kLanes = Policy<float>::kInferenceUnit;

// One running episode.
struct Lane {
  int job = 0;  // in the list of episodes
  Episode played;
  RunningEpisode running;
  std::vector<int> rewards;
  int64_t reward_cents = 0;
};

// The best action, or one drawn from softmax(scores / temperature) where that is over 0; uniform() gives a number in
// [0, 1).
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

std::vector<PairResult> evaluate(Parallel& parallel, Policy<float>& policy, const World& world,
                                 const std::vector<EnvTask>& pairs, const std::vector<EvalEpisode>& episodes,
                                 const EvalOptions& options, const EpisodeSink& sink,
                                 const std::function<void(size_t)>& progress) {
  if (episodes.size() > size_t(INT32_MAX))
    fail(Exit::kUsage, "found ", episodes.size(), " episodes, expected at most ", INT32_MAX);
  // Every thread keeps its lanes filled from one list, so that batches are small at its end alone.
  const int total = int(episodes.size()), actions = world.actions(), threads = parallel.threads();
  const size_t observation = world.observation_size(),
               most = size_t(std::clamp((total + threads - 1) / threads, 1, kLanes));
  std::mutex mutex;  // of what follows
  int next = 0, done = 0, written = 0;
  std::map<int, Trajectory> waiting;  // for those before them
  std::vector<PairResult> results(pairs.size());
  const auto take = [&] {
    std::lock_guard lock(mutex);
    return next < total ? next++ : -1;
  };
  const auto finish = [&](const Lane& lane, const WorldStep& last) {
    const EvalEpisode& job = episodes[size_t(lane.job)];
    Trajectory trajectory;
    if (sink)
      trajectory = to_trajectory(world, lane.played, lane.rewards, last, options.seed, job.number, options.window);
    std::lock_guard lock(mutex);
    results[size_t(job.pair)].add(
        {1, last.success, last.wrong, last.truncated, lane.reward_cents, lane.running.now().steps});
    ++done;
    try {
      if (progress) progress(size_t(done));
      if (!sink) return;
      waiting.emplace(lane.job, std::move(trajectory));
      for (; !waiting.empty() && waiting.begin()->first == written; ++written)
        sink(waiting.extract(waiting.begin()).mapped());
    } catch (...) {
      next = total;  // the other threads need not begin what nobody will see
      throw;
    }
  };

  parallel.run(threads, [&](int, int thread) {
    std::vector<uint8_t> observations(most * observation);
    std::vector<float> logits(most * size_t(actions));
    std::vector<int> pair_of(most);
    std::vector<Lane> lanes;
    const auto start = [&](Lane& lane) {
      const int number = take();
      if (number < 0) return false;
      const EvalEpisode& job = episodes[size_t(number)];
      const EnvTask pair = pairs[size_t(job.pair)];
      lane = {number,
              {pair, episode_start(world, pair, options.seed, Purpose::kEvaluation, job.number), {}, {}},
              {},
              {},
              0};
      lane.running.start(pair, lane.played.start);
      return true;
    };
    for (Lane lane; lanes.size() < most && start(lane);) lanes.push_back(lane);
    while (!lanes.empty()) {
      for (size_t i = 0; i < lanes.size(); ++i) {
        world.observe(lanes[i].running.pair.env, lanes[i].running.history, options.window,
                      observations.data() + i * observation);
        pair_of[i] = episodes[size_t(lanes[i].job)].pair;
      }
      policy.infer(thread, int(lanes.size()), observations.data(), pair_of.data(), logits.data());
      for (size_t i = 0; i < lanes.size();) {
        Lane& lane = lanes[i];
        const EnvTask pair = lane.running.pair;
        const int action = choose(logits.data() + i * actions, actions, options.temperature, [&] {
          const int64_t number = episodes[size_t(lane.job)].number;
          return Random(options.seed, Purpose::kSample, world.pair_number(pair),
                        uint64_t(number) << 16 | lane.running.now().steps)
              .uniform();
        });
        if (sink) {
          lane.played.labels.push_back(uint8_t(world.expert(pair, lane.running.now())));
          lane.played.actions.push_back(uint8_t(action));
        }
        const WorldStep step = lane.running.step(world, action);
        lane.reward_cents += step.reward_cents;
        if (sink) lane.rewards.push_back(step.reward_cents);
        if (step.ended()) {
          finish(lane, step);
          if (!start(lane)) {
            // The last lane takes this one's place, and its scores: it has not moved yet.
            std::copy_n(logits.data() + (lanes.size() - 1) * actions, actions, logits.data() + i * actions);
            if (i + 1 < lanes.size()) lane = std::move(lanes.back());
            lanes.pop_back();
            continue;
          }
        }
        ++i;
      }
    }
  });
  return results;
}

RunLogRow::Evaluation evaluate_sample(Parallel& parallel, const World& world, const Model& model,
                                      const float* parameters, const float* statistics, int episodes) {
  std::vector<bool> env_met(size_t(world.envs())), task_met(size_t(world.task_count()));
  for (const EnvTask& pair : model.seen) env_met[size_t(pair.env)] = task_met[size_t(pair.task)] = true;
  std::vector<EnvTask> groups[2];  // unseen, seen
  for (int env = 0; env < world.envs(); ++env)
    for (int task = 0; task < world.task_count(); ++task)
      if (env_met[size_t(env)] && task_met[size_t(task)]) groups[model.is_seen({env, task})].push_back({env, task});
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
    for (const PairResult& result : evaluate(parallel, *model.policy, world, groups[seen], jobs,
                                             {model.seed, model.window, model.policy->temperature()}))
      sum.add(result);
    success[seen] = double(sum.successes) / sum.episodes;
    reward[seen] = sum.reward_cents / 100.0 / sum.episodes;
  }
  return {success[1], reward[1], success[0], reward[0]};
}

}  // namespace synpo
