// An episode in a kitchen as a path over its plan, what the agent saw on the way, and the same step by step.
#pragma once
#include "draw/canvas/canvas.h"
#include "draw/episode/episode_style.h"
#include "draw/kitchen/kitchen_film.h"

namespace synpo {

Canvas draw_kitchen_episode(const KitchenFilm& film, const EpisodeStyle& style, const Font& font);

// The plan with the way so far, and what the agent sees, after `moment` steps. All frames of a film are of one size,
// with even sides.
Canvas draw_kitchen_frame(const KitchenFilm& film, int moment, const EpisodeStyle& style, const Font& font);

}  // namespace synpo
