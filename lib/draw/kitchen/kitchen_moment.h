// A moment in a kitchen: from above, and as the agent sees it.
#pragma once
#include "draw/canvas/canvas.h"
#include "draw/face/plan_grid.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/view/view.h"

namespace synpo {

// Shades what of the floor and the furniture lies in the field of view and no farther than things can be taken; neither
// walls nor the Fridge let sight pass.
void draw_sight(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenPose& eye);
void draw_sight_sign(Canvas& canvas, const Box& box);
// Draws the objects where they lie; `wanted`, the task's, is ringed.
void draw_objects(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenFrame& frame, int wanted);
// The box of an object in a cell of the plan.
Box object_box(const PlanGrid& place, int cell);
Box agent_box(const PlanGrid& place, const Kitchen& kitchen, const KitchenPose& pose);

// Draws what the agent sees, smooth and of any size.
void draw_kitchen_seen(Canvas& canvas, const Box& box, const KitchenSolids& solids, const KitchenFrame& frame);
// Draws the picture of kSmallView x kSmallView pixels that features are made of; nullptr: there is none, all black. The
// sides are multiples of kSmallView.
void draw_small_seen(Canvas& canvas, const Box& box, const KitchenSolids& solids, const KitchenFrame* frame);

}  // namespace synpo
