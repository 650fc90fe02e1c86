#include "learn/steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "helpers/episodes.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

constexpr size_t kPicture = size_t(kGridCells) * kHistory;

// A running episode as the definition has it: where it stands, and what was seen on the way.
struct Walk {
  const Episode* trajectory;  // null: unknown
  bool following;             // the actions so far are the trajectory's
  GridState state;
  std::vector<GridFrame> frames;

  explicit Walk(const Episode& episode)
      : trajectory(&episode), following(true), state(to_grid_state(episode.start)), frames{state.now} {}
  const Task& task() const { return builtin_world().tasks()[trajectory->pair.task]; }
  const Maze& maze() const { return builtin_world().maze(trajectory->pair.env); }
  bool recorded() const { return following && state.steps < trajectory->actions.size(); }
  int label() const {
    return recorded() ? trajectory->labels[state.steps]
                      : builtin_world().planner(trajectory->pair.env).action(task(), state);
  }
  int move() const { return recorded() ? int(trajectory->actions[state.steps]) : label(); }
  // False at the episode's end.
  bool step(int action) {
    following = recorded() && action == trajectory->actions[state.steps];
    const bool ended = grid_step(maze(), task(), state, action).ended();
    frames.push_back(state.now);
    return !ended;
  }
};

StepKind kind_of(const GridState& state, int label) {
  return builtin_world().kind({0, 0}, to_world_state(state), label);
}

bool has_planner_q(const Minibatch& batch, int i, const Walk& walk) {
  const std::array<int, kGridActions> cents =
      builtin_world().planner(walk.trajectory->pair.env).q_cents(walk.task(), walk.state);
  for (int a = 0; a < kGridActions; ++a)
    if (batch.planner_q[i * kGridActions + a] != float(cents[a]) / 100) return false;
  return true;
}

// Whether sample `i` of the batch is the walk's next step, taken with `taken`.
bool is_step(const Minibatch& batch, int i, const Walk& walk, int window, int taken) {
  if (batch.env[i] != walk.trajectory->pair.env || batch.task[i] != walk.trajectory->pair.task ||
      batch.label[i] != walk.label() || batch.taken[i] != taken || batch.kind[i] != kind_of(walk.state, walk.label()))
    return false;
  GridState after = walk.state;
  if (batch.reward[i] != float(grid_step(walk.maze(), walk.task(), after, taken).reward_cents) / 100) return false;
  if (batch.needs.planner_q && !has_planner_q(batch, i, walk)) return false;
  const std::vector<uint8_t> pictures = pictures_of(walk.maze(), walk.frames, window);
  return std::equal(pictures.begin(), pictures.end(), batch.observations.begin() + i * kPicture);
}

// Whether what comes after sample `i`, the walk's next step, is where the taken action leads. The batch has it at
// `next`.
bool leads_on(const Minibatch& batch, int i, int next, const Walk& walk, int window) {
  Walk after = walk;
  GridState state = walk.state;
  if (grid_step(walk.maze(), walk.task(), state, batch.taken[i]).terminated)
    return batch.next[i] == StepBatch<float>::kTerminal;
  after.step(batch.taken[i]);
  return batch.next[i] == next && is_step(batch, next, after, window, after.move());
}

ReplayMemory memory_of(int count, double noise, const std::vector<EnvTask>& pairs = {{0, 0}, {7, 3}, {12, 19}}) {
  ReplayMemory memory(1000);
  for (int i = 0; i < count; ++i) memory.add(expert(pairs[i % pairs.size()], i, noise));
  return memory;
}

bool equal(const Minibatch& a, const Minibatch& b) {
  return a.observations == b.observations && a.env == b.env && a.task == b.task && a.label == b.label &&
         a.taken == b.taken && a.reward == b.reward && a.kind == b.kind;
}

