#include "play/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/hash.h"
#include "engine/cpu_engine.h"
#include "helpers/episodes.h"
#include "nn/loss.h"
#include "play/cell_policy.h"
#include "world/grid/view.h"

namespace synpo {

void PrintTo(const Outcomes& o, std::ostream* to) {
  *to << o.episodes << " episodes, " << o.successes << " successes, " << o.wrong << " wrong, " << o.timeouts
      << " timeouts, " << o.reward_cents << " cents, length " << o.length;
}

namespace {

// Scores by a function of what the policy is given: the picture and the pair's number.
class FunctionPolicy : public Policy<float> {
 public:
  using Scores = void (*)(const uint8_t* pictures, int pair, float* scores);
  explicit FunctionPolicy(Scores function) : function_(function) {}
  size_t observation_size() const override { return size_t(kGridCells) * kHistory; }
  void initialise(const InitOptions&, float*, float*) const override {}
  Losses step(Parallel&, const StepBatch<float>&, const StepOptions&, const float*, float*, float*, float*) override {
    throw std::logic_error("evaluation does not learn");
  }
  void prepare_inference(Parallel&, const float*, const float*, const std::vector<std::pair<int, int>>&) override {}
  void infer(int, int size, const uint8_t* pictures, const int* pair, float* scores, float*) override {
    EXPECT_LE(size, kInferenceUnit);
    for (int i = 0; i < size; ++i)
      function_(pictures + size_t(i) * kGridCells * kHistory, pair[i], scores + size_t(i) * kGridActions);
  }

