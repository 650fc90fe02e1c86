#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "draw/colour.h"
#include "draw/episode/agent_view.h"
#include "draw/grid/maze_picture.h"
#include "draw/paper.h"
#include "draw/terminal/terminal.h"
#include "helpers/faces.h"
#include "helpers/font.h"
#include "world/grid/view.h"

namespace synpo {
namespace {

TEST(Maps, AllBuiltinMazesFitInAGrid) {
  const Canvas canvas = draw_maps(builtin_mazes(), {}, font());
  EXPECT_EQ(canvas.clipped(), 0);
  EXPECT_GT(canvas.width(), canvas.height());
  MapStyle one_row;
  one_row.columns = 20;
  EXPECT_GT(draw_maps(builtin_mazes(), one_row, font()).width(), 3 * canvas.width());
  EXPECT_THROW(draw_maps({}, {}, font()), Error);
}

TEST(Maps, WallsAreDark) {
  const Maze& maze = builtin_mazes()[0];
  Canvas canvas(16 * 10, 16 * 10, font());
  draw_maze(canvas, 0, 0, 10, maze);
  for (int cell = 0; cell < kGridCells; ++cell)
    EXPECT_EQ(canvas.at(cell % 16 * 10 + 5, cell / 16 * 10 + 5), maze.wall[cell] ? kPaperWall : kPaperFloor) << cell;
}

TEST(GridFilm, SaysWhatCameOfAnEpisode) {
  EXPECT_EQ(grid_face().describe(grid_film(kGridSuccess)),
            "success after 5 steps (the fewest), reward 11.95; R at step 3, B at step 5");
  EXPECT_EQ(grid_face().describe(grid_film({kUp, kPick, kRight, kRight, kPick, kRight, kPick})),
            "success after 7 steps (5 would do), reward 11.92; R at step 5, B at step 7; 1 step into walls; 1 pick "
            "where nothing lies");
  EXPECT_EQ(grid_face().describe(grid_film({kRight, kRight, kRight, kPick})),
            "wrong pick after 4 steps (success takes 5), reward \u221210.04; B at step 4");
  EXPECT_EQ(grid_face().describe(grid_film(std::vector<uint8_t>(300, kUp))),
            "timeout after 300 steps (success takes 5), reward \u22126.00; no treasure picked; 300 steps into walls");
  EXPECT_EQ(grid_face().outcome(grid_film({kRight})), "unfinished");
}

TEST(GridFilm, KeyMomentsKeepFirstPicksAndLast) {
  std::vector<uint8_t> actions(100, kUp);
  for (const uint8_t action : kGridSuccess) actions.push_back(action);
  const Film long_one = grid_film(actions);
  EXPECT_EQ(grid_face().key_moments(long_one, 0), (std::vector<int>{}));
  EXPECT_EQ(grid_face().key_moments(long_one, 1), (std::vector<int>{0}));
  EXPECT_EQ(grid_face().key_moments(long_one, 2), (std::vector<int>{0, 104}));
  EXPECT_EQ(grid_face().key_moments(long_one, 3), (std::vector<int>{0, 102, 104}));
  EXPECT_EQ(grid_face().key_moments(long_one, 5), (std::vector<int>{0, 34, 68, 102, 104}));
  EXPECT_EQ(grid_face().key_moments(grid_film(kGridSuccess), 12), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(grid_face().key_moments(grid_film({kRight}), 12), (std::vector<int>{0}));
  for (int count = 3; count <= 106; ++count) {
    const std::vector<int> moments = grid_face().key_moments(long_one, count);
    const std::set<int> distinct(moments.begin(), moments.end());
    EXPECT_EQ(distinct.size(), size_t(std::min(count, 105))) << count;
    EXPECT_TRUE(distinct.contains(0) && distinct.contains(102) && distinct.contains(104)) << count;
  }
}

TEST(TerminalPath, WithoutColour) {
  const std::string text = grid_face().film_text(grid_film(kGridSuccess), TerminalColour::kNone);
  const std::string wall(16 * 4, '#');
  EXPECT_TRUE(text.starts_with("open, task R-B\n" + wall + "\n####   0   1R  2B  4" + std::string(40, ' ') + "####\n"))
      << text;
  EXPECT_TRUE(text.ends_with(wall + "\n" + grid_face().describe(grid_film(kGridSuccess)) + "\n")) << text;
  EXPECT_EQ(text.find('\033'), std::string::npos);
}

TEST(TerminalPath, BlocksOfColour) {
  const std::string text = grid_face().film_text(grid_film(kGridSuccess), TerminalColour::kTrue);
  EXPECT_NE(text.find(ground_code(time_colour(0.2), TerminalColour::kTrue) + "  1" + kPlainCode), std::string::npos);
  EXPECT_NE(text.find(ground_code(kPaperTreasures[1], TerminalColour::kTrue) + "B 4" + kPlainCode), std::string::npos);
}

TEST(AgentView, ShowsThePaletteOfTheAgentsPicture) {
  const GridFace face(std::make_shared<const GridSet>(builtin_mazes()));
  const Random start(1, Purpose::kEpisodeStart, 0, 0);
  for (const int radius : {0, 1, 15})
    for (const bool history : {false, true}) {
      ViewStyle style;
      style.history = history;
      const Canvas canvas = draw_agent_view(face, expert_film(face.world(), {0, 0}, start, 3, radius), style, font());
      EXPECT_EQ(canvas.clipped(), 0);
      int wall = 0;
      for (int y = 0; y < canvas.height(); ++y)
        for (int x = 0; x < canvas.width(); ++x) wall += canvas.at(x, y) == kPalette[kWall];
      EXPECT_EQ(wall > 10'000, radius == 15) << radius;
    }
}

TEST(ExpertFilm, FollowsThePlanner) {
  const GridSet world(builtin_mazes());
  const EnvTask pair = {4, 7};
  const Random start(3, Purpose::kEpisodeStart, 7, 2);
  const auto film = [&](int steps) { return expert_film(world, pair, start, steps, 1); };
  const Film first = film(0);
  EXPECT_EQ(first.states.size(), 1u);
  EXPECT_EQ(first.states[0].steps, 0);
  EXPECT_FALSE(first.terminated());
  int length = 0;
  while (!film(length).terminated()) ++length;
  const Film whole = film(length);
  EXPECT_EQ(to_grid_state(whole.states.back()).picked, 2);
  EXPECT_EQ(whole.actions.back(), kPick);
  EXPECT_THROW(film(length + 1), Error);
  EXPECT_EQ(expert_steps(world, pair, first.states[0]), length);
  EXPECT_EQ(world.planner(pair.env).steps_to_success(world.tasks()[7], to_grid_state(first.states[0])), length);
}

GridState treasures() {
  GridState state;
  state.now.agent = cell(7, 7);
  state.now.treasures = {cell(1, 3), cell(3, 1), cell(14, 2), cell(14, 3), cell(14, 4)};
  return state;
}

// UP everywhere, with this probability.
PolicyStage always_up(size_t number, double probability) {
  PolicyStage stage = grid_face().policy_stages(red_blue(), to_world_state(treasures()))[number];
  const double rest = (1 - probability) / 4;
  stage.choices =
      compare_to_expert(grid_face().world(), red_blue(), stage.states,
                        std::vector(stage.states.size(), std::vector<double>{probability, rest, rest, rest, rest}));
  return stage;
}

const PolicyChoice& at(const PolicyStage& stage, uint8_t cell) {
  const auto found = std::find_if(stage.states.begin(), stage.states.end(),
                                  [&](const WorldState& state) { return to_grid_state(state).now.agent == cell; });
  return stage.choices[size_t(found - stage.states.begin())];
}

TEST(PolicyStage, OptimalActionsByHand) {
  const PolicyStage stage = always_up(0, 0.6);
  using Optimal = std::vector<bool>;
  EXPECT_EQ(at(stage, cell(1, 3)).optimal, (Optimal{false, false, false, false, true}));
  EXPECT_EQ(at(stage, cell(2, 3)).optimal, (Optimal{true, false, false, false, false}));
  EXPECT_EQ(at(stage, cell(2, 4)).optimal, (Optimal{true, false, true, false, false}));
  EXPECT_EQ(at(stage, cell(3, 1)).optimal, (Optimal{true, false, false, true, false})) << "B is not yet to be picked";
  EXPECT_EQ(at(stage, cell(5, 5)).action, kUp);
  EXPECT_EQ(at(stage, cell(5, 5)).probability, 0.6);
  EXPECT_EQ(stage.choices.size(), 14u * 14);
  EXPECT_EQ(stage.agreeing(), 13 * 14) << "all rows but that of R";
}

TEST(PolicyStage, TheSecondStageLeadsToTheSecondTreasure) {
  EXPECT_EQ(always_up(1, 0.6).agreeing(), 11 * 14);
  const auto stages = grid_face().policy_stages(red_blue(), to_world_state(treasures()));
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0].remembered, 1);
  EXPECT_EQ(stages[1].remembered, kHistory);
  for (const WorldState& state : stages[1].states) {
    EXPECT_EQ(to_grid_state(state).picked, 1);
    EXPECT_EQ(to_grid_state(state).now.treasures[0], kPicked);
  }
}

TEST(PolicyPicture, NothingIsClippedAndDisagreementHasAGround) {
  for (const double scale : {0.25, 1.0, 2.0})
    for (const int stages : {1, 2}) {
      const auto draw = [&] {
        return grid_face().draw_policy(red_blue(), std::vector(size_t(stages), always_up(0, 0.6)),
                                       {"title", "caption", scale}, font());
      };
      EXPECT_EQ(draw().clipped(), 0) << scale;
      EXPECT_EQ(draw().png(), draw().png());
    }
}

}  // namespace
}  // namespace synpo