TEST(StepKind, ByWhatIsAsked) {
  GridState state;
  state.now = {17, {17, 20, 21, 22, 23}};
  EXPECT_EQ(kind_of(state, kPick), StepKind::kStart);
  state.steps = 1;
  EXPECT_EQ(kind_of(state, kPick), StepKind::kPick);
  EXPECT_EQ(kind_of(state, kUp), StepKind::kWalkOn);
  state.now.agent = 18;
  EXPECT_EQ(kind_of(state, kUp), StepKind::kMove);
  state.now.treasures[0] = kPicked;
  state.now.agent = 17;
  EXPECT_EQ(kind_of(state, kUp), StepKind::kMove);
}

TEST(TrajectoryDraw, TakesAllStepsOfTheDrawnTrajectories) {
  const ReplayMemory memory = memory_of(7, 0.3);
  Parallel parallel(2);
  Minibatch batch;
  std::vector<int> drawn(memory.size(), 0);
  constexpr int kUpdates = 150, kCount = 5;
  for (int update = 0; update < kUpdates; ++update) {
    const int window = update % 3;
    TrajectoryDraw::draw(builtin_world(), memory, parallel, kCount, window, 1, update, batch);
    int at = 0;
    for (int count = 0; count < kCount; ++count) {
      // The first step tells which trajectory it is.
      size_t which = 0;
      while (which < memory.size() && !is_step(batch, at, Walk(memory[which]), window, memory[which].actions[0]))
        ++which;
      ASSERT_LT(which, memory.size());
      ++drawn[which];
      Walk walk(memory[which]);
      for (const uint8_t action : memory[which].actions) {
        ASSERT_LT(at, batch.size());
        ASSERT_TRUE(is_step(batch, at, walk, window, action)) << "update " << update << ", sample " << at;
        walk.step(action);
        ++at;
      }
    }
    ASSERT_EQ(at, batch.size());
  }
  const double expected = double(kUpdates) * kCount / memory.size();
  for (const int count : drawn) EXPECT_NEAR(count, expected, 5 * std::sqrt(expected));
}

TEST(TrajectoryDraw, KnowsTheNextStepAndThePlannersValues) {
  ReplayMemory memory = memory_of(7, 0.3);
  Episode broken_off = expert({4, 4}, 0);
  ASSERT_GT(broken_off.actions.size(), 6u);
  broken_off.actions.resize(5);
  broken_off.labels.resize(5);
  memory.add(broken_off);
  Parallel parallel(2);
  Minibatch batch;
  batch.needs = {true, true};
  std::set<int> ends;
  for (int update = 0; update < 20; ++update) {
    TrajectoryDraw::draw(builtin_world(), memory, parallel, 5, 1, 1, update, batch);
    for (int at = 0; at < batch.size();) {
      size_t which = 0;
      while (!is_step(batch, at, Walk(memory[which]), 1, memory[which].actions[0])) ASSERT_LT(++which, memory.size());
      Walk walk(memory[which]);
      for (const uint8_t action : memory[which].actions) {
        ASSERT_TRUE(is_step(batch, at, walk, 1, action));
        if (size_t(walk.state.steps) + 1 < memory[which].actions.size())
          ASSERT_TRUE(leads_on(batch, at, at + 1, walk, 1));
        else
          ends.insert(batch.next[at]);
        walk.step(action);
        ++at;
      }
      EXPECT_EQ(batch.next[at - 1],
                memory[which].actions.size() == 5 ? StepBatch<float>::kUnknown : StepBatch<float>::kTerminal);
    }
  }
  EXPECT_EQ(ends.size(), 2u);
}

TEST(TrajectoryDraw, DrawsTheSameWhateverIsNeededBesides) {
  const ReplayMemory memory = memory_of(7, 0.3);
  Parallel parallel(1);
  Minibatch plain, more;
  more.needs = {true, true};
  TrajectoryDraw::draw(builtin_world(), memory, parallel, 3, 1, 1, 7, plain);
  TrajectoryDraw::draw(builtin_world(), memory, parallel, 3, 1, 1, 7, more);
  EXPECT_TRUE(equal(plain, more));
  EXPECT_TRUE(plain.next.empty() && plain.planner_q.empty());
}

