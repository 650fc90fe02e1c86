#include "draw/grid/grid_face.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "base/rgb.h"
#include "base/text.h"
#include "draw/colour.h"
#include "draw/face/episode_words.h"
#include "draw/face/path.h"
#include "draw/grid/maze_picture.h"
#include "draw/grid/policy_picture.h"
#include "draw/paper.h"
#include "world/grid/view.h"
#include "world/observation.h"

namespace synpo {
namespace {

constexpr Rgb kWindow = {0, 150, 160};

GridFrame frame(const Film& film, int moment) { return to_grid_state(film.states[size_t(moment)]).now; }

void draw_picked(Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 9), kPaperAgent); }

void draw_wrong(Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 5), kPaperWrong); }

auto pick_mark(const Film& film, int i) { return film.results[size_t(i)].wrong ? draw_wrong : draw_picked; }

std::string window_words(const Film& film) {
  const int side = 2 * film.window + 1;
  return concat("window ", side, " x ", side);
}

}  // namespace

const FaceKind GridFace::kKind = {.environment = "maze",
                                  .environments = "mazes",
                                  .task_hint = "two of R B G O P, such as R-B",
                                  .has_window = true,
                                  .has_text = true,
                                  .has_policy_picture = true};

int treasure_picked(const Film& film, int i) {
  return film.actions[size_t(i)] == kPick ? treasure_under_agent(frame(film, i)) : -1;
}

std::string GridFace::outcome(const Film& film) const {
  return film.results.back().wrong ? "wrong pick" : WorldFace::outcome(film);
}

std::string GridFace::action_words(const Film& film, int i) const {
  const int picked = treasure_picked(film, i);
  return WorldFace::action_words(film, i) + (picked < 0 ? "" : concat(" ", kTreasureLetters[picked]));
}

std::string GridFace::deeds(const Film& film) const {
  int bumps = 0, empty_picks = 0;
  std::string picks;
  for (int i = 0; i < film.steps(); ++i) {
    if (film.actions[size_t(i)] == kPick) {
      const int treasure = treasure_picked(film, i);
      if (treasure < 0)
        ++empty_picks;
      else
        picks += concat(picks.empty() ? "; " : ", ", kTreasureLetters[treasure], " at step ", i + 1);
    } else if (frame(film, i).agent == frame(film, i + 1).agent) {
      ++bumps;
    }
  }
  std::string out = picks.empty() ? "; no treasure picked" : picks;
  if (bumps > 0) out += "; " + counted(bumps, "step") + " into walls";
  if (empty_picks > 0) out += "; " + counted(empty_picks, "pick") + " where nothing lies";
  return out;
}

Sign GridFace::event_sign(const Film& film, int i) const {
  const int treasure = treasure_picked(film, i);
  if (treasure < 0) return nullptr;
  return [treasure, mark = pick_mark(film, i)](Canvas& canvas, const Box& box) {
    draw_treasure(canvas, box, treasure);
    mark(canvas, box);
  };
}

Canvas GridFace::draw_plans(const std::vector<int>& envs, const MapStyle& style, const Font& font) const {
  std::vector<Maze> mazes;
  for (const int env : envs) mazes.push_back(grid_.maze(env));
  return draw_maps(mazes, style, font);
}

BlockPlan GridFace::block_plan(int env) const {
  const Maze& maze = grid_.maze(env);
  return {maze.name, kGridSide, kGridSide, [&maze](int row, int column) {
            return maze.wall[row * kGridSide + column] ? Block{kPaperWall, ' ', '#'} : Block{kPaperFloor, ' ', ' '};
          }};
}

void GridFace::draw_ground(Canvas& canvas, const PlanGrid& place, const Film& film, int, Shown) const {
  draw_maze(canvas, place.x, place.y, place.cell, maze(film));
}

