// The steps of a minibatch, drawn from the replay memory in one of two ways.
//
// TrajectoryDraw is Algorithm 1: whole trajectories, uniformly, all their steps.
// RunningDraw takes single steps from many episodes that run side by side. Each update visits the next few of them in
// turn; one starts as a trajectory of the memory and follows it, or is driven off it by random moves and the learner's
// own greedy moves, where the planner then gives the label. Steps on which something could be taken (World::at_choice)
// are always taken, others with a probability.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "format/safetensors.h"
#include "learn/memory.h"
#include "play/episode.h"
#include "play/episode_batch.h"
#include "play/running_episode.h"
#include "policy/policy.h"
#include "world/world.h"

namespace synpo {

// A minibatch under construction; arrays grow as needed. Set `needs` before a draw.
struct Minibatch {
  std::vector<uint8_t> observations;  // [size, World::observation_size()]
  std::vector<int> env, task, label, taken;
  std::vector<float> reward;
  std::vector<StepKind> kind;
  // Where asked for: StepBatch::next and planner_q.
  BatchNeeds needs;
  std::vector<int> next;
  std::vector<float> planner_q;
  int size() const { return int(env.size()); }
  void resize(const World& world, int size);
  // Sample `at`: where an episode stands, what its right action is there, and the one taken, with what came of it.
  void put(int at, const World& world, const RunningEpisode& episode, int window, int right, int action,
           const WorldStep& step);
};

class TrajectoryDraw {
 public:
  // `count` trajectories with all their steps; update `update` of a run with this seed always draws the same.
  static void draw(const World& world, const ReplayMemory& memory, Parallel& parallel, int count, int window,
                   uint64_t seed, int64_t update, Minibatch& batch);
};

struct RunningOptions {
  int episodes = 8192;        // that run side by side
  double balance = 1;         // probability of taking a step on which nothing could be taken
  double roll_in = 0;         // probability of the learner's own greedy move after a taken step
  double noise = 0;           // probability of a random move otherwise
  bool fresh_starts = false;  // agent and things are placed anew; the memory then gives the pair alone
  int step_limit = kStepLimit;
};

class RunningDraw {
 public:
  RunningDraw(const World& world, const RunningOptions& options, uint64_t seed)
      : world_(&world), options_(options), seed_(seed), episodes_(world) {}

  // Takes over probabilities; the number of episodes stays.
  void set_options(const RunningOptions& options) { options_ = options; }
  // The next `count` running episodes, each at its next step to be taken. Where the batch needs next steps, half as
  // many, and the steps after them, as the taken actions lead there.
  void draw(const ReplayMemory& memory, Parallel& parallel, int count, int window, int64_t update, Minibatch& batch);
  // Moves the episodes of the last draw() on, given the learner's greedy actions [count], which are not read without
  // roll-in.
  void advance(const ReplayMemory& memory, const std::vector<int>& greedy, int64_t update);

  void save(SafeTensors& file, const std::string& prefix) const;
  // Throws kData for what no save() wrote beside this memory.
  void load(const SafeTensors& file, const std::string& prefix, const ReplayMemory& memory);

 private:
  // How a running episode goes with the trajectory that it started as.
  struct Track {
    uint64_t serial = 0;  // of the trajectory
    uint32_t place = 0;   // in the memory
    uint32_t restarts = 0;
    bool following = false;  // actions so far are the trajectory's
    bool started = false;
  };
  struct Choice {
    int label, move;
  };
  // The trajectory whose next action is the episode's next; null where it has left it, or the memory has.
  static const Episode* followed(const ReplayMemory& memory, const RunningEpisode& episode, const Track& track);
  // The right action, and the one that is taken without noise and the learner.
  Choice choose(const ReplayMemory& memory, const RunningEpisode& episode, const Track& track) const;
  WorldStep move_on(const ReplayMemory& memory, RunningEpisode& episode, Track& track, int action) const;
  void restart(const ReplayMemory& memory, uint32_t number);
  // One step; restarts where the episode ends.
  void step(const ReplayMemory& memory, uint32_t number, int action);
  // Goes on to the next step that is to be taken; its choice.
  Choice go_on(const ReplayMemory& memory, uint32_t number, int64_t update);

  const World* world_;
  RunningOptions options_;
  uint64_t seed_;
  EpisodeBatch episodes_;
  std::vector<Track> tracks_;    // of the episodes
  size_t next_ = 0;              // the episode whose turn it is
  std::vector<uint32_t> drawn_;  // of the last draw()
  std::vector<int> moves_;       // what those would do without the learner
};

}  // namespace synpo
