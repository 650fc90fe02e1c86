// Colours for print of kitchens: those of KitchenPalette, which the agent sees, the floor's made lighter.
#pragma once
#include <array>
#include <cstdint>

#include "base/rgb.h"
#include "world/kitchen/geometry/palette.h"

namespace synpo {

constexpr Rgb kPaperCounter = {166, 172, 181}, kPaperTable = {208, 172, 128}, kPaperEdge = {104, 110, 119};

Rgb paper_colour(const Colour& colour);
Rgb receptacle_colour(int receptacle);
Rgb object_colour(int object);
// Of a cell of floor, the two of its tiles.
std::array<Rgb, 2> paper_floor(uint64_t kitchen_hash);

// Of a character of a plan.
Rgb kitchen_cell_colour(char c, Rgb floor);

}  // namespace synpo
