// An episode as a path over the plan of its environment, what the agent saw on the way, and the same step by step.
#pragma once
#include <cstdint>
#include <string>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/face/film.h"
#include "draw/face/world_face.h"

namespace synpo {

struct EpisodeStyle {
  std::string title;   // empty: environment and task
  int64_t strip = 12;  // pictures of what the agent saw, beneath; 0: none
  double scale = 2;    // pixels per point
};

// Films here have at least one step, and are of the face's world.
Canvas draw_episode(const WorldFace& face, const Film& film, const EpisodeStyle& style, const Font& font);

// The plan with the way so far, and what the agent sees, after `moment` steps. All frames of a film are of one size,
// with even sides.
Canvas draw_episode_frame(const WorldFace& face, const Film& film, int moment, const EpisodeStyle& style,
                          const Font& font);

}  // namespace synpo
