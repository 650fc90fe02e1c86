#include "draw/episode/agent_view.h"

#include <algorithm>

#include "draw/canvas/heading.h"
#include "draw/canvas/key.h"
#include "draw/colour.h"
#include "draw/episode/history_row.h"
#include "draw/episode/plan_layout.h"
#include "draw/face/plan_grid.h"
#include "world/observation.h"
#include "world/world.h"

namespace synpo {
namespace {

constexpr double kMarginPt = 12, kTextPt = 9, kInputPt = 110;
constexpr double kLeastPt = 360;  // what the words beneath need

}  // namespace

Canvas draw_agent_view(const WorldFace& face, const Film& film, const ViewStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int moment = film.steps();
  const PlanSize size = face.plan_size(film.pair.env);
  const ViewPanels panels = face.view_panels(film);
  const PlanLayout plan = lay_out_plan(size, panels.wide_pt, panels.side_pt, px);
  const int margin = px(kMarginPt), between = px(panels.between_pt), text = px(kTextPt), heading = text + px(8);
  const int side = std::max(square_side(panels.side_pt, face.seen_unit(), px), plan.high),
            plan_width = std::max(plan.wide, font.width(panels.plan_title, text)),
            before_seen = size.rows > 0 ? plan_width + between : 0, inside = std::max(before_seen + side, px(kLeastPt));

  const bool has_input = !style.history && !panels.input_title.empty();
  const HistoryRow row(inside, face.input_unit(), px);
  const int input = has_input ? std::max(1, px(kInputPt) / face.input_unit()) * face.input_unit() : 0;
  const int key_x = has_input ? margin + input + between : margin;
  const Key key(face.view_key(film), margin + inside - key_x, style.scale, font);
  const std::string caption = face.view_caption(film);
  const Heading title(style.title.empty() ? face.view_title(film) : style.title, caption, inside, style.scale, font);
  const int headings_y = margin + title.height() + (caption.empty() ? 0 : px(2)), panels_y = headings_y + heading;
  const int beneath_y = panels_y + side + px(14);
  const int key_y = style.history ? beneath_y + row.height() + px(14) : beneath_y + (has_input ? heading : 0);
  Canvas canvas(inside + 2 * margin, key_y + std::max(key.height(), input) + margin, font, style.scale);

  title.draw(canvas, margin, margin);
  const int seen_x = margin + before_seen;
  canvas.text(seen_x, headings_y, panels.seen_title, text, kSoftInk);
  const PlanGrid place = {margin + (plan_width - plan.wide) / 2, panels_y + (side - plan.high) / 2, plan.cell,
                          size.columns};
  if (size.rows > 0) {
    canvas.text(margin, headings_y, panels.plan_title, text, kSoftInk);
    face.draw_moment(canvas, place, film, moment);
  }
  face.draw_seen(canvas, {seen_x, panels_y, side, side}, film, moment);
  if (style.history)
    row.draw(canvas, margin, beneath_y, panels.inputs_title, moment + 1, [&](const Box& box, int i, bool missing) {
      face.draw_input(canvas, box, film, missing ? -1 : moment - (kHistory - 1) + i);
    });
  if (has_input) {
    canvas.text(margin, beneath_y, panels.input_title, text, kSoftInk);
    face.draw_input(canvas, {margin, beneath_y + heading, input, input}, film, moment);
  }
  key.draw(canvas, key_x, key_y);
  return canvas;
}

}  // namespace synpo
