// Pictures as an animated GIF, which every browser plays.
#pragma once
#include <functional>
#include <string>

#include "draw/canvas/canvas.h"

namespace synpo {

// The bytes of a GIF that plays `frames` (at least 1) pictures over and over, and rests on the last one for two
// seconds. All are of one size. They are asked for twice, in order: once for the palette, whose 255 colours are exact
// where the pictures have no more. The same bytes for the same pixels.
std::string animated_gif(int frames, double frames_per_second, const std::function<Canvas(int)>& frame);

}  // namespace synpo
