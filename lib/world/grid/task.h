// Tasks of GridWorld: pick one treasure, then another.
#pragma once
#include <string>
#include <vector>

namespace synpo {

constexpr int kTreasures = 5;
constexpr char kTreasureLetters[kTreasures + 1] = "RBGOP";  // red, blue, green, orange, purple

struct Task {
  int first, second;         // indices into kTreasureLetters
  std::string name() const;  // "R-B"
};

// All 20 ordered pairs in the order of Figure 6: on the ring R B G O P, first those one step on, then two, three, four.
const std::vector<Task>& grid_tasks();
const std::vector<std::string>& grid_task_names();

}  // namespace synpo
