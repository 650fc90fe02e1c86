#include "play/episode_batch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "helpers/corridor.h"
#include "helpers/episodes.h"

namespace synpo {
namespace {

std::vector<uint8_t> bytes_of(const EpisodeBatch& batch) {
  SafeTensors file;
  batch.save(file, "x");
  return file.get<uint8_t>("x");
}

bool loads(EpisodeBatch& batch, const std::vector<uint8_t>& bytes, int places) {
  SafeTensors file;
  file.add("x", {int64_t(bytes.size())}, bytes.data(), bytes.size());
  return batch.load(file, "x", places);
}

TEST(RunningEpisode, AddsUpWhatItBrings) {
  const Corridor world;
  RunningEpisode episode;
  episode.start({0, 1}, world.start_state(0, {{"agent", {0, 4}}}));
  EXPECT_EQ(episode.history.count, 1);
  EXPECT_FALSE(episode.step(world, 0).ended());
  EXPECT_FALSE(episode.step(world, 1).ended());
  const WorldStep last = episode.step(world, 1);
  ASSERT_TRUE(last.success);
  EXPECT_EQ(episode.outcome(last), (Outcomes{1, 1, 0, 0, 97, 3}));
  Outcomes sum = {2, 0, 1, 1, -300, 40};
  sum.add(episode.outcome(last));
  EXPECT_EQ(sum, (Outcomes{3, 1, 1, 1, -203, 43}));
  // Another start leaves nothing of it.
  episode.start({0, 0}, world.start_state(0, {{"agent", {0, 2}}}));
  EXPECT_EQ(episode.pair, (EnvTask{0, 0}));
  EXPECT_EQ(episode.history.count, 1);
  EXPECT_EQ(episode.reward_cents, 0);
}

TEST(EpisodeBatch, ObservesThePlacesAskedForInTheirOrder) {
  const Corridor world;
  EpisodeBatch batch(world, 3);
  for (int place = 0; place < 3; ++place) {
    batch[place].start({0, 1}, world.start_state(0, {{"agent", {0, 1 + place}}}));
    for (int i = 0; i < place; ++i) batch[place].step(world, 1);
  }
  const size_t size = world.observation_size();
  const std::vector<int> places = {2, 0};
  std::vector<uint8_t> got(2 * size, 9), want(2 * size);
  batch.observe(places, 1, got.data());
  batch[2].observe(world, 1, want.data());
  batch[0].observe(world, 1, want.data() + size);
  EXPECT_EQ(got, want);
  EXPECT_NE(std::vector<uint8_t>(got.begin(), got.begin() + int64_t(size)),
            std::vector<uint8_t>(got.begin() + int64_t(size), got.end()));
}

// As the first checkpoints have them: synpo-checkpoint(5).
TEST(EpisodeBatch, BytesOfGridWorldAreThoseOfTheFirstFiles) {
  EpisodeBatch batch(builtin_world(), 2);
  const std::vector<uint8_t>& cells = builtin_world().maze(3).free_cells;
  GridState state;
  state.now = {cells[0], {cells[1], cells[2], cells[3], cells[4], cells[5]}};
  batch[1].start({3, 7}, to_world_state(state));
  std::vector<uint8_t> want(2 * (5 + 4 * 16), 0);
  const auto put = [&](size_t at, std::vector<uint8_t> bytes) { std::ranges::copy(bytes, want.begin() + int64_t(at)); };
  put(69, {3, 0, 7, 0, 1});
  put(69 + 5 + 3 * 16, {cells[0], cells[1], cells[2], cells[3], cells[4], cells[5]});
  EXPECT_EQ(bytes_of(batch), want);
  const WorldStep step = batch[1].step(builtin_world(), kPick);
  ASSERT_FALSE(step.ended());
  put(69, {3, 0, 7, 0, 2});
  put(69 + 5 + 2 * 16, {cells[0], cells[1], cells[2], cells[3], cells[4], cells[5]});
  put(69 + 5 + 3 * 16 + 14, {1, 0});
  EXPECT_EQ(bytes_of(batch), want);
}

// More tasks than a byte counts, and states as large as can be.
class LargeCorridor : public Corridor {
 public:
  LargeCorridor() : Corridor(large_facts()) {}
  bool valid(EnvTask pair, const WorldState& state) const override {
    return Corridor::valid(pair, state) && state.bytes.back() == 77;
  }

 private:
  static WorldFacts large_facts() {
    WorldFacts large = facts();
    large.tasks.assign(300, "task");
    large.state_bytes = WorldState::kMostBytes;
    return large;
  }
};

TEST(EpisodeBatch, ComesBackInEveryWorld) {
  const LargeCorridor world;
  EpisodeBatch batch(world, 3), other(world);
  WorldState state = world.start_state(0, {{"agent", {0, 3}}});
  state.bytes.back() = 77;
  batch[0].start({0, 299}, state);
  state.bytes[0] = 4;
  state.steps = 299;
  batch[0].history.push(state);
  batch[2].start({0, 256}, state);
  const std::vector<uint8_t> bytes = bytes_of(batch);
  ASSERT_EQ(bytes.size(), 3 * (5 + 4 * (WorldState::kMostBytes + 2)));
  ASSERT_TRUE(loads(other, bytes, 3));
  for (int place = 0; place < 3; ++place) {
    EXPECT_EQ(other[place].pair, batch[place].pair);
    EXPECT_EQ(other[place].history.count, batch[place].history.count);
    EXPECT_EQ(other[place].history.states, batch[place].history.states);
  }
  EXPECT_EQ(bytes_of(other), bytes);
  EXPECT_FALSE(loads(other, bytes, 2));
  EXPECT_FALSE(loads(other, bytes, 4));
  for (const size_t at : {size_t(0), size_t(3), size_t(4), bytes.size() - 3}) {  // env, task, count, the last state
    std::vector<uint8_t> damaged = bytes;
    damaged[at] = 200;
    EXPECT_FALSE(loads(other, damaged, 3)) << at;
  }
}

}  // namespace
}  // namespace synpo
