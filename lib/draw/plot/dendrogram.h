// Trees beside a matrix.
#pragma once
#include "draw/canvas/canvas.h"
#include "stats/cluster.h"

namespace synpo {

// The tree over rows whose middles lie `pitch` pixels apart from (x, y) downwards; it grows to the right by `depth`.
void draw_tree_right(Canvas& canvas, const Dendrogram& tree, int x, int y, int pitch, int depth, int line);
// The tree over columns from (x, y) to the right; it grows upwards.
void draw_tree_up(Canvas& canvas, const Dendrogram& tree, int x, int y, int pitch, int depth, int line);

}  // namespace synpo
