// Kitchens on paper, from above: one, or many with their names, and the signs for agent and objects on them. Floor has
// the kitchen's own colour made lighter; objects and receptacles have those that the agent sees.
#pragma once
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "draw/face/plan_grid.h"
#include "draw/map_style.h"
#include "world/kitchen/geometry/kitchen.h"

namespace synpo {

inline int plan_cell(const Kitchen& kitchen, int row, int column) { return row * kitchen.columns + column; }
Box receptacle_box(const PlanGrid& place, const Kitchen& kitchen, int receptacle);

enum class Lettering { kLetters, kNames };
// Bit i of `doors`: receptacle i is open. Names stand where they find room.
void draw_kitchen(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, int doors, Lettering lettering);
// A lettered disc in the middle of `box`.
void draw_object(Canvas& canvas, const Box& box, int object);
// A disc with an arrowhead; heading in degrees clockwise from north.
void draw_looker(Canvas& canvas, const Box& box, int heading);
Sign object_sign(int object);
// With a light ring around it, as the task's object has.
void draw_wanted(Canvas& canvas, const Box& box, int object);
Sign wanted_sign(int object);
Sign receptacle_sign(int receptacle);

// All at one scale. Throws kUsage for none.
Canvas draw_kitchens(const std::vector<Kitchen>& kitchens, const MapStyle& style, const Font& font);

}  // namespace synpo
