// What every world has from its facts and its rules alone.
#include "world/world.h"

#include <gtest/gtest.h>

#include <vector>

#include "helpers/corridor.h"
#include "helpers/kitchens.h"
#include "helpers/table_helpers.h"
#include "world/grid/grid_set.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

TEST(World, TellsItsFacts) {
  const Corridor world;
  EXPECT_EQ(world.name(), "corridor");
  EXPECT_EQ(world.rules(), 1);
  EXPECT_EQ(world.envs(), 1);
  EXPECT_EQ(world.task_index("right"), 1);
  EXPECT_EQ(world.env_index("long"), -1);
  EXPECT_EQ(world.extractor(), "");
  EXPECT_EQ(world.observation_size(), 6u * 6 * 4);
  WorldFacts two = Corridor::facts();
  two.environments.push_back(two.environments[0]);
  EXPECT_EQ(thrown([&] { Corridor{two}; }), "65 two environments are named 'short'");
}

// From cell 3: 2 steps to the right end, 3 to the left one, each 0.01; success gives 1 on top of its step.
TEST(World, ValuesOfActionsArePlayed) {
  const Corridor world;
  WorldState state = world.start_state(0, {{"agent", {0, 3}}});
  state.steps = kStepLimit - 1;  // the limit has no say
  int cents[2];
  world.action_values({0, 1}, state, cents);
  EXPECT_EQ(std::vector(cents, cents + 2), (std::vector{96, 98}));
  world.action_values({0, 0}, state, cents);
  EXPECT_EQ(std::vector(cents, cents + 2), (std::vector{97, 95}));
  // One step from the wrong end.
  world.action_values({0, 0}, world.start_state(0, {{"agent", {0, 4}}}), cents);
  EXPECT_EQ(cents[1], -1);
  EXPECT_FALSE(world.at_choice({0, 0}, state));
}

class Circling : public Corridor {
 public:
  int expert(EnvTask, const WorldState& state) const override { return state.bytes[0] % 2; }
};

TEST(World, AnExpertThatGoesInCirclesIsAFault) {
  const Circling world;
  int cents[2];
  EXPECT_EQ(thrown([&] {
              world.action_values({0, 0}, world.start_state(0, {{"agent", {0, 3}}}), cents);
            }),
            "70 world 'corridor': the expert's episode has no end within 30000 steps");
}

// A world that knows better says the same. Doors, which can be opened where nothing can be taken, are the exception.
void expect_defaults(const World& world, bool has_doors) {
  std::vector<int> own(size_t(world.actions())), played(size_t(world.actions()));
  int choices = 0;
  for (int i = 0; i < 600; ++i) {
    const EnvTask pair = {i % world.envs(), i / 5 % world.task_count()};
    Random random(9, Purpose::kEpisodeStart, 0, uint64_t(i)), moves(9, Purpose::kNoise, 0, uint64_t(i));
    WorldState state = world.reset(pair.env, random);
    for (uint32_t wander = moves.below(40); wander > 0; --wander) {
      const bool astray = moves.below(3) == 0;
      WorldState next = state;
      const int action = astray ? int(moves.below(uint32_t(world.actions()))) : world.expert(pair, state);
      if (!world.step(pair, next, action).ended()) state = next;
    }
    world.action_values(pair, state, own.data());
    world.World::action_values(pair, state, played.data());
    ASSERT_EQ(own, played) << i;
    if (world.at_choice(pair, state) || !has_doors) {
      ASSERT_EQ(world.at_choice(pair, state), world.World::at_choice(pair, state)) << i;
    }
    choices += world.at_choice(pair, state);
  }
  EXPECT_GT(choices, 20);
  EXPECT_LT(choices, 580);
}

TEST(World, GridWorldKnowsWhatPlayingWouldShow) { expect_defaults(GridSet::open("gridworld"), false); }

TEST(World, KitchensKnowWhatPlayingWouldShow) { expect_defaults(KitchenSet({small_kitchen()}), true); }

}  // namespace
}  // namespace synpo
