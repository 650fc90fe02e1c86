#include "draw/kitchen/kitchen_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/heading.h"
#include "draw/colour.h"
#include "draw/kitchen/kitchen_colours.h"
#include "draw/paper.h"
#include "world/kitchen/geometry/palette.h"

namespace synpo {
namespace {

constexpr double kCellPt = 6, kAloneCellPt = 14;

// Where things of two kinds meet, but at walls.
void draw_edges(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen) {
  const int line = std::max(1, place.cell / 14);
  for (int row = 1; row < kitchen.rows; ++row)
    for (int column = 1; column < kitchen.columns; ++column) {
      const char c = kitchen.at(row, column), above = kitchen.at(row - 1, column), left = kitchen.at(row, column - 1);
      const Box box = place.box(plan_cell(kitchen, row, column));
      if (c != above && c != '#' && above != '#')
        canvas.fill({box.x - line / 2, box.y - line / 2, box.width + line, line}, kPaperEdge);
      if (c != left && c != '#' && left != '#')
        canvas.fill({box.x - line / 2, box.y - line / 2, line, box.height + line}, kPaperEdge);
    }
}

// A footprint as its front sees it: `along` from 0 to 1 to the right of one who stands before it, `out` in pixels
// towards him.
struct Front {
  Front(const Box& box, int back) : heading((back + 2) % 4), length(heading % 2 ? box.height : box.width) {
    const double x = box.x + box.width / 2.0, y = box.y + box.height / 2.0;
    const double depth = (heading % 2 ? box.width : box.height) / 2.0;
    out = {double(kColumnStep[heading]), double(kRowStep[heading])};
    along = {out.y, -out.x};
    left = {x + out.x * depth - along.x * length / 2, y + out.y * depth - along.y * length / 2};
  }
  Point at(double share, double pixels) const {
    return {left.x + along.x * share * length + out.x * pixels, left.y + along.y * share * length + out.y * pixels};
  }
  int heading, length;
  Point out, along, left;
};

void draw_stroke(Canvas& canvas, const std::vector<Point>& points, double width, Rgb colour) {
  canvas.line(points, width, colour);
}

double door_thickness(double cell) { return std::max(2.0, cell * 0.2); }

// The part of a box that a closed door and its inset leave free.
Box box_without_door(const Box& box, int back, int cell) {
  const int thick = int(std::lround(1.3 * door_thickness(cell))), front = (back + 2) % 4;
  return {box.x + (front == 3 ? thick : 0), box.y + (front == 0 ? thick : 0), box.width - (front % 2 ? thick : 0),
          box.height - (front % 2 ? 0 : thick)};
}

void draw_front(Canvas& canvas, const Box& box, int back, bool open, double cell, Rgb colour) {
  const Front front(box, back);
  if (!open) {
    const double thick = door_thickness(cell), inset = 0.5 * thick;
    const double from = 0.06, to = 0.94;
    canvas.polygon(
        {front.at(from, -inset), front.at(to, -inset), front.at(to, -inset - thick), front.at(from, -inset - thick)},
        mix(colour, kInk, 0.75));
    return;
  }
  const int frame = std::max(2, int(cell / 5));
  canvas.fill(box.inset(frame), paper_colour(kInsideColour));
  const double line = std::max(1.5, cell * 0.09), reach = front.length;
  std::vector<Point> arc;
  constexpr int kPieces = 16;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = std::numbers::pi / 2 * i / kPieces;
    arc.push_back(front.at(std::cos(angle), reach * std::sin(angle)));
  }
  draw_stroke(canvas, arc, std::max(1.0, line * 0.5), colour);
  draw_stroke(canvas, {front.at(0, 0), front.at(0, reach)}, line * 1.6, colour);
}

// Its name, else its letter, upright where that is the longer side.
void draw_lettering(Canvas& canvas, const Box& box, int receptacle, int cell, Lettering lettering, Rgb ground) {
  const bool upright = box.height > box.width;
  const int along = upright ? box.height : box.width, across = upright ? box.width : box.height;
  const int x = box.x + box.width / 2, y = box.y + box.height / 2;
  if (lettering == Lettering::kNames) {
    const std::string name = kKitchenReceptacleNames[receptacle];
    int size = std::min(across / 2, cell * 7 / 10);
    while (size >= 8 && canvas.font().width(name, size) > along * 9 / 10) --size;
    if (size >= std::max(8, cell * 2 / 5)) {
      if (upright)
        canvas.text_up(x, y, name, size, ink_on(ground), Across::kCentre);
      else
        canvas.text(x, y, name, size, ink_on(ground), Across::kCentre, Upright::kMiddle);
      return;
    }
  }
  const int size = std::min(across * 6 / 10, lettering == Lettering::kNames ? cell * 4 / 5 : cell * 3 / 2);
  if (size >= 6)
    canvas.text(x, y, std::string(1, kKitchenReceptacleLetters[receptacle]), size, ink_on(ground), Across::kCentre,
                Upright::kMiddle);
}

void draw_sink_basin(Canvas& canvas, const Box& box, int cell) {
  const int inset = std::max(1, cell / 4);
  canvas.frame(box.inset(inset), std::max(1, cell / 14), mix(receptacle_colour(kSink), kInk, 0.45));
}

Sign floor_sign(const Kitchen& kitchen) {
  return [tiles = paper_floor(kitchen.hash)](Canvas& canvas, const Box& box) {
    const int half = box.width / 2;
    for (int i = 0; i < 4; ++i)
      canvas.fill({box.x + i % 2 * half, box.y + i / 2 * half, i % 2 ? box.width - half : half,
                   i / 2 ? box.height - half : half},
                  tiles[size_t(i / 2 + i) % 2]);
    canvas.frame(box, 1, kHairline);
  };
}

void draw_front_sign(Canvas& canvas, const Box& box) {
  canvas.fill(box, receptacle_colour(kFridge));
  draw_front(canvas, box, 0, false, box.width * 0.9, receptacle_colour(kFridge));
}

std::vector<KeyEntry> key_entries(const std::vector<Kitchen>& kitchens) {
  std::vector<KeyEntry> key = {{{}, kitchens.size() > 1 ? "floor, in each kitchen's colour" : "floor"}};
  for (size_t i = 0; i < std::min<size_t>(3, kitchens.size()); ++i) key[0].signs.push_back(floor_sign(kitchens[i]));
  key.push_back({{colour_sign(kPaperWall)}, "wall"});
  key.push_back({{colour_sign(kPaperCounter)}, "counter"});
  key.push_back({{colour_sign(kPaperTable)}, "table"});
  for (int i = 0; i < kKitchenReceptacles; ++i) key.push_back({{receptacle_sign(i)}, kKitchenReceptacleNames[i]});
  key.push_back({{draw_front_sign}, "door"});
  return key;
}

// A bar as long as a metre, with its name; how wide both are.
int draw_metre(Canvas& canvas, int x, int y, int cell, const Pixels& px) {
  const int length = int(std::lround(cell / kCellMetres)), thick = px(1.2), end = px(5);
  canvas.fill({x, y - thick / 2, length, thick}, kInk);
  for (const int at : {x, x + length - thick}) canvas.fill({at, y - end / 2, thick, end}, kInk);
  canvas.text(x + length + px(4), y, "1 m", px(9), kInk, Across::kLeft, Upright::kMiddle);
  return length + px(4) + canvas.font().width("1 m", px(9));
}

}  // namespace