 private:
  Scores function_;
};

template <int kAction>
void always(const uint8_t*, int, float* scores) {
  for (int a = 0; a < kGridActions; ++a) scores[a] = a == kAction;
}

// As good as random, and a function of everything that it sees.
void hashed(const uint8_t* pictures, int pair, float* scores) {
  uint64_t bits = Hash().add(pictures, size_t(kGridCells) * kHistory).value() + uint64_t(pair) * 0x9e3779b97f4a7c15;
  for (int a = 0; a < kGridActions; ++a, bits = (bits ^ bits >> 29) * 0xbf58476d1ce4e5b9)
    scores[a] = float(bits >> 40) * (a == kPick ? 0.6f : 1);
}

const std::vector<EnvTask> kPairs = {{0, 0}, {19, 19}, {3, 7}};

std::vector<EvalEpisode> episodes_of(int64_t first, int64_t count) {
  std::vector<EvalEpisode> episodes;
  for (int64_t number = first; number < first + count; ++number)
    for (int pair = 0; pair < int(kPairs.size()); ++pair) episodes.push_back({pair, number});
  return episodes;
}

std::vector<Outcomes> run(FunctionPolicy::Scores scores, const std::vector<EvalEpisode>& episodes, int threads,
                          const EvalOptions& options = {}) {
  Parallel parallel(threads);
  FunctionPolicy policy(scores);
  CpuEngine engine(policy);
  return evaluate(parallel, engine, builtin_world(), kPairs, listed(episodes), options);
}

// One episode played by itself.
Outcomes played(FunctionPolicy::Scores scores, const EvalEpisode& episode, const EvalOptions& options) {
  const EnvTask pair = kPairs[episode.pair];
  const Maze& maze = builtin_world().maze(pair.env);
  GridState state =
      to_grid_state(episode_start(builtin_world(), pair, options.seed, Purpose::kEvaluation, episode.number));
  std::vector<GridFrame> frames = {state.now};
  Outcomes result;
  result.episodes = 1;
  while (true) {
    float score[kGridActions];
    scores(pictures_of(maze, frames, options.window).data(), episode.pair, score);
    const WorldStep step = grid_step(maze, builtin_world().tasks()[pair.task], state, argmax(score, kGridActions));
    frames.push_back(state.now);
    result.reward_cents += step.reward_cents;
    ++result.length;
    result.successes = step.success;
    result.wrong = step.wrong;
    result.timeouts = !step.terminated && step.truncated;
    if (step.ended()) return result;
  }
}

TEST(Evaluate, AgreesWithEpisodesPlayedOneByOne) {
  for (const EvalOptions& options : {EvalOptions{1, 1}, EvalOptions{2, 0}}) {
    const std::vector<EvalEpisode> episodes = episodes_of(10, 60);
    std::vector<Outcomes> want(kPairs.size());
    for (const EvalEpisode& episode : episodes) want[episode.pair].add(played(hashed, episode, options));
    const std::vector<Outcomes> got = run(hashed, episodes, 1, options);
    int64_t wrong = 0, timeouts = 0;
    for (size_t p = 0; p < kPairs.size(); ++p) {
      EXPECT_EQ(got[p], want[p]) << p;
      EXPECT_EQ(got[p].episodes, 60);
      EXPECT_EQ(got[p].successes + got[p].wrong + got[p].timeouts, 60);
      wrong += got[p].wrong;
      timeouts += got[p].timeouts;
    }
    EXPECT_GT(wrong, 0);
    EXPECT_GT(timeouts, 0);
  }
}

// Scores whose softmax is 0.4, 0.3, 0.2, 0.1 and nothing.
void uneven(const uint8_t*, int, float* scores) {
  const float chances[kGridActions] = {0.4f, 0.3f, 0.2f, 0.1f, 1e-30f};
  for (int a = 0; a < kGridActions; ++a) scores[a] = std::log(chances[a]);
}

TEST(Evaluate, ActionsAreDrawnWithTheProbabilitiesOfThePolicy) {
  const auto counts = [](double temperature) {
    std::vector<double> count(kGridActions, 0);
    Parallel parallel(2);
    FunctionPolicy policy(uneven);
    EvalOptions options;
    options.temperature = temperature;
    double steps = 0;
    CpuEngine engine(policy);
    evaluate(parallel, engine, builtin_world(), kPairs, listed(episodes_of(0, 40)), options,
             [&](const Trajectory& trajectory) {
               for (const uint8_t action : trajectory.actions) ++count[action], ++steps;
             });
    for (double& c : count) c /= steps;
    EXPECT_EQ(steps, 40 * 3 * kStepLimit);  // without picks every episode runs out of time
    return count;
  };
  const auto near = [](const std::vector<double>& got, const std::vector<double>& want) {
    for (int a = 0; a < kGridActions; ++a)
      EXPECT_NEAR(got[a], want[a], 4 * std::sqrt(0.25 / (40 * 3 * kStepLimit))) << "action " << a;
  };
  near(counts(1), {0.4, 0.3, 0.2, 0.1, 0});
  near(counts(0.5), {16 / 30.0, 9 / 30.0, 4 / 30.0, 1 / 30.0, 0});  // squares
  near(counts(0), {1, 0, 0, 0, 0});
}

TEST(Evaluate, DrawsDependNeitherOnThreadsNorOnOrder) {
  EvalOptions options;
  options.temperature = 1;
  const std::vector<EvalEpisode> episodes = episodes_of(0, 70);
  const std::vector<Outcomes> one = run(uneven, episodes, 1, options);
  const std::vector<Outcomes> two =
      run(uneven, std::vector<EvalEpisode>(episodes.rbegin(), episodes.rend()), 2, options);
  for (size_t p = 0; p < kPairs.size(); ++p) EXPECT_EQ(one[p], two[p]) << p;
}

TEST(Evaluate, DependsNeitherOnThreadsNorOnOrderNorOnOtherEpisodes) {
  // Enough for several lists that refill their lanes.
  const std::vector<EvalEpisode> episodes = episodes_of(0, 220);
  const std::vector<Outcomes> all = run(hashed, episodes, 1);
  std::vector<EvalEpisode> reversed(episodes.rbegin(), episodes.rend());
  const std::vector<Outcomes> two = run(hashed, episodes, 2), other_order = run(hashed, reversed, 2);
  std::vector<Outcomes> parts(kPairs.size());
  for (const auto& [first, count] : {std::pair<int64_t, int64_t>{0, 1}, {1, 10}, {11, 53}, {64, 156}}) {
    const std::vector<Outcomes> part = run(hashed, episodes_of(first, count), 2);
    for (size_t p = 0; p < kPairs.size(); ++p) parts[p].add(part[p]);
  }
  for (size_t p = 0; p < kPairs.size(); ++p) {
    EXPECT_EQ(two[p], all[p]);
    EXPECT_EQ(other_order[p], all[p]);
    EXPECT_EQ(parts[p], all[p]);
  }
  EXPECT_NE(run(hashed, episodes, 1, {2, 1})[0], all[0]);
}

TEST(Evaluate, ALearnerThatRunsIntoTheWallTimesOut) {
  const std::vector<EvalEpisode> episodes = episodes_of(0, 50);
  const std::vector<Outcomes> got = run(always<kUp>, episodes, 2);
  std::vector<int64_t> reward(kPairs.size(), 0);
  for (const EvalEpisode& episode : episodes) {
    // So many steps up to the wall, then two cents a step.
    const EnvTask pair = kPairs[episode.pair];
    int cell = to_grid_state(episode_start(builtin_world(), pair, 1, Purpose::kEvaluation, episode.number)).now.agent,
        way = 0;
    while (!builtin_world().maze(pair.env).wall[cell - kGridSide]) {
      cell -= kGridSide;
      ++way;
    }
    reward[episode.pair] += -way - 2 * (kStepLimit - way);
  }
  for (size_t p = 0; p < kPairs.size(); ++p)
    EXPECT_EQ(got[p], (Outcomes{50, 0, 0, 50, reward[p], 50 * kStepLimit})) << p;
}

TEST(Evaluate, ALearnerThatOnlyPicksEndsWrongOrTimesOut) {
  const std::vector<EvalEpisode> episodes = episodes_of(0, 700);
  const std::vector<Outcomes> got = run(always<kPick>, episodes, 2);
  std::vector<Outcomes> want(kPairs.size());
  int64_t first_picks = 0;
  for (const EvalEpisode& episode : episodes) {
    const EnvTask pair = kPairs[episode.pair];
    const int found = treasure_under_agent(
        to_grid_state(episode_start(builtin_world(), pair, 1, Purpose::kEvaluation, episode.number)).now);
    const bool first = found == builtin_world().tasks()[pair.task].first;
    first_picks += first;
    if (found >= 0 && !first)
      want[episode.pair].add({1, 0, 1, 0, -1001, 1});
    else
      want[episode.pair].add({1, 0, 0, 1, first ? 100 - 300 : -300, kStepLimit});
  }
  for (size_t p = 0; p < kPairs.size(); ++p) {
    EXPECT_EQ(got[p], want[p]) << p;
    EXPECT_GT(got[p].wrong, 5);
  }
  EXPECT_GT(first_picks, 2);
}

TEST(Evaluate, APlanBeyondAnyListTakesNoMemoryAndCanBeLeft) {
  constexpr int64_t kCount = int64_t{1} << 45;
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    FunctionPolicy policy(hashed);
    CpuEngine engine(policy);
    const EpisodePlan plan = {kCount, [](int64_t position) { return EvalEpisode{0, kCount - position}; }};
    std::vector<int64_t> numbers;
    EXPECT_THROW(evaluate(parallel, engine, builtin_world(), kPairs, plan, {},
                          [&](const Trajectory& t) {
                            numbers.push_back(t.episode);
                            if (numbers.size() == 100) throw std::runtime_error("enough");
                          }),
                 std::runtime_error);
    ASSERT_EQ(numbers.size(), 100u);
    for (int64_t i = 0; i < 100; ++i) EXPECT_EQ(numbers[size_t(i)], kCount - i);
  }
}

TEST(Evaluate, EpisodesOfOtherUsesStartAndMoveInTheirOwnWay) {
  Parallel parallel(2);
  FunctionPolicy policy(uneven);
  std::map<Purpose, std::vector<std::string>> starts, moves;
  for (const EpisodeUse& use : {kForMatrix, kForRunLog, kForTraining}) {
    EvalOptions options;
    options.temperature = 1;
    options.use = use;
    CpuEngine engine(policy);
    evaluate(parallel, engine, builtin_world(), kPairs, listed(episodes_of(0, 10)), options, [&](const Trajectory& t) {
      const EnvTask pair = {builtin_world().env_index(t.env), builtin_world().task_index(t.task)};
      EXPECT_EQ(replay(builtin_world(), t).start,
                episode_start(builtin_world(), pair, options.seed, use.starts, t.episode));
      std::string places;
      for (const auto& [thing, place] : t.start) places += concat(thing, place.first, ',', place.second, ' ');
      starts[use.starts].push_back(places);
      moves[use.starts].emplace_back(t.actions.begin(), t.actions.end());
    });
  }
  EXPECT_EQ(starts.size(), 3u);
  for (const auto& list : {starts, moves})
    for (const auto& [a, of_a] : list)
      for (const auto& [b, of_b] : list)
        for (size_t i = 0; a != b && i < of_a.size(); ++i) EXPECT_NE(of_a[i], of_b[i]);
}

TEST(Evaluate, RecordsReplayToTheSameEpisodes) {
  const std::vector<EvalEpisode> episodes = episodes_of(5, 90);
  std::vector<std::string> lines[2];
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    FunctionPolicy policy(hashed);
    CpuEngine engine(policy);
    size_t done = 0;
    Outcomes sum, recorded;
    for (const Outcomes& result : evaluate(
             parallel, engine, builtin_world(), kPairs, listed(episodes), {3, 1},
             [&](const Trajectory& t) {
               const EvalEpisode& episode = episodes[lines[threads - 1].size()];
               lines[threads - 1].push_back(format_trajectory(t));
               const Episode again = replay(builtin_world(), t);
               EXPECT_EQ(again.pair, kPairs[episode.pair]);
               EXPECT_EQ(again.start,
                         episode_start(builtin_world(), again.pair, 3, Purpose::kEvaluation, episode.number));
               EXPECT_EQ(t.episode, episode.number);
               EXPECT_EQ(t.seed, 3u);
               EXPECT_EQ(format_trajectory(relabelled(builtin_world(), t)),
                         lines[threads - 1].back());  // the labels are the expert's
               int64_t reward = 0;
               for (const int cents : t.reward_cents) reward += cents;
               recorded.add({1, t.success, t.terminated && !t.success, t.truncated, reward, int64_t(t.actions.size())});
             },
             [&](size_t count) { EXPECT_EQ(count, ++done); }))
      sum.add(result);
    EXPECT_EQ(done, episodes.size());
    EXPECT_EQ(lines[threads - 1].size(), episodes.size());
    EXPECT_EQ(sum, recorded);
  }
  EXPECT_EQ(lines[0], lines[1]);
}

