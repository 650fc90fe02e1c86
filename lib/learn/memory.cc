#include "learn/memory.h"

#include <algorithm>

#include "base/error.h"

namespace synpo {

void ReplayMemory::add(Episode episode) {
  const size_t place = added_ % capacity_;
  if (place == episodes_.size()) {
    episodes_.emplace_back();
    serials_.emplace_back();
  }
  episodes_[place] = std::move(episode);
  serials_[place] = added_++;
}

// An episode is [env low, env high, task, the start's bytes, steps low, steps high], then its actions and labels.
void ReplayMemory::save(SafeTensors& file, const std::string& prefix) const {
  std::vector<uint8_t> bytes;
  for (const Episode& e : episodes_) {
    const size_t steps = e.actions.size();
    bytes.insert(bytes.end(), {uint8_t(e.pair.env), uint8_t(e.pair.env >> 8), uint8_t(e.pair.task)});
    bytes.insert(bytes.end(), e.start.bytes.begin(), e.start.bytes.end());
    bytes.insert(bytes.end(), {uint8_t(steps), uint8_t(steps >> 8)});
    bytes.insert(bytes.end(), e.actions.begin(), e.actions.end());
    bytes.insert(bytes.end(), e.labels.begin(), e.labels.end());
  }
  file.add(prefix + "episodes", {int64_t(bytes.size())}, bytes.data(), bytes.size());
  file.add(prefix + "serials", {int64_t(serials_.size())}, serials_.data(), serials_.size());
  file.add(prefix + "added", {1}, &added_, 1);
}

void ReplayMemory::load(const SafeTensors& file, const std::string& prefix, const World& world) {
  const std::vector<uint8_t> bytes = file.get<uint8_t>(prefix + "episodes");
  serials_ = file.get<uint64_t>(prefix + "serials");
  file.get(prefix + "added", &added_, 1);
  episodes_.clear();
  constexpr size_t kPair = 3, kStart = std::tuple_size_v<decltype(WorldState::bytes)>, kHead = kPair + kStart + 2;
  const auto bad = [&] { fail(Exit::kData, "tensor '", prefix, "episodes' is malformed"); };
  for (size_t at = 0; at < bytes.size();) {
    if (bytes.size() - at < kHead) bad();
    const uint8_t* head = bytes.data() + at;
    Episode e;
    e.pair = {head[0] | head[1] << 8, head[2]};
    if (e.pair.env >= world.envs() || e.pair.task >= world.task_count()) bad();
    std::copy_n(head + kPair, kStart, e.start.bytes.begin());
    if (!world.valid(e.pair, e.start)) bad();
    const size_t steps = head[kPair + kStart] | head[kPair + kStart + 1] << 8;
    at += kHead;
    if (steps < 1 || steps > size_t(kStepLimit) || bytes.size() - at < 2 * steps) bad();
    e.actions.assign(bytes.begin() + at, bytes.begin() + at + steps);
    e.labels.assign(bytes.begin() + at + steps, bytes.begin() + at + 2 * steps);
    for (size_t i = 0; i < 2 * steps; ++i)
      if (bytes[at + i] >= world.actions()) bad();
    at += 2 * steps;
    episodes_.push_back(std::move(e));
  }
  if (episodes_.size() > capacity_ || serials_.size() != episodes_.size()) bad();
  // Until the memory is full, the next episode goes behind the last one.
  if (added_ < episodes_.size() || (added_ > episodes_.size() && episodes_.size() < capacity_)) bad();
}

}  // namespace synpo