void GridFace::draw_things(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const {
  const GridFrame first = frame(film, 0);
  for (int i = 0; i < kTreasures; ++i) {
    draw_treasure(canvas, place.box(first.treasures[i]), i);
    if (first.treasures[i] == first.agent) draw_start(canvas, place.box(first.agent));
  }
  for (int i = 0; i < moment; ++i)
    if (const int picked = treasure_picked(film, i); picked >= 0)
      pick_mark(film, i)(canvas, place.box(first.treasures[picked]));
  // Where an episode has ended a pick has, and its mark is there.
  if (shown == Shown::kMoment || !film.terminated()) draw_agent(canvas, place.box(frame(film, moment).agent));
}

std::vector<KeyEntry> GridFace::way_key(const Film& film, int cell) const {
  std::vector<KeyEntry> key = {{{draw_start}, "start"}};
  if (!film.terminated()) key.push_back({{draw_agent}, "end"});
  key.push_back({{treasure_sign(task(film).first)}, "pick first"});
  key.push_back({{treasure_sign(task(film).second)}, "pick second"});
  if (to_grid_state(film.states.back()).picked > 0) key.push_back({{draw_picked}, "picked"});
  if (film.results.back().wrong) key.push_back({{draw_wrong}, "wrong pick"});
  if (has_counts(cell, counted_cells(film, film.steps()))) key.push_back({{draw_count_sign}, "moments in this cell"});
  return key;
}

std::string GridFace::film_text(const Film& film, TerminalColour colour) const {
  std::string content[kGridCells];
  Rgb ground[kGridCells];
  const bool coloured = colour != TerminalColour::kNone;
  const size_t width = coloured ? 3 : 4;  // numbers keep apart, by colours or by a blank
  for (int cell = 0; cell < kGridCells; ++cell) {
    const bool wall = maze(film).wall[cell];
    ground[cell] = wall ? kPaperWall : kPaperFloor;
    content[cell] = std::string(width, wall && !coloured ? '#' : ' ');
  }
  for (int i = 0; i <= film.steps(); ++i) {
    const int cell = frame(film, i).agent;
    if (i > 0 && frame(film, i - 1).agent == cell) continue;
    ground[cell] = time_colour(double(i) / film.steps());
    const std::string step = concat(i);
    content[cell] = std::string(width - step.size(), ' ') + step;
  }
  for (int i = 0; i < kTreasures; ++i) {
    const int cell = frame(film, 0).treasures[i];
    ground[cell] = kPaperTreasures[i];
    content[cell] = concat(kTreasureLetters[i], content[cell].substr(1));
  }
  std::string text = name(film.pair) + '\n';
  for (int cell = 0; cell < kGridCells; ++cell) {
    text += coloured ? ground_code(ground[cell], colour) + content[cell] + kPlainCode : content[cell];
    if (cell % kGridSide == kGridSide - 1) text += '\n';
  }
  return text + describe(film) + '\n';
}

std::string GridFace::seen_words(const Film& film) const { return ", " + window_words(film); }

ViewPanels GridFace::view_panels(const Film& film) const {
  return {.plan_title = "(a) the maze",
          .seen_title = "(b) what the agent sees, " + window_words(film),
          .inputs_title = "(c) the network's input: the last four pictures",
          .input_title = "",
          .side_pt = 208,
          .wide_pt = 208,
          .between_pt = 24};
}

void GridFace::draw_moment(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const {
  const GridFrame now = frame(film, moment);
  draw_maze(canvas, place.x, place.y, place.cell, maze(film));
  for (int i = 0; i < kTreasures; ++i)
    if (now.treasures[i] != kPicked) draw_treasure(canvas, place.box(now.treasures[i]), i);
  draw_agent(canvas, place.box(now.agent));
  const int row = now.agent / kGridSide, column = now.agent % kGridSide, radius = film.window, cell = place.cell;
  const int top = std::max(0, row - radius), left = std::max(0, column - radius);
  const int bottom = std::min(kGridSide - 1, row + radius), right = std::min(kGridSide - 1, column + radius);
  canvas.frame({place.x + left * cell, place.y + top * cell, (right - left + 1) * cell, (bottom - top + 1) * cell},
               std::max(2, cell / 7), kWindow);
}

std::vector<KeyEntry> GridFace::view_key(const Film& film) const {
  std::vector<KeyEntry> key;
  const auto seen = [](int colour) { return colour_sign(kPalette[colour]); };
  key.push_back({{draw_agent, seen(kAgent)}, "agent"});
  for (int i = 0; i < kTreasures; ++i) {
    const int place = i == task(film).first ? 1 : i == task(film).second ? 2 : 0;
    std::string name = kTreasureNames[i];
    if (place)
      name += to_grid_state(film.states.back()).picked >= place ? " (picked)"
              : place == 1                                      ? " (pick first)"
                                                                : " (pick second)";
    key.push_back({{treasure_sign(i), seen(kFirstTreasure + i)}, name});
  }
  key.push_back({{colour_sign(kPaperWall), seen(kWall)}, "wall"});
  key.push_back({{colour_sign(kPaperFloor), seen(kFloor)}, "floor"});
  key.push_back({{seen(kUnseen)}, "not seen"});
  key.push_back(
      {{[](Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 7), kWindow); }}, "window"});
  return key;
}

// By their first treasures, then their second ones.
std::vector<int> GridFace::task_order() const {
  std::vector<int> order = WorldFace::task_order();
  const auto treasures = [&](int i) {
    return std::pair(grid_.tasks()[size_t(i)].first, grid_.tasks()[size_t(i)].second);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return treasures(a) < treasures(b); });
  return order;
}

Sign GridFace::task_sign(int task) const {
  return [&task = grid_.tasks()[size_t(task)]](Canvas& canvas, const Box& box) { draw_task(canvas, box, task); };
}

std::string GridFace::task_sign_words() const { return "left its first treasure, right its second"; }

std::vector<PolicyStage> GridFace::policy_stages(EnvTask pair, const WorldState& start) const {
  const GridState first = to_grid_state(start);
  GridState second = first;
  second.now.treasures[size_t(grid_.tasks()[size_t(pair.task)].first)] = kPicked;
  second.picked = 1;
  std::vector<PolicyStage> stages;
  for (GridState state : {first, second}) {
    PolicyStage stage{{}, state.picked == 0 ? 1 : kHistory, {}};
    for (const uint8_t cell : grid_.maze(pair.env).free_cells) {
      state.now.agent = cell;
      stage.states.push_back(to_world_state(state));
    }
    stages.push_back(stage);
  }
  return stages;
}

Canvas GridFace::draw_policy(EnvTask pair, const std::vector<PolicyStage>& stages, const PolicyPictureStyle& style,
                             const Font& font) const {
  return draw_maze_policy(grid_.maze(pair.env), grid_.tasks()[size_t(pair.task)], stages, style, font);
}

}  // namespace synpo
