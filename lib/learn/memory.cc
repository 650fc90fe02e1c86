#include "learn/memory.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace synpo {
namespace {

// An episode in a checkpoint is [env, task, the start's bytes, steps], then its actions and its labels, a byte each.
// Env and steps are two bytes, the low one first, and so is the task in a world that has more than 256.
constexpr size_t kEnvBytes = 2, kStepsBytes = 2;
struct Head {
  explicit Head(const World& world) : task_bytes(world.task_count() > 256 ? 2 : 1), state_bytes(world.state_bytes()) {}
  size_t size() const { return kEnvBytes + task_bytes + state_bytes + kStepsBytes; }
  size_t task_bytes, state_bytes;
};

}  // namespace

void ReplayMemory::add(Episode episode) {
  const size_t place = added_ % capacity_;
  if (place == episodes_.size()) {
    episodes_.emplace_back();
    serials_.emplace_back();
  }
  episodes_[place] = std::move(episode);
  serials_[place] = added_++;
}

void ReplayMemory::save(SafeTensors& file, const std::string& prefix, const World& world) const {
  const Head head(world);
  std::vector<uint8_t> bytes;
  for (const Episode& e : episodes_) {
    const size_t steps = e.actions.size();
    bytes.insert(bytes.end(), {uint8_t(e.pair.env), uint8_t(e.pair.env >> 8), uint8_t(e.pair.task)});
    if (head.task_bytes > 1) bytes.push_back(uint8_t(e.pair.task >> 8));
    bytes.insert(bytes.end(), e.start.bytes.begin(), e.start.bytes.begin() + std::ptrdiff_t(head.state_bytes));
    bytes.insert(bytes.end(), {uint8_t(steps), uint8_t(steps >> 8)});
    bytes.insert(bytes.end(), e.actions.begin(), e.actions.end());
    bytes.insert(bytes.end(), e.labels.begin(), e.labels.end());
  }
  file.add(prefix + "episodes", {int64_t(bytes.size())}, bytes.data(), bytes.size());
  file.add_bits(prefix + "serials", serials_);
  file.add_bits(prefix + "added", {added_});
}

void ReplayMemory::load(const SafeTensors& file, const std::string& prefix, const World& world) {
  const std::vector<uint8_t> bytes = file.get<uint8_t>(prefix + "episodes");
  serials_ = file.get_bits(prefix + "serials");
  const std::vector<uint64_t> added = file.get_bits(prefix + "added");
  episodes_.clear();
  const Head head(world);
  const auto bad = [&] { fail(Exit::kData, "tensor '", prefix, "episodes' is malformed"); };
  for (size_t at = 0; at < bytes.size();) {
    if (bytes.size() - at < head.size()) bad();
    const uint8_t* from = bytes.data() + at;
    Episode e;
    e.pair = {from[0] | from[1] << 8, from[2]};
    if (head.task_bytes > 1) e.pair.task |= from[3] << 8;
    if (e.pair.env >= world.envs() || e.pair.task >= world.task_count()) bad();
    from += kEnvBytes + head.task_bytes;
    std::copy_n(from, head.state_bytes, e.start.bytes.begin());
    if (!world.valid(e.pair, e.start)) bad();
    from += head.state_bytes;
    const size_t steps = from[0] | from[1] << 8;
    at += head.size();
    if (steps < 1 || steps > size_t(kStepLimit) || bytes.size() - at < 2 * steps) bad();
    e.actions.assign(bytes.begin() + at, bytes.begin() + at + steps);
    e.labels.assign(bytes.begin() + at + steps, bytes.begin() + at + 2 * steps);
    for (size_t i = 0; i < 2 * steps; ++i)
      if (bytes[at + i] >= world.actions()) bad();
    at += 2 * steps;
    // From a state after the end the expert may know no way.
    WorldState state = e.start;
    for (size_t i = 0; i < steps; ++i)
      if (world.step(e.pair, state, e.actions[i]).ended() && i + 1 < steps) bad();
    episodes_.push_back(std::move(e));
  }
  if (added.size() != 1) bad();
  added_ = added[0];
  if (episodes_.size() > capacity_ || serials_.size() != episodes_.size()) bad();
  // Until the memory is full, the next episode comes after the last one.
  if (added_ < episodes_.size() || (added_ > episodes_.size() && episodes_.size() < capacity_)) bad();
}

}  // namespace synpo
