// A moment of an episode in a kitchen: the kitchen from above, what the agent sees of it, and what the network's
// features are made of.
#pragma once
#include <string>

#include "draw/canvas/canvas.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {

struct KitchenMoment {
  const KitchenSet& world;
  EnvTask pair;
  StateHistory history;    // up to now
  int expert_action = -1;  // what the expert does next; -1 after the end
};

// The start of the episode that `random` draws, followed by `steps` steps of the expert. Throws kUsage when its episode
// is shorter.
KitchenMoment kitchen_moment(const KitchenSet& world, EnvTask pair, Random random, int64_t steps);

struct KitchenViewStyle {
  bool history = false;  // the last four pictures, in a row beneath
  std::string title;     // empty: kitchen, task and step in words
  double scale = 2;      // pixels per point
};

Canvas draw_kitchen_view(const KitchenMoment& moment, const KitchenViewStyle& style, const Font& font);

}  // namespace synpo