TEST(TrajectoryDraw, IsTheSameForTheSameUpdate) {
  const ReplayMemory memory = memory_of(20, 0);
  Parallel one(1), two(2);
  Minibatch a, b;
  TrajectoryDraw::draw(builtin_world(), memory, two, 3, 1, 1, 8, b);
  TrajectoryDraw::draw(builtin_world(), memory, one, 3, 1, 1, 7, a);
  EXPECT_FALSE(equal(a, b));
  TrajectoryDraw::draw(builtin_world(), memory, two, 3, 1, 1, 7, b);
  EXPECT_TRUE(equal(a, b));
  TrajectoryDraw::draw(builtin_world(), memory, two, 3, 1, 2, 7, b);
  EXPECT_FALSE(equal(a, b));
}

// All that is known of every running episode: the walks that it may be on. Each draw has to be the next step of one of
// them.
class Followers {
 public:
  Followers(const ReplayMemory& memory, const RunningOptions& options, int window)
      : memory_(memory), options_(options), window_(window), walks_(options.episodes) {
    for (size_t i = 0; i < memory.size(); ++i) {
      // Anywhere on a trajectory, to begin with.
      Walk walk(memory[i]);
      for (const uint8_t action : memory[i].actions) {
        everywhere_.push_back(walk);
        if (!walk.step(action)) break;
      }
    }
    walks_.assign(options.episodes, everywhere_);
  }

  // Sample `i` of the batch is of running episode `number`, which then did `action`.
  void check(const Minibatch& batch, int i, int number, int action) {
    std::vector<Walk> next;
    for (Walk& walk : walks_[number]) {
      const int taken = options_.noise > 0 ? batch.taken[i] : walk.move();
      if (!is_step(batch, i, walk, window_, taken)) continue;
      if (batch.needs.next && !leads_on(batch, i, batch.size() / 2 + i, walk, window_)) continue;
      const bool was_recorded = walk.recorded();
      on_ += was_recorded;
      off_ += !was_recorded;
      if (walk.step(action) && walk.state.steps < options_.step_limit)
        next.push_back(walk);
      else
        for (size_t t = 0; t < memory_.size(); ++t) next.emplace_back(memory_[t]);
    }
    ASSERT_FALSE(next.empty()) << "running episode " << number << " is on no known way";
    walks_[number] = std::move(next);
  }
  int on() const { return on_; }
  int off() const { return off_; }

 private:
  const ReplayMemory& memory_;
  RunningOptions options_;
  int window_;
  std::vector<std::vector<Walk>> walks_;
  std::vector<Walk> everywhere_;
  int on_ = 0, off_ = 0;
};

TEST(RunningDraw, WithoutNoiseFollowsTheTrajectoriesStepByStep) {
  const ReplayMemory memory = memory_of(9, 0.3);
  const RunningOptions options = {6, 1, 0, 0, false, kStepLimit};
  RunningDraw running(builtin_world(), options, 1);
  Followers followers(memory, options, 1);
  Parallel parallel(2);
  Minibatch batch;
  for (int update = 0; update < 250; ++update) {
    running.draw(memory, parallel, 6, 1, update, batch);
    ASSERT_EQ(batch.size(), 6);
    for (int i = 0; i < 6; ++i) {
      followers.check(batch, i, i, batch.taken[i]);
      if (HasFatalFailure()) return;
    }
    running.advance(memory, std::vector<int>(6, kPick), update);
  }
  EXPECT_EQ(followers.off(), 0);
}

TEST(RunningDraw, TakesTurns) {
  // Fewer samples than running episodes: each is visited in turn.
  const ReplayMemory memory = memory_of(9, 0.3);
  const RunningOptions options = {10, 1, 0, 0, false, kStepLimit};
  RunningDraw running(builtin_world(), options, 1);
  Followers followers(memory, options, 0);
  Parallel parallel(1);
  Minibatch batch;
  for (int update = 0; update < 200; ++update) {
    running.draw(memory, parallel, 7, 0, update, batch);
    for (int i = 0; i < 7; ++i) {
      followers.check(batch, i, (update * 7 + i) % 10, batch.taken[i]);
      if (HasFatalFailure()) return;
    }
    running.advance(memory, std::vector<int>(7, kPick), update);
  }
}

