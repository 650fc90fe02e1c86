// How an episode is drawn, whatever its world.
#pragma once
#include <cstdint>
#include <string>

namespace synpo {

struct EpisodeStyle {
  std::string title;   // empty: environment and task
  int64_t strip = 12;  // pictures of what the agent saw, beneath; 0: none
  double scale = 2;    // pixels per point
};

}  // namespace synpo
