#include "world/kitchen/geometry/palette.h"

#include <algorithm>

#include "base/random.h"

namespace synpo {

const Colour kCeilingColour = {236, 236, 232};
const Colour kInsideColour = {22, 20, 24};
const Colour kShelfColour = {70, 68, 74};
const std::array<Colour, kKitchenReceptacles> kReceptacleColours = {{{125, 55, 200}, {240, 110, 140}, {90, 190, 165}}};
const std::array<std::array<Colour, 2>, kKitchenObjects> kObjectColours = {{
    {{{255, 140, 0}, {160, 80, 0}}},     // Container: orange
    {{{40, 205, 50}, {10, 110, 20}}},    // Lettuce: green
    {{{30, 70, 255}, {10, 20, 130}}},    // Mug: blue
    {{{235, 15, 15}, {30, 120, 30}}},    // Tomato: red
    {{{0, 225, 235}, {200, 255, 255}}},  // Plate: cyan
    {{{245, 235, 20}, {110, 70, 20}}},   // Apple: yellow
    {{{240, 30, 215}, {120, 0, 105}}},   // Bowl: magenta
}};

namespace {

// Hue in sixths of the circle, saturation and value from 0 to 1.
Colour from_hue(float hue, float saturation, float value) {
  const auto channel = [&](float shift) {
    const float k = hue + shift < 6 ? hue + shift : hue + shift - 6;
    return 255 * value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0f, 1.0f));
  };
  return {channel(5), channel(3), channel(1)};
}

}  // namespace

KitchenPalette::KitchenPalette(uint64_t hash) {
  Random random(hash, Purpose::kInit, 1);
  const auto between = [&](float low, float high) { return low + (high - low) * float(random.uniform()); };
  const auto any = [&](float least, float most, float dark, float bright) {
    const float hue = between(0, 6), saturation = between(least, most);
    return from_hue(hue, saturation, between(dark, bright));
  };
  floor[0] = any(0.1f, 0.35f, 0.45f, 0.8f);
  floor[1] = mix(floor[0], between(0.72f, 0.9f));
  wall = any(0.05f, 0.25f, 0.7f, 0.95f);
  band = any(0.1f, 0.3f, 0.5f, 0.9f);
  cabinet = any(0.15f, 0.4f, 0.4f, 0.85f);
  counter_top = any(0, 0.2f, 0.25f, 0.9f);
  const float brown = between(0.4f, 0.75f), strength = between(0.35f, 0.55f);
  table = from_hue(brown, strength, between(0.45f, 0.75f));
  for (Colour& panel : panels) panel = any(0.15f, 0.5f, 0.3f, 0.9f);
}

}  // namespace synpo
