#include "draw/face/world_face.h"

#include <cstddef>
#include <cstdint>
#include <numeric>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/colour.h"
#include "draw/face/episode_words.h"
#include "draw/face/path.h"
#include "draw/paper.h"
#include "world/observation.h"

namespace synpo {

const FaceKind& WorldFace::kind() const {
  static const FaceKind kind;
  return kind;
}

std::string WorldFace::name(EnvTask pair) const {
  return concat(world().environments()[size_t(pair.env)].name, ", task ", world().task_names()[size_t(pair.task)]);
}

std::string WorldFace::outcome(const Film& film) const {
  const WorldStep& end = film.results.back();
  return end.success ? "success" : end.wrong ? "wrong" : end.truncated ? "timeout" : "unfinished";
}

std::string WorldFace::action_words(const Film& film, int i) const {
  return world().action_names()[film.actions[size_t(i)]];
}

std::string WorldFace::deeds(const Film&) const { return ""; }

std::string WorldFace::describe(const Film& film) const {
  return describe_end(outcome(film), film.results, expert_steps(world(), film.pair, film.states[0])) + deeds(film);
}

std::string WorldFace::next_words(const Film& film) const {
  if (film.terminated()) return "success";
  return "the expert's next action: " + world().action_names()[size_t(world().expert(film.pair, film.states.back()))];
}

Sign WorldFace::event_sign(const Film&, int) const { return nullptr; }

std::vector<int> WorldFace::key_moments(const Film& film, int count) const {
  std::vector<int> events;
  for (int i = 0; i < film.steps(); ++i)
    if (event_sign(film, i)) events.push_back(i);
  return spread_moments(film.steps(), events, count);
}

PlanSize WorldFace::plan_size(int) const { return {}; }

int WorldFace::agent_cell(int, const WorldState&) const { return 0; }

std::vector<int> WorldFace::agent_cells(const Film& film, int moment) const {
  std::vector<int> cells;
  for (int i = 0; i <= moment; ++i) cells.push_back(agent_cell(film.pair.env, film.states[size_t(i)]));
  return cells;
}

Canvas WorldFace::draw_plans(const std::vector<int>& envs, const MapStyle& style, const Font& font) const {
  if (envs.empty()) fail(Exit::kUsage, "no ", kind().environment, " to draw");
  const Pixels px{style.scale};
  const int margin = px(12), inside = px(400);
  std::vector<KeyEntry> names;
  for (const int env : envs)
    names.push_back({{}, font.fitted(world().environments()[size_t(env)].name, px(9), inside)});
  const Heading heading(style.title, "", inside, style.scale, font);
  const Key key(names, inside, style.scale, font);
  Canvas canvas(inside + 2 * margin, margin + heading.height() + key.height() + margin, font, style.scale);
  heading.draw(canvas, margin, margin);
  key.draw(canvas, margin, margin + heading.height());
  return canvas;
}

BlockPlan WorldFace::block_plan(int env) const { return {world().environments()[size_t(env)].name, 0, 0, nullptr}; }

std::string WorldFace::plans_text(const std::vector<int>& envs, const MapStyle& style, TerminalColour colour,
                                  int width) const {
  std::vector<BlockPlan> plans;
  for (const int env : envs) plans.push_back(block_plan(env));
  return terminal_plans(plans, style, colour, width);
}

void WorldFace::draw_ground(Canvas& canvas, const PlanGrid& place, const Film& film, int, Shown) const {
  const PlanSize size = plan_size(film.pair.env);
  canvas.fill({place.x, place.y, size.columns * place.cell, size.rows * place.cell}, kPaperFloor);
}

void WorldFace::draw_steps(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const {
  draw_path(canvas, place, agent_cells(film, moment), film.steps(), kPaperFloor);
}

void WorldFace::draw_things(Canvas&, const PlanGrid&, const Film&, int, Shown) const {}

std::vector<int> WorldFace::counted_cells(const Film& film, int moment) const { return agent_cells(film, moment); }

std::vector<KeyEntry> WorldFace::way_key(const Film& film, int cell) const {
  if (plan_size(film.pair.env).rows == 0) return {};
  std::vector<KeyEntry> key = {{{draw_start}, "start"}};
  if (has_counts(cell, counted_cells(film, film.steps()))) key.push_back({{draw_count_sign}, "moments in this cell"});
  return key;
}

bool WorldFace::key_beside() const { return false; }

std::string WorldFace::film_text(const Film& film, TerminalColour) const {
  std::string text = name(film.pair) + '\n';
  for (int i = 0; i < film.steps(); ++i) text += concat(i + 1, ": ", action_words(film, i), '\n');
  return text + describe(film) + '\n';
}

int WorldFace::seen_unit() const { return shows_pictures() ? world().observation_spec().side : 1; }

void WorldFace::draw_seen(Canvas& canvas, const Box& box, const Film& film, int moment) const {
  if (shows_pictures()) return draw_observation(canvas, box, film, moment);
  canvas.fill(box, kPaper);
  const int size = box.width / 8;
  if (size >= 6)
    canvas.text(box.x + box.width / 2, box.y + box.height / 2, concat("moment ", moment), size, kSoftInk,
                Across::kCentre, Upright::kMiddle);
}

bool WorldFace::shows_pictures() const { return world().observation_spec().sight == Sight::kPictures; }

void WorldFace::draw_observation(Canvas& canvas, const Box& box, const Film& film, int moment) const {
  const ObservationSpec& spec = world().observation_spec();
  std::vector<uint8_t> observation(spec.bytes());
  StateHistory history;
  history.push(film.states[size_t(moment)]);
  world().observe(film.pair.env, history, film.window, observation.data());
  std::vector<Rgb> colours;
  for (int at = 0; at < spec.side * spec.side; ++at)
    colours.push_back(spec.palette[observation[size_t(at * kHistory + kHistory - 1)]]);
  canvas.squares(box.x, box.y, box.width / spec.side, spec.side, colours);
}

std::string WorldFace::seen_words(const Film&) const { return ""; }

ViewPanels WorldFace::view_panels(const Film& film) const {
  if (plan_size(film.pair.env).rows == 0)
    return {.plan_title = "",
            .seen_title = "what the agent sees",
            .inputs_title = "the last four pictures",
            .input_title = ""};
  return {.plan_title = concat("(a) the ", kind().environment),
          .seen_title = "(b) what the agent sees",
          .inputs_title = "(c) the last four pictures",
          .input_title = ""};
}

std::string WorldFace::view_title(const Film& film) const {
  return concat(name(film.pair), ", step ", film.steps(), film.terminated() ? ": " : "; ", next_words(film));
}

std::string WorldFace::view_caption(const Film&) const { return ""; }

void WorldFace::draw_moment(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const {
  draw_ground(canvas, place, film, moment, Shown::kMoment);
  draw_start(canvas, place.box(agent_cell(film.pair.env, film.states[size_t(moment)])));
}

int WorldFace::input_unit() const { return seen_unit(); }

void WorldFace::draw_input(Canvas& canvas, const Box& box, const Film& film, int moment) const {
  if (moment < 0)
    canvas.fill(box, {0, 0, 0});
  else
    draw_seen(canvas, box, film, moment);
}

std::vector<KeyEntry> WorldFace::view_key(const Film&) const { return {}; }

std::vector<int> WorldFace::task_order() const {
  std::vector<int> order(size_t(world().task_count()));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

Sign WorldFace::task_sign(int) const { return nullptr; }

std::string WorldFace::task_sign_words() const { return ""; }

std::vector<PolicyStage> WorldFace::policy_stages(EnvTask, const WorldState&) const { return {}; }

Canvas WorldFace::draw_policy(EnvTask, const std::vector<PolicyStage>&, const PolicyPictureStyle&, const Font&) const {
  fail(Exit::kInternal, "a picture of a policy in a world that has none");
}

}  // namespace synpo
