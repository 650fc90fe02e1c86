#include "draw/episode/episode_picture.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/key.h"
#include "draw/colour.h"
#include "draw/episode/film_strip.h"
#include "draw/episode/plan_layout.h"
#include "draw/episode/time_bar.h"
#include "draw/face/path.h"
#include "draw/face/plan_grid.h"
#include "world/world.h"

namespace synpo {
namespace {

constexpr double kSidePt = 330, kFrameSidePt = 208, kMarginPt = 12, kTextPt = 9;
constexpr double kLeastWidePt = 240, kLeastHighPt = 90, kWordyPt = 380;  // of small plans, and with words beside them
constexpr double kFrameTitlePt = 13, kFrameTextPt = 11;                  // read while things move
constexpr int kStripColumns = 6;

void draw_way(Canvas& canvas, const WorldFace& face, const PlanGrid& place, const Film& film, int moment, Shown shown) {
  if (place.columns == 0) return;
  face.draw_ground(canvas, place, film, moment, shown);
  face.draw_steps(canvas, place, film, moment);
  draw_start(canvas, place.box(face.agent_cell(film.pair.env, film.states[0])));
  face.draw_things(canvas, place, film, moment, shown);
  draw_counts(canvas, place, face.counted_cells(film, moment));
}

std::vector<TimeMark> time_marks(const WorldFace& face, const Film& film) {
  std::vector<TimeMark> marks;
  for (int i = 0; i < film.steps(); ++i)
    if (const Sign sign = face.event_sign(film, i)) marks.push_back({i + 1, sign});
  return marks;
}

std::vector<StripPicture> strip_pictures(const WorldFace& face, const Film& film, int64_t count) {
  std::vector<StripPicture> pictures;
  if (count == 0) return pictures;
  for (const int i : face.key_moments(film, int(count)))
    pictures.push_back({step_colour(i + 1, film.steps()), concat(i + 1, ": ", face.action_words(film, i)),
                        [&face, &film, i](Canvas& canvas, const Box& box) { face.draw_seen(canvas, box, film, i); }});
  return pictures;
}

// Of a key with an entry a line.
int key_width(const std::vector<KeyEntry>& entries, const Font& font, const Pixels& px) {
  int width = 0;
  for (const KeyEntry& entry : entries) width = std::max(width, px(16) + font.width(entry.name, px(kTextPt)));
  return width;
}

}  // namespace

Canvas draw_episode(const WorldFace& face, const Film& film, const EpisodeStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const PlanSize size = face.plan_size(film.pair.env);
  const PlanLayout plan = lay_out_plan(size, kSidePt, kSidePt, px);
  const int margin = px(kMarginPt), between = px(20), bar = time_bar_width(font, px);
  const std::vector<KeyEntry> entries = face.way_key(film, plan.cell);
  const bool beside = face.key_beside(), has_plan = size.rows > 0;
  const int high = has_plan ? std::max(plan.high, px(kLeastHighPt)) : 0;
  const int inside = beside || !has_plan
                         ? std::max(plan.wide + bar + between + key_width(entries, font, px), px(kWordyPt))
                         : std::max(plan.wide + bar, px(kLeastWidePt));
  const Key key(entries, beside ? 1 : inside, style.scale, font);
  const Heading heading(style.title.empty() ? face.name(film.pair) : style.title, face.describe(film), inside,
                        style.scale, font);
  const FilmStrip strip("what the agent saw as it took these steps" + face.seen_words(film),
                        strip_pictures(face, film, style.strip), kStripColumns, face.seen_unit(), inside, px, font);

  const int plan_y = margin + heading.height() + px(4);
  const int key_x = beside ? margin + plan.wide + bar + between : margin,
            key_y = beside ? plan_y : plan_y + high + px(12);
  const int panel_bottom = std::max(plan_y + high, key_y + key.height()), strip_y = panel_bottom + px(14);
  Canvas canvas(inside + 2 * margin, (strip.height() > 0 ? strip_y + strip.height() : panel_bottom) + margin, font,
                style.scale);
  heading.draw(canvas, margin, margin);
  draw_way(canvas, face, {margin, plan_y, plan.cell, size.columns}, film, film.steps(), Shown::kWhole);
  if (has_plan) draw_time_bar(canvas, margin + plan.wide, plan_y, high, film.steps(), time_marks(face, film), px);
  key.draw(canvas, key_x, key_y);
  strip.draw(canvas, margin, strip_y);
  return canvas;
}

Canvas draw_episode_frame(const WorldFace& face, const Film& film, int moment, const EpisodeStyle& style,
                          const Font& font) {
  const Pixels px{style.scale};
  const PlanSize size = face.plan_size(film.pair.env);
  const PlanLayout plan = lay_out_plan(size, kFrameSidePt, kFrameSidePt, px);
  const int margin = px(kMarginPt), between = px(kMarginPt), title = px(kFrameTitlePt), text = px(kFrameTextPt),
            text_y = margin + px(19), panels_y = text_y + px(19);
  const int side = std::max(square_side(kFrameSidePt, face.seen_unit(), px), plan.high),
            width = plan.wide + between + side;
  const auto even = [](int n) { return n + n % 2; };
  Canvas canvas(even(2 * margin + width), even(panels_y + side + margin), font, style.scale);
  canvas.text(margin, margin, font.fitted(style.title.empty() ? face.name(film.pair) : style.title, title, width),
              title, kInk);
  const std::string words =
      moment == film.steps() ? concat(face.outcome(film), " after step ", moment)
                             : concat("step ", moment + 1, " of ", film.steps(), ": ", face.action_words(film, moment));
  canvas.text(margin, text_y, font.fitted(words, text, plan.wide > 0 ? plan.wide : width), text, kSoftInk);
  if (plan.wide > 0)
    canvas.text(margin + plan.wide + between, text_y, font.fitted("what the agent sees", text, side), text, kSoftInk);
  draw_way(canvas, face, {margin, panels_y + (side - plan.high) / 2, plan.cell, size.columns}, film, moment,
           Shown::kMoment);
  face.draw_seen(canvas, {margin + plan.wide + between, panels_y, side, side}, film, moment);
  return canvas;
}

}  // namespace synpo
