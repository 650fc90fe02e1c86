// A world as the other modules see it: environments and tasks, rules, an expert, and what the agent sees. GridWorld
// (grid/grid_set.h) and the kitchens (kitchen/kitchen_set.h, kitchen/recorded_kitchens.h) are two.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "world/observation.h"

namespace synpo {

// A pair, by positions in the world's lists.
struct EnvTask {
  int env, task;
  bool operator==(const EnvTask&) const = default;
};

// The world alone knows what the bytes mean; from World::state_bytes() on they are zero.
struct WorldState {
  static constexpr size_t kMostBytes = 62;
  std::array<uint8_t, kMostBytes> bytes = {};
  uint16_t steps = 0;  // taken in the episode
  bool operator==(const WorldState&) const = default;
};

struct WorldStep {
  int reward_cents;                            // hundredths, so that rewards add up exactly
  bool terminated, truncated, success, wrong;  // wrong: ended by a wrong object or place
  bool ended() const { return terminated || truncated; }
};

constexpr int kStepLimit = 300;  // of an episode, in every world: then it is cut

// The last states of a running episode, newest last. Before the first step the earlier ones are missing.
struct StateHistory {
  std::array<WorldState, kHistory> states;
  uint8_t count = 0;
  void push(const WorldState& state);
  const WorldState& now() const { return states.back(); }
};

// The kinds of steps, by what a state asks of a policy.
enum class StepKind : uint8_t {
  kMove,    // to move
  kPick,    // to take or put the right thing
  kWalkOn,  // to leave alone what could be taken or put here
  kStart    // the first step of an episode
};
constexpr int kStepKinds = 4;

struct Environment {
  std::string name;
  uint64_t hash;        // of `content`
  std::string content;  // canonical: all that makes it what it is, or empty where it lies in a file of its own
};

// Where agent and things are when an episode starts, as a trajectory holds it.
using StartPlaces = std::map<std::string, std::pair<int, int>>;

// All that never changes in a world.
struct WorldFacts {
  std::string name;  // as the files have it: "gridworld"
  int rules = 1;     // version of the rules, which trajectories and checkpoints carry
  std::vector<Environment> environments = {};
  std::vector<std::string> tasks = {}, actions = {};  // names
  int moves = 0;                                      // the first so many actions only move the agent
  size_t state_bytes = WorldState::kMostBytes;        // of a WorldState, as checkpoints hold it
  ObservationSpec observation = {};
  // The extractor that made the features, "name@hash": a policy goes with features of one extractor alone. Empty where
  // observations are pictures.
  std::string extractor = "";
};

class World {
 public:
  // Throws kData for two environments of one name.
  explicit World(WorldFacts facts);
  virtual ~World() = default;
  World(World&&) = default;
  World& operator=(World&&) = default;

  virtual WorldState reset(int env, Random& random) const = 0;
  virtual WorldStep step(EnvTask pair, WorldState& state, int action) const = 0;
  // The planner's action; ties go to the first in the order of the actions.
  virtual int expert(EnvTask pair, const WorldState& state) const = 0;
  // Writes observation_spec().bytes(). `window` is how far the agent sees, in the world's own measure, as trajectories
  // and checkpoints carry it; a world in which that never changes passes over it.
  virtual void observe(int env, const StateHistory& history, int window, uint8_t* observation) const = 0;

  virtual StartPlaces start_places(int env, const WorldState& start) const = 0;
  // Throws kData, naming the field, for what start_places() never gives.
  virtual WorldState start_state(int env, const StartPlaces& places) const = 0;
  // Whether this can be a state of a running episode: what comes from a file may be no such state.
  virtual bool valid(EnvTask pair, const WorldState& state) const = 0;

  // Undiscounted return in hundredths of each action [actions] and the planner's after it, without the step limit.
  // Plays them all, where a world does not know better; throws kInternal where that does not end.
  virtual void action_values(EnvTask pair, const WorldState& state, int* cents) const;
  // Whether something could be taken or put here, rightly or wrongly. Where a world does not know better: whether an
  // action that does not only move ends the episode or changes the state.
  virtual bool at_choice(EnvTask pair, const WorldState& state) const;

  const std::string& name() const { return facts_.name; }
  int rules() const { return facts_.rules; }
  const std::vector<Environment>& environments() const { return facts_.environments; }
  const std::vector<std::string>& task_names() const { return facts_.tasks; }
  const std::vector<std::string>& action_names() const { return facts_.actions; }
  int moves() const { return facts_.moves; }
  size_t state_bytes() const { return facts_.state_bytes; }
  const ObservationSpec& observation_spec() const { return facts_.observation; }
  const std::string& extractor() const { return facts_.extractor; }

  size_t observation_size() const { return observation_spec().bytes(); }
  int envs() const { return int(environments().size()); }
  int task_count() const { return int(task_names().size()); }
  int actions() const { return int(action_names().size()); }
  std::vector<std::string> env_names() const;
  // Position of a name, or -1.
  int env_index(const std::string& name) const;
  int task_index(const std::string& name) const;
  // Number of a pair, for random streams.
  uint64_t pair_number(EnvTask pair) const { return uint64_t(pair.env) * task_names().size() + uint64_t(pair.task); }
  // The kind of a step whose right action is `label`.
  StepKind kind(EnvTask pair, const WorldState& state, int label) const;

 protected:
  // Throws kData for a name that is there already.
  void add_environment(Environment environment);

 private:
  WorldFacts facts_;
  std::map<std::string, int> env_numbers_;  // by name
};

}  // namespace synpo