TEST(RunningDraw, OffTheTrajectoryThePlannerGivesTheLabels) {
  ReplayMemory memory(1000);
  for (int i = 0; i < 9; ++i) {
    // Labels that are not the planner's tell where a label came from.
    Episode episode = expert({i, i}, i, 0.2);
    for (uint8_t& label : episode.labels) label = uint8_t((label + 1) % kGridActions);
    memory.add(episode);
  }
  const RunningOptions options = {5, 1, 1, 0, false, 60};
  RunningDraw running(builtin_world(), options, 1);
  Followers followers(memory, options, 1);
  Parallel parallel(2);
  Minibatch batch;
  Random random(1, Purpose::kDropout);
  for (int update = 0; update < 500; ++update) {
    running.draw(memory, parallel, 5, 1, update, batch);
    std::vector<int> greedy(5);
    for (int i = 0; i < 5; ++i) {
      greedy[i] = random.below(20) == 0 ? int(random.below(kGridActions)) : batch.taken[i];
      followers.check(batch, i, i, greedy[i]);
      if (HasFatalFailure()) return;
    }
    running.advance(memory, greedy, update);
  }
  EXPECT_GT(followers.on(), 200);
  EXPECT_GT(followers.off(), 200);
}

TEST(RunningDraw, NoiseAndTheLearnersMovesAreAsOftenAsAsked) {
  const ReplayMemory memory = memory_of(30, 0);
  const RunningOptions options = {64, 1, 0.5, 0.4, false, kStepLimit};
  RunningDraw running(builtin_world(), options, 1);
  Followers followers(memory, options, 1);
  Parallel parallel(1);
  Minibatch batch;
  int moves = 0, other = 0, steps = 0, stayed = 0;
  std::vector<std::vector<uint8_t>> before(64);
  for (int update = 0; update < 100; ++update) {
    running.draw(memory, parallel, 64, 1, update, batch);
    for (int i = 0; i < 64; ++i) {
      const std::vector<uint8_t> picture(batch.observations.begin() + i * kPicture,
                                         batch.observations.begin() + (i + 1) * kPicture);
      // The learner picks on empty floor: the newest two pictures are alike then.
      if (update > 0 && batch.kind[i] != StepKind::kStart) {
        ++steps;
        bool alike = true;
        for (int cell = 0; cell < kGridCells; ++cell)
          alike = alike && picture[cell * kHistory + 3] == picture[cell * kHistory + 2];
        stayed += alike;
      }
      if (batch.label[i] == kPick) continue;
      ++moves;
      other += batch.taken[i] != batch.label[i];
      EXPECT_NE(batch.taken[i], kPick);
    }
    running.advance(memory, std::vector<int>(64, kPick), update);
  }
  EXPECT_NEAR(double(other) / moves, 0.4 * 3 / 4, 0.03);
  // Half of the moves are picks; a random move may run into a wall.
  EXPECT_GT(double(stayed) / steps, 0.45);
  EXPECT_LT(double(stayed) / steps, 0.68);
}

TEST(RunningDraw, KnowsTheNextStepAndThePlannersValues) {
  const ReplayMemory memory = memory_of(9, 0.3);
  const RunningOptions options = {6, 1, 0.3, 0.2, false, kStepLimit};
  RunningDraw running(builtin_world(), options, 1);
  Followers followers(memory, options, 1);
  Parallel parallel(2);
  Minibatch batch;
  batch.needs = {true, true};
  int last = 0;
  for (int update = 0; update < 300; ++update) {
    running.draw(memory, parallel, 12, 1, update, batch);
    ASSERT_EQ(batch.size(), 12);
    std::vector<int> greedy;
    for (int i = 0; i < 6; ++i) {
      // The learner does what was done anyhow, so that the way is known.
      greedy.push_back(batch.taken[i]);
      followers.check(batch, i, i, batch.taken[i]);
      if (HasFatalFailure()) return;
      EXPECT_EQ(batch.next[6 + i], StepBatch<float>::kUnknown);
      last += batch.next[i] == StepBatch<float>::kTerminal;
    }
    running.advance(memory, greedy, update);
  }
  EXPECT_GT(followers.on(), 200);
  EXPECT_GT(followers.off(), 200);
  EXPECT_GT(last, 10);
}

