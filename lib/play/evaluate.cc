#include "play/evaluate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/random.h"
#include "nn/buffer.h"
#include "nn/loss.h"
#include "nn/softmax.h"
#include "play/episode.h"
#include "play/episode_batch.h"

namespace synpo {
namespace {

using Probabilities = std::array<double, kMostActions>;

// Those of softmax(scores / temperature) or, where that is 0, of taking the best action.
Probabilities probabilities(const float* scores, int actions, double temperature) {
  Probabilities p;
  if (temperature != 0) {
    softmax(scores, actions, temperature, p.data());
  } else {
    std::fill_n(p.begin(), actions, 0);
    p[size_t(argmax(scores, actions))] = 1;
  }
  return p;
}

// The best action, or one drawn where the temperature is over 0; uniform() gives a number in [0, 1).
template <class Uniform>
int choose(const float* scores, int actions, double temperature, Uniform&& uniform) {
  if (temperature == 0) return argmax(scores, actions);
  return draw(probabilities(scores, actions, temperature).data(), actions, uniform());
}

void note_scores(const float* scores, int actions, double temperature, StepScores& to) {
  const Probabilities p = probabilities(scores, actions, temperature);
  to.actions = actions;
  to.temperature = temperature;
  to.scores.insert(to.scores.end(), scores, scores + actions);
  to.probabilities.insert(to.probabilities.end(), p.begin(), p.begin() + actions);
}

}  // namespace

EpisodePlan listed(std::vector<EvalEpisode> episodes) {
  const auto count = int64_t(episodes.size());
  return {count, [list = std::move(episodes)](int64_t position) { return list[size_t(position)]; }};
}

std::vector<Outcomes> evaluate(Parallel& parallel, Engine& engine, const World& world,
                               const std::vector<EnvTask>& pairs, const EpisodePlan& plan, const EvalOptions& options,
                               const EpisodeSink& sink, const std::function<void(size_t)>& progress) {
  // Every thread keeps its batch filled from one plan, so that batches are small at its end alone.
  const int64_t total = plan.count;
  const int actions = world.actions(), threads = parallel.threads();
  const int most = int(std::clamp<int64_t>((total + threads - 1) / threads, 1, engine.inference_unit()));
  std::mutex mutex;  // of what follows
  int64_t next = 0, done = 0, written = 0;
  std::map<int64_t, Trajectory> waiting;  // for those before them
  std::vector<Outcomes> results(pairs.size());
  const auto take = [&] {
    std::lock_guard lock(mutex);
    return next < total ? next++ : int64_t{-1};
  };
  // An episode of the plan that is being played in a place of a batch.
  struct Job {
    int64_t position = -1;
    EvalEpisode episode = {};
  };
  const auto finish = [&](const Job& job, const Outcomes& outcome, const EpisodeRecord& record) {
    Trajectory trajectory;
    if (sink) trajectory = to_trajectory(world, record, options.seed, job.episode.number, options.window);
    std::lock_guard lock(mutex);
    results[size_t(job.episode.pair)].add(outcome);
    ++done;
    try {
      if (progress) progress(size_t(done));
      if (!sink) return;
      waiting.emplace(job.position, std::move(trajectory));
      for (; !waiting.empty() && waiting.begin()->first == written; ++written)
        sink(waiting.extract(waiting.begin()).mapped());
    } catch (...) {
      next = total;  // the other threads need not begin what nobody will see
      throw;
    }
  };

  parallel.run(threads, [&](int, int thread) {
    EpisodeBatch batch(world, most);
    std::vector<Job> jobs(static_cast<size_t>(most));  // of the places
    std::vector<EpisodeRecord> records(static_cast<size_t>(most));
    std::vector<uint8_t> observations(size_t(most) * world.observation_size());
    std::vector<float> logits(size_t(most) * size_t(actions));
    const auto start = [&](int place) {
      Job& job = jobs[size_t(place)];
      job.position = take();
      if (job.position < 0) return false;
      job.episode = plan.at(job.position);
      const EnvTask pair = pairs[size_t(job.episode.pair)];
      batch[place].start(pair, episode_start(world, pair, options.seed, options.use.starts, job.episode.number));
      records[size_t(place)] = {pair, batch[place].now()};
      return true;
    };
    std::vector<int> running, pair_of;  // places
    for (int place = 0; place < most && start(place); ++place) running.push_back(place);
    while (!running.empty()) {
      batch.observe(running, options.window, observations.data());
      pair_of.clear();
      for (const int place : running) pair_of.push_back(jobs[size_t(place)].episode.pair);
      engine.infer(thread, int(running.size()), observations.data(), pair_of.data(), logits.data());
      const float* scores = logits.data();
      for (int& place : running) {
        RunningEpisode& episode = batch[place];
        const Job& job = jobs[size_t(place)];
        const int action = choose(scores, actions, options.temperature, [&] {
          return Random(options.seed, options.use.moves, world.pair_number(episode.pair),
                        uint64_t(job.episode.number) << 16 | episode.now().steps)
              .uniform();
        });
        if (sink && options.scores) note_scores(scores, actions, options.temperature, records[size_t(place)].policy);
        scores += actions;
        const int label = sink ? world.expert(episode.pair, episode.now()) : 0;
        const WorldStep step = episode.step(world, action);
        if (sink) records[size_t(place)].add(label, action, step);
        if (!step.ended()) continue;
        finish(job, episode.outcome(step), records[size_t(place)]);
        if (!start(place)) place = -1;
      }
      std::erase(running, -1);
    }
  });
  return results;
}

Matrix success_matrix(Parallel& parallel, const World& world, Model& model, const std::string& run,
                      const MatrixPlan& plan, const EpisodeSink& sink, const std::function<void(size_t)>& progress) {
  const std::vector<EnvTask> pairs = resolve_pairs(world, plan.pairs, false, plan.pairs_file);
  std::vector<std::pair<int, int>> numbers;
  for (const EnvTask& pair : pairs) numbers.emplace_back(pair.env, pair.task);
  const EpisodePlan episodes = {int64_t(pairs.size()) * plan.count, [&](int64_t position) {
                                  return EvalEpisode{int(position / plan.count), plan.first + position % plan.count};
                                }};
  model.engine->prepare_inference(parallel, model.parameters.data(), model.statistics.data(), numbers);
  const std::vector<Outcomes> results =
      evaluate(parallel, *model.engine, world, pairs, episodes,
               {plan.seed, model.window, plan.temperature, plan.use, plan.scores}, sink, progress);
  Matrix matrix;
  for (size_t p = 0; p < pairs.size(); ++p) {
    const PairRow& pair = plan.pairs[p];
    const Outcomes& r = results[p];
    matrix.has_part |= !pair.part.empty();
    MatrixRow row;
    row.run = run;
    row.world = world.name();
    row.window = model.window;
    row.method = model.method;
    row.seed = model.seed;
    row.updates = model.updates;
    row.eval_seed = plan.seed;
    row.first_episode = plan.first;
    row.env = pair.env;
    row.task = pair.task;
    row.seen = model.is_seen(pairs[p]);
    row.is_new = !model.knows(pairs[p]);
    row.episodes = r.episodes;
    row.successes = r.successes;
    row.wrong = r.wrong;
    row.timeouts = r.timeouts;
    row.reward = double(r.reward_cents) / 100;
    row.length = r.length;
    row.part = pair.part;
    row.temperature = plan.temperature;
    row.env_hash = hex(world.environments()[size_t(pairs[p].env)].hash);
    matrix.rows.push_back(std::move(row));
  }
  return matrix;
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
    model.engine->prepare_inference(parallel, parameters, statistics, pairs);
    Outcomes sum;
    for (const Outcomes& result : evaluate(parallel, *model.engine, world, groups[seen], listed(std::move(jobs)),
                                           {model.seed, model.window, model.policy->temperature(), kForRunLog}))
      sum.add(result);
    success[seen] = double(sum.successes) / sum.episodes;
    reward[seen] = sum.reward_cents / 100.0 / sum.episodes;
  }
  return {success[1], reward[1], success[0], reward[0]};
}

}  // namespace synpo
