#include "world/grid/task.h"

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

const std::vector<std::string>& grid_task_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Task& task : grid_tasks()) all.push_back(task.name());
    return all;
  }();
  return names;
}

}  // namespace synpo
