// Trees beside a matrix.
#pragma once
#include "draw/canvas/canvas.h"
#include "draw/canvas/shapes.h"
#include "draw/canvas/ticks.h"
#include "stats/cluster.h"

namespace synpo {

// The tree over rows whose middles lie `pitch` pixels apart from (x, y) downwards; it grows to the right by `depth`.
void draw_tree_right(Canvas& canvas, const Dendrogram& tree, int x, int y, int pitch, int depth, int line);
// A scale of the heights of that tree, beneath it from (x, y); and how much room it takes from y on.
void draw_scale_beneath(Canvas& canvas, const Dendrogram& tree, int x, int y, int depth, int line, const Pixels& px);
int tree_scale_height(const Pixels& px);
// The ticks of such a scale, `depth` pixels long: three at most, or two where three labels have no room side by side.
// The tree is higher than 0.
Ticks ticks_side_by_side(const Dendrogram& tree, int depth, const Font& font, const Pixels& px);
// The same to the left of a tree that grows upwards, and begins at (x, y).
void draw_scale_left(Canvas& canvas, const Dendrogram& tree, int x, int y, int depth, int line, const Pixels& px);
// The tree over columns from (x, y) to the right; it grows upwards.
void draw_tree_up(Canvas& canvas, const Dendrogram& tree, int x, int y, int pitch, int depth, int line);

}  // namespace synpo