TEST(RunningDraw, DrawsTheSameWhateverIsNeededBesides) {
  const ReplayMemory memory = memory_of(9, 0.3);
  const BatchNeeds needs[] = {{}, {false, true}, {true, false}, {true, true}};
  std::vector<RunningDraw> running(4, RunningDraw(builtin_world(), {10, 0.3, 0.3, 0.2, true, 60}, 1));
  Parallel parallel(2);
  for (int update = 0; update < 60; ++update) {
    Minibatch batches[4];
    std::vector<int> greedy;
    for (int i = 0; i < 7; ++i) greedy.push_back((update + i) % kGridActions);
    for (int n = 0; n < 4; ++n) {
      batches[n].needs = needs[n];
      // Steps after others take the other half of the batch; an odd one is rounded up.
      running[n].draw(memory, parallel, needs[n].next ? 13 : 7, 1, update, batches[n]);
      EXPECT_EQ(batches[n].size(), needs[n].next ? 14 : 7);
      batches[n].needs = {};
      batches[n].resize(builtin_world(), 7);
      EXPECT_TRUE(equal(batches[n], batches[0])) << update << " " << n;
      running[n].advance(memory, greedy, update);
    }
  }
}

TEST(RunningDraw, ATrajectoryMayBreakOff) {
  ReplayMemory memory(10);
  Episode episode = expert({4, 4}, 0);
  ASSERT_GT(episode.actions.size(), 6u);
  episode.actions.resize(5);
  episode.labels.resize(5);
  memory.add(episode);
  const RunningOptions options = {3, 1, 0, 0, false, kStepLimit};
  RunningDraw running(builtin_world(), options, 1);
  Parallel parallel(1);
  Minibatch batch;
  int picks = 0;
  for (int update = 0; update < 200; ++update) {
    running.draw(memory, parallel, 3, 1, update, batch);
    for (int i = 0; i < 3; ++i) picks += batch.kind[i] == StepKind::kPick;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(batch.label[i], batch.taken[i]);
    running.advance(memory, {0, 0, 0}, update);
  }
  // The expert goes on to the end, again and again.
  EXPECT_GT(picks, 10);
}

TEST(RunningDraw, StepsOnTreasuresAreAlwaysTakenOthersByBalance) {
  const ReplayMemory memory = memory_of(9, 0.3);
  RunningDraw running(builtin_world(), {8, 0.25, 0, 0, false, kStepLimit}, 1);
  Parallel parallel(1);
  Minibatch batch;
  int taken_elsewhere = 0, passed_elsewhere = 0;
  // Every running episode on every walk that it may be on; what lies between two draws is passed over.
  std::vector<std::vector<Walk>> walks(8);
  for (int update = 0; update < 300; ++update) {
    running.draw(memory, parallel, 8, 1, update, batch);
    for (int i = 0; i < 8; ++i) {
      std::vector<Walk> found;
      int passed = 0;
      std::function<void(Walk, int)> search = [&](Walk walk, int skipped) {
        while (true) {
          if (is_step(batch, i, walk, 1, walk.move())) {
            found.push_back(walk);
            passed = skipped;
          }
          if (update > 0 && treasure_under_agent(walk.state.now) >= 0) return;  // may not be passed over
          ++skipped;
          if (!walk.step(walk.move())) break;
        }
        if (update == 0) return;
        for (size_t t = 0; t < memory.size(); ++t) search(Walk(memory[t]), skipped);
      };
      if (update == 0)
        for (size_t t = 0; t < memory.size(); ++t) search(Walk(memory[t]), 0);
      for (Walk& walk : walks[i]) {
        const bool treasure = treasure_under_agent(walk.state.now) >= 0;
        taken_elsewhere += !treasure;
        if (walk.step(walk.move()))
          search(walk, 0);
        else
          for (size_t t = 0; t < memory.size(); ++t) search(Walk(memory[t]), 0);
      }
      ASSERT_FALSE(found.empty()) << "update " << update << ", running episode " << i;
      passed_elsewhere += update > 0 ? passed : 0;
      walks[i] = {found.front()};
    }
    running.advance(memory, std::vector<int>(8, kPick), update);
  }
  EXPECT_NEAR(double(taken_elsewhere) / (taken_elsewhere + passed_elsewhere), 0.25, 0.03);
}

