#include "learn/lanes.h"

#include <utility>

#include "base/error.h"

namespace synpo {

Lanes::Lanes(const GridSet& world, std::vector<EnvTask> pairs, int count, int window, uint64_t seed)
    : world_(&world), pairs_(std::move(pairs)), window_(window), seed_(seed), lanes_(count) {
  for (int lane = 0; lane < count; ++lane) restart(lane);
}

void Lanes::draw(int lane, uint8_t* pictures) const {
  draw_history(world_->maze(pairs_[lanes_[lane].pair].env), lanes_[lane].history, window_, pictures);
}

GridStep Lanes::step(int number, int action) {
  Lane& lane = lanes_[number];
  const EnvTask pair = pairs_[lane.pair];
  const GridStep step = grid_step(world_->maze(pair.env), world_->tasks()[pair.task], lane.state, action);
  lane.history.push(lane.state.now);
  lane.reward_cents += step.reward_cents;
  if (step.ended()) {
    ++finished_.episodes;
    finished_.successes += step.success;
    finished_.wrong += step.wrong_pick;
    finished_.reward_cents += lane.reward_cents;
    finished_.length += lane.state.steps;
  }
  return step;
}

void Lanes::restart(int number) {
  Lane& lane = lanes_[number];
  const int64_t episode = lane.episode + 1;
  lane = {};
  lane.episode = episode;
  Random random(seed_, Purpose::kLane, uint64_t(number), uint64_t(episode));
  lane.pair = int(random.below(uint32_t(pairs_.size())));
  lane.state = grid_reset(world_->maze(pairs_[lane.pair].env), random);
  lane.history.push(lane.state.now);
}

Lanes::Finished Lanes::take_finished() { return std::exchange(finished_, {}); }

std::vector<int64_t> Lanes::words() const {
  std::vector<int64_t> words;
  const auto add_frame = [&](const GridFrame& frame) {
    words.push_back(frame.agent);
    for (const uint8_t cell : frame.treasures) words.push_back(cell);
  };
  for (const Lane& lane : lanes_) {
    words.insert(words.end(), {lane.pair, lane.episode, lane.state.picked, lane.state.steps, lane.history.count, lane.reward_cents});
    add_frame(lane.state.now);
    for (const GridFrame& frame : lane.history.frames) add_frame(frame);
  }
  return words;
}

void Lanes::load(const std::vector<int64_t>& words) {
  const auto bad = [] { fail(Exit::kData, "the running episodes in the checkpoint are malformed"); };
  if (words.size() != lanes_.size() * kWords) bad();
  const int64_t* at = words.data();
  const auto take = [&](int64_t low, int64_t high) {
    if (*at < low || *at > high) bad();
    return *at++;
  };
  for (Lane& lane : lanes_) {
    lane.pair = int(take(0, int64_t(pairs_.size()) - 1));
    lane.episode = take(1, INT64_MAX - 1);
    lane.state.picked = uint8_t(take(0, 1));
    lane.state.steps = uint16_t(take(0, kGridStepLimit - 1));
    lane.history.count = uint8_t(take(1, kHistory));
    lane.reward_cents = take(INT32_MIN, INT32_MAX);
    const auto take_frame = [&](GridFrame& frame) {
      frame.agent = uint8_t(take(0, kGridCells - 1));
      for (uint8_t& cell : frame.treasures) cell = uint8_t(take(0, 255));
    };
    take_frame(lane.state.now);
    for (GridFrame& frame : lane.history.frames) take_frame(frame);
    if (world_->maze(pairs_[lane.pair].env).wall[lane.state.now.agent]) bad();
  }
}

}  // namespace synpo
