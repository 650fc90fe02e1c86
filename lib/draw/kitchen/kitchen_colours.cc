#include "draw/kitchen/kitchen_colours.h"

#include <cmath>
#include <cstddef>

#include "draw/colour.h"
#include "draw/paper.h"
#include "world/kitchen/geometry/kitchen.h"

namespace synpo {
namespace {

constexpr double kFloorTint = 0.62;  // of the way to white

}  // namespace

Rgb paper_colour(const Colour& colour) {
  return {uint8_t(std::lround(colour.r)), uint8_t(std::lround(colour.g)), uint8_t(std::lround(colour.b))};
}
Rgb receptacle_colour(int receptacle) { return paper_colour(kReceptacleColours[size_t(receptacle)]); }
Rgb object_colour(int object) { return paper_colour(kObjectColours[size_t(object)][0]); }

std::array<Rgb, 2> paper_floor(uint64_t kitchen_hash) {
  const KitchenPalette palette(kitchen_hash);
  return {mix(paper_colour(palette.floor[0]), kPaper, kFloorTint),
          mix(paper_colour(palette.floor[1]), kPaper, kFloorTint)};
}

Rgb kitchen_cell_colour(char c, Rgb floor) {
  switch (c) {
    case '#':
      return kPaperWall;
    case 'c':
      return kPaperCounter;
    case 't':
      return kPaperTable;
    case 'F':
      return receptacle_colour(kFridge);
    case 'M':
      return receptacle_colour(kMicrowave);
    case 'S':
      return receptacle_colour(kSink);
    default:
      return floor;
  }
}

}  // namespace synpo
