#include "world/task.h"

namespace synpo {

std::string Task::name() const { return {kTreasureLetters[first], '-', kTreasureLetters[second]}; }

const std::vector<Task>& grid_tasks() {
  static const std::vector<Task> tasks = [] {
    std::vector<Task> all;
    for (int steps_on = 1; steps_on < kTreasures; ++steps_on)
      for (int first = 0; first < kTreasures; ++first) all.push_back({first, (first + steps_on) % kTreasures});
    return all;
  }();
  return tasks;
}

}  // namespace synpo