Box receptacle_box(const PlanGrid& place, const Kitchen& kitchen, int receptacle) {
  const Kitchen::Footprint& foot = kitchen.receptacles[size_t(receptacle)];
  return {place.x + foot.column * place.cell, place.y + foot.row * place.cell, foot.columns * place.cell,
          foot.rows * place.cell};
}

void draw_kitchen(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, int doors, Lettering lettering) {
  const std::array<Rgb, 2> tiles = paper_floor(kitchen.hash);
  std::vector<Rgb> colours;
  for (int row = 0; row < kitchen.rows; ++row)
    for (int column = 0; column < kitchen.columns; ++column)
      colours.push_back(kitchen_cell_colour(kitchen.at(row, column), tiles[size_t(row + column) % 2]));
  canvas.squares(place.x, place.y, place.cell, kitchen.columns, colours);
  draw_edges(canvas, place, kitchen);
  for (int i = 0; i < kKitchenReceptacles; ++i) {
    const Box box = receptacle_box(place, kitchen, i);
    const bool open = i < kKitchenDoors && (doors >> i & 1);
    if (i < kKitchenDoors)
      draw_front(canvas, box, kitchen.receptacles[size_t(i)].back, open, place.cell, receptacle_colour(i));
    else
      draw_sink_basin(canvas, box, place.cell);
    const Box free =
        i < kKitchenDoors && !open ? box_without_door(box, kitchen.receptacles[size_t(i)].back, place.cell) : box;
    draw_lettering(canvas, free, i, place.cell, lettering, open ? paper_colour(kInsideColour) : receptacle_colour(i));
  }
}

void draw_object(Canvas& canvas, const Box& box, int object) {
  const Point centre = box.centre();
  const double radius = box.width * 0.46;
  canvas.disc(centre, radius, kInk);
  canvas.disc(centre, radius - std::max(1.0, box.width * 0.06), object_colour(object));
  const int size = box.width * 5 / 8;
  if (size >= 6)
    canvas.text(box.x + box.width / 2, box.y + box.height / 2, std::string(1, kKitchenObjectNames[object][0]), size,
                ink_on(object_colour(object)), Across::kCentre, Upright::kMiddle);
}