TEST(Evaluate, NoEpisodesIsNoWork) {
  for (const Outcomes& result : run(hashed, {}, 2)) EXPECT_EQ(result, Outcomes{});
}

// A start of the pair with the agent on every free cell.
std::vector<WorldState> states_everywhere(EnvTask pair) {
  GridState state = to_grid_state(episode_start(builtin_world(), pair, 5, Purpose::kEpisodeStart, 0));
  std::vector<WorldState> states;
  for (const uint8_t cell : builtin_world().maze(pair.env).free_cells) {
    state.now.agent = cell;
    states.push_back(to_world_state(state));
  }
  return states;
}

// Scores by the agent's cell and the number of pictures: an input is the same as what a running episode would give.
TEST(Probe, AsksForEveryStateWithItsHistory) {
  const EnvTask pair = {3, 7};
  const std::vector<WorldState> states = states_everywhere(pair);
  ASSERT_GT(states.size(), Policy<float>::kInferenceUnit) << "more than are inferred at a time";
  for (const int pictures_each : {1, 2, kHistory}) {
    FunctionPolicy policy(hashed);
    const std::vector<ActionRates> rates = probe_states(policy, builtin_world(), pair, states, 1, pictures_each);
    ASSERT_EQ(rates.size(), states.size());
    for (size_t i = 0; i < rates.size(); ++i) {
      StateHistory history;
      for (int k = 0; k < pictures_each; ++k) history.push(states[i]);
      uint8_t pictures[kGridCells * kHistory];
      draw_history(builtin_world().maze(pair.env), history, 1, pictures);
      float scores[kGridActions];
      hashed(pictures, 0, scores);
      EXPECT_NEAR(std::accumulate(rates[i].begin(), rates[i].end(), 0.0), 1, 1e-12);
      EXPECT_EQ(std::max_element(rates[i].begin(), rates[i].end()) - rates[i].begin(), argmax(scores, kGridActions))
          << i;
    }
  }
}

TEST(Probe, ProbabilitiesAreTheSoftmaxOfTheScores) {
  FunctionPolicy policy(always<kLeft>);
  for (const ActionRates& rates : probe_states(policy, builtin_world(), {0, 0}, states_everywhere({0, 0}), 1, 1)) {
    EXPECT_NEAR(rates[kLeft], std::exp(1) / (std::exp(1) + 4), 1e-12);
    EXPECT_NEAR(rates[kPick], 1 / (std::exp(1) + 4), 1e-12);
  }
}

}  // namespace
}  // namespace synpo
