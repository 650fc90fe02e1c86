// A moment in a kitchen: from above, and as the agent sees it.
#pragma once
#include "draw/canvas/canvas.h"
#include "draw/canvas/key.h"
#include "draw/kitchen/kitchen_picture.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {

// Environment `env` of the world as its plan.
Kitchen kitchen_of(const KitchenSet& world, int env);

// What of the floor and the furniture lies in the field of view and no farther than things can be taken, shaded;
// neither walls nor the Fridge let sight pass.
void draw_sight(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenPose& eye);
void draw_sight_sign(Canvas& canvas, const Box& box);
// The objects where they lie; `wanted`, the task's, is ringed.
void draw_objects(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenFrame& frame, int wanted);
// The box of an object in a cell of the plan.
Box object_box(const PlanGrid& place, int cell);
Box agent_box(const PlanGrid& place, const Kitchen& kitchen, const KitchenPose& pose);
// All of it.
void draw_moment(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenFrame& frame, int wanted);

// What the agent sees, smooth and of any size.
void draw_kitchen_seen(Canvas& canvas, const Box& box, const KitchenScene& scene, const KitchenFrame& frame);
// The picture of kSmallView x kSmallView pixels that features are made of; nullptr: there is none, all black. The sides
// are multiples of kSmallView.
void draw_small_seen(Canvas& canvas, const Box& box, const KitchenScene& scene, const KitchenFrame* frame);

}  // namespace synpo
