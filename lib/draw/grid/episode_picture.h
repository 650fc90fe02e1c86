// An episode as a path through its maze, the pictures that the agent saw on the way, and the same step by step.
#pragma once
#include <string>

#include "draw/canvas/canvas.h"
#include "draw/episode/episode_style.h"
#include "draw/grid/film.h"

namespace synpo {

Canvas draw_episode(const Film& film, const EpisodeStyle& style, const Font& font);

// The maze with the way so far, and what the agent sees, after `moment` steps. All frames of a film are of one size,
// with even sides.
Canvas draw_episode_frame(const Film& film, int moment, const EpisodeStyle& style, const Font& font);

}  // namespace synpo