TEST(RunningDraw, FreshStartsGoAnywhereWithThePlannersLabels) {
  const ReplayMemory memory = memory_of(3, 0);
  RunningDraw running(builtin_world(), {16, 1, 0, 0, true, 100}, 1);
  Parallel parallel(2);
  Minibatch batch;
  std::set<std::string> starts;
  int checked = 0;
  for (int update = 0; update < 200; ++update) {
    running.draw(memory, parallel, 16, kGridSide, update, batch);
    for (int i = 0; i < 16; ++i) {
      if (batch.kind[i] != StepKind::kStart) continue;
      // The whole state stands in the picture unless the agent hides a treasure.
      GridState state;
      state.now.treasures.fill(kPicked);
      std::string newest;
      for (int cell = 0; cell < kGridCells; ++cell) {
        const uint8_t colour = batch.observations[i * kPicture + cell * kHistory + kHistory - 1];
        newest += char(colour);
        if (colour == kAgent) state.now.agent = uint8_t(cell);
        if (colour >= kFirstTreasure) state.now.treasures[colour - kFirstTreasure] = uint8_t(cell);
      }
      starts.insert(newest);
      if (std::count(state.now.treasures.begin(), state.now.treasures.end(), kPicked) > 0) continue;
      ++checked;
      EXPECT_EQ(batch.label[i],
                builtin_world().planner(batch.env[i]).action(builtin_world().tasks()[batch.task[i]], state));
    }
    running.advance(memory, std::vector<int>(16, kPick), update);
  }
  EXPECT_GT(checked, 30);
  EXPECT_GT(starts.size(), 30u);
}

TEST(RunningDraw, BringsNoPairThatTheMemoryHasNot) {
  const std::vector<EnvTask> pairs = {{0, 0}, {7, 3}, {12, 19}};
  ReplayMemory memory(6);
  RunningDraw running(builtin_world(), {40, 0.3, 0.5, 0.3, true, 50}, 1);
  Parallel parallel(2);
  Minibatch batch;
  std::set<std::pair<int, int>> found;
  for (int update = 0; update < 200; ++update) {
    memory.add(expert(pairs[update % 3], update));
    running.draw(memory, parallel, 33, 1, update, batch);
    std::vector<int> greedy;
    for (int i = 0; i < 33; ++i) {
      ASSERT_TRUE(std::count(pairs.begin(), pairs.end(), EnvTask{batch.env[i], batch.task[i]}))
          << batch.env[i] << " " << batch.task[i];
      found.insert({batch.env[i], batch.task[i]});
      greedy.push_back((update + i) % kGridActions);
    }
    running.advance(memory, greedy, update);
  }
  EXPECT_EQ(found.size(), 3u);
}

// The future of a running draw: its next batches, with the same learner.
std::vector<Minibatch> future(RunningDraw& running, ReplayMemory& memory, int threads, int from, int to) {
  Parallel parallel(threads);
  std::vector<Minibatch> batches;
  for (int update = from; update < to; ++update) {
    memory.add(expert({update % 20, 5}, update, 0.3));
    running.draw(memory, parallel, 37, 1, update, batches.emplace_back());
    std::vector<int> greedy;
    for (int i = 0; i < 37; ++i) greedy.push_back(batches.back().observations[i * kPicture] ? kPick : (update + i) % 5);
    running.advance(memory, greedy, update);
  }
  return batches;
}

class RunningDrawSaved : public testing::TestWithParam<bool> {};