void draw_looker(Canvas& canvas, const Box& box, int heading) {
  const Point centre = box.centre();
  const double radius = box.width * 0.48;
  const Point ahead = {double(kColumnStep[heading / 90]), double(kRowStep[heading / 90])};
  const auto at = [&](double forward, double right) {
    return Point{centre.x + (ahead.x * forward - ahead.y * right) * radius,
                 centre.y + (ahead.y * forward + ahead.x * right) * radius};
  };
  canvas.disc(centre, radius, kPaper);
  canvas.disc(centre, radius * 0.88, kPaperAgent);
  canvas.polygon({at(0.68, 0), at(-0.42, 0.52), at(-0.42, -0.52)}, kPaper);
}

Sign object_sign(int object) {
  return [object](Canvas& canvas, const Box& box) { draw_object(canvas, box, object); };
}

void draw_wanted(Canvas& canvas, const Box& box, int object) {
  const Point centre = box.centre();
  canvas.disc(centre, box.width * 0.68, kInk);
  canvas.disc(centre, box.width * 0.6, kPaper);
  draw_object(canvas, box, object);
}

Sign wanted_sign(int object) {
  return [object](Canvas& canvas, const Box& box) {
    const int inset = box.width / 7;
    draw_wanted(canvas, box.inset(inset), object);
  };
}

Sign receptacle_sign(int receptacle) {
  return [receptacle](Canvas& canvas, const Box& box) {
    canvas.fill(box, receptacle_colour(receptacle));
    draw_lettering(canvas, box, receptacle, box.width, Lettering::kLetters, receptacle_colour(receptacle));
  };
}

Canvas draw_kitchens(const std::vector<Kitchen>& kitchens, const MapStyle& style, const Font& font) {
  if (kitchens.empty()) fail(Exit::kUsage, "no kitchen to draw");
  const Pixels px{style.scale};
  const int count = int(kitchens.size());
  const auto lines_of = [count](int length) { return (count + length - 1) / length; };
  // By itself as few a row as the number of rows allows, so that the last one is not short.
  const int wished = style.columns > 0 ? int(style.columns)
                                       : lines_of(lines_of(std::max(1, int(std::lround(std::sqrt(count * 1.6))))));
  const int columns = std::clamp(wished, 1, count), rows = lines_of(columns);
  const int cell = px(count == 1 ? kAloneCellPt : kCellPt), margin = px(12), between_them = px(16), text = px(9),
            small = px(8);
  const int below = px(6) + text + px(4) + small + px(10);

  std::vector<int> widths(size_t(columns), 0), heights(size_t(rows), 0);
  const auto label = [&](const Kitchen& kitchen) { return concat(kitchen.floor.size(), " cells of floor"); };
  for (int i = 0; i < count; ++i) {
    int& width = widths[size_t(i % columns)];
    width = std::max({width, kitchens[size_t(i)].columns * cell, font.width(label(kitchens[size_t(i)]), small)});
    width = std::max(width, std::min(px(90), font.width(kitchens[size_t(i)].name, text)));
    heights[size_t(i / columns)] = std::max(heights[size_t(i / columns)], kitchens[size_t(i)].rows * cell);
  }
  int inside = (columns - 1) * between_them, high = 0;
  for (const int width : widths) inside += width;
  for (const int height : heights) high += height + below;

  const int metre = int(std::lround(cell / kCellMetres)) + px(4) + font.width("1 m", text) + px(18);
  inside = std::max(inside, metre + px(150));
  const Heading heading(style.title, "", inside, style.scale, font);
  const Key key(key_entries(kitchens), inside - metre, style.scale, font);
  const int top = margin + heading.height(), key_y = top + high + px(4);
  Canvas canvas(inside + 2 * margin, key_y + key.height() + margin, font, style.scale);
  heading.draw(canvas, margin, margin);
  int y = top;
  for (int row = 0; row < rows; ++row) {
    const int bottom = y + heights[size_t(row)];
    int x = margin;
    for (int column = 0; column < columns && row * columns + column < count; ++column) {
      const Kitchen& kitchen = kitchens[size_t(row * columns + column)];
      const int width = widths[size_t(column)];
      const PlanGrid place = {x + (width - kitchen.columns * cell) / 2, bottom - kitchen.rows * cell, cell,
                              kitchen.columns};
      draw_kitchen(canvas, place, kitchen, 0, Lettering::kLetters);
      canvas.text(x + width / 2, bottom + px(6), font.fitted(kitchen.name, text, width + between_them - px(4)), text,
                  kInk, Across::kCentre);
      canvas.text(x + width / 2, bottom + px(6) + text + px(4), label(kitchen), small, kSoftInk, Across::kCentre);
      x += width + between_them;
    }
    y = bottom + below;
  }
  draw_metre(canvas, margin, key_y + px(11) / 2, cell, px);
  key.draw(canvas, margin + metre, key_y);
  return canvas;
}

}  // namespace synpo