TEST_P(RunningDrawSaved, HasTheSameFuture) {
  const RunningOptions options = {50, 0.3, 0.3, 0.2, GetParam(), 80};
  ReplayMemory memory(25);
  RunningDraw running(builtin_world(), options, 1);
  for (const int pause : {0, 3, 40}) {
    if (pause > 0) future(running, memory, 2, pause == 3 ? 0 : 23, pause);
    SafeTensors file;
    running.save(file, "r/");
    memory.save(file, "m/", builtin_world());
    ReplayMemory other_memory(25);
    other_memory.load(file, "m/", builtin_world());
    RunningDraw other(builtin_world(), options, 1);
    other.load(file, "r/", other_memory);
    SafeTensors again;
    other.save(again, "r/");
    for (const char* name : {"r/running", "r/episodes"})
      EXPECT_TRUE(again.tensors[name].bytes == file.tensors[name].bytes) << name;
    const std::vector<Minibatch> expected = future(running, memory, 1, pause, pause + 20),
                                 got = future(other, other_memory, 2, pause, pause + 20);
    for (size_t i = 0; i < got.size(); ++i)
      ASSERT_TRUE(equal(got[i], expected[i])) << "saved at " << pause << ", batch " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(FreshStarts, RunningDrawSaved, testing::Bool());

TEST(RunningDraw, RefusesWhatNoSaveWrote) {
  ReplayMemory memory(25);
  RunningDraw running(builtin_world(), {40, 0.3, 0, 0, false, 80}, 1);
  future(running, memory, 1, 0, 4);
  SafeTensors good;
  running.save(good, "r/");
  const auto refused = [&](const std::function<void(SafeTensors&)>& change) {
    SafeTensors file = good;
    change(file);
    RunningDraw other(builtin_world(), {40, 0.3, 0, 0, false, 80}, 1);
    return thrown([&] { other.load(file, "r/", memory); });
  };
  const std::string malformed = "65 tensor 'r/running' is malformed";
  const std::vector<int64_t> words = good.get<int64_t>("r/running");
  EXPECT_EQ(refused([](SafeTensors&) {}), "nothing thrown");
  EXPECT_EQ(refused([&](SafeTensors& file) {
              file.add("r/running", {int64_t(words.size()) - 1}, words.data(), words.size() - 1);
            }),
            malformed);
  const size_t each = words.size() / 40;
  for (size_t at = 0; at < each; ++at)
    for (const int64_t value : {int64_t{-1}, INT64_MAX}) {
      if (at == 0 && value > 0) continue;  // a serial may be any number
      std::vector<int64_t> damaged = words;
      damaged[7 * each + at] = value;
      EXPECT_EQ(refused([&](SafeTensors& file) {
                  file.add("r/running", {int64_t(words.size())}, damaged.data(), damaged.size());
                }),
                malformed)
          << "word " << at << " " << value;
    }
  const std::vector<uint8_t> episodes = good.get<uint8_t>("r/episodes");
  EXPECT_EQ(refused([&](SafeTensors& file) {
              file.add("r/episodes", {int64_t(episodes.size()) - 1}, episodes.data(), episodes.size() - 1);
            }),
            malformed);
  // The pair and the number of remembered states; then the newest state's agent, which may not stand in a corner of the
  // maze.
  const size_t bytes_each = episodes.size() / 40, newest = bytes_each - kGridStateBytes - 2;
  for (const size_t at : {size_t(0), size_t(1), size_t(2), size_t(3), size_t(4), newest}) {
    std::vector<uint8_t> damaged = episodes;
    damaged[7 * bytes_each + at] = 255;
    EXPECT_EQ(refused([&](SafeTensors& file) {
                file.add("r/episodes", {int64_t(damaged.size())}, damaged.data(), damaged.size());
              }),
              malformed)
        << at;
  }
  for (const int64_t next : {int64_t{-1}, int64_t{40}})
    EXPECT_EQ(refused([&](SafeTensors& file) { file.add("r/next", {1}, &next, 1); }), malformed);
  EXPECT_EQ(refused([](SafeTensors& file) { file.tensors.erase("r/next"); }), "65 no tensor 'r/next'");
}

}  // namespace
}  // namespace synpo
