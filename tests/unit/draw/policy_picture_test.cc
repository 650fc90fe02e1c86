#include "draw/grid/policy_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "draw/grid/maze_picture.h"
#include "draw/plot/embedding_picture.h"
#include "draw/plot/labels.h"
#include "helpers/mazes.h"

namespace synpo {
namespace {

const Font& font() {
  static const Font shared;
  return shared;
}

const Task kRedBlue = {0, 1};

GridState treasures() {
  GridState state;
  state.now.treasures = {cell(1, 3), cell(3, 1), cell(14, 2), cell(14, 3), cell(14, 4)};
  return state;
}

// UP everywhere, with this probability.
PolicyStage always_up(const Maze& maze, const GridState& state, double probability) {
  const double rest = (1 - probability) / 4;
  return compare_to_planner(
      maze, Planner(maze), kRedBlue, state,
      std::vector(maze.free_cells.size(), std::array<double, kGridActions>{probability, rest, rest, rest, rest}));
}

const PolicyCell& at(const PolicyStage& stage, uint8_t cell) {
  return *std::find_if(stage.cells.begin(), stage.cells.end(),
                       [&](const PolicyCell& each) { return each.cell == cell; });
}

TEST(PolicyStage, OptimalActionsByHand) {
  const Maze maze = open_maze();
  const PolicyStage stage = always_up(maze, treasures(), 0.6);
  using Optimal = std::array<bool, kGridActions>;
  EXPECT_EQ(at(stage, cell(1, 3)).optimal, (Optimal{false, false, false, false, true}));
  EXPECT_EQ(at(stage, cell(2, 3)).optimal, (Optimal{true, false, false, false, false}));
  EXPECT_EQ(at(stage, cell(2, 4)).optimal, (Optimal{true, false, true, false, false}));
  EXPECT_EQ(at(stage, cell(3, 1)).optimal, (Optimal{true, false, false, true, false})) << "B is not yet to be picked";
  EXPECT_EQ(at(stage, cell(5, 5)).action, kUp);
  EXPECT_EQ(at(stage, cell(5, 5)).probability, 0.6);
  EXPECT_EQ(stage.cells.size(), 14u * 14);
  EXPECT_EQ(stage.agreeing(), 13 * 14) << "all rows but that of R";
}

TEST(PolicyStage, TheSecondStageLeadsToTheSecondTreasure) {
  const Maze maze = open_maze();
  GridState state = treasures();
  state.now.treasures[0] = kPicked;
  state.picked = 1;
  EXPECT_EQ(always_up(maze, state, 0.6).agreeing(), 11 * 14);
}

TEST(PolicyPicture, NothingIsClippedAndDisagreementHasAGround) {
  const Maze maze = open_maze();
  const PolicyStage stage = always_up(maze, treasures(), 0.6);
  for (const double scale : {0.25, 1.0, 2.0})
    for (const int stages : {1, 2}) {
      const Canvas canvas =
          draw_policy(maze, kRedBlue, std::vector(size_t(stages), stage), {"title", "caption", scale}, font());
      EXPECT_EQ(canvas.clipped(), 0) << scale;
      EXPECT_EQ(
          canvas.png(),
          draw_policy(maze, kRedBlue, std::vector(size_t(stages), stage), {"title", "caption", scale}, font()).png());
    }
}

Embeddings tasks_on_a_line(int count) {
  Embeddings panel{"tasks", {}, {}, 3, {}};
  for (int i = 0; i < count; ++i) {
    panel.marks.push_back([i](Canvas& canvas, const Box& box) { draw_task(canvas, box, grid_tasks()[i]); });
    panel.names.push_back(grid_tasks()[i].name());
    for (const double value : {1.0 * i, 0.0, i % 2 * 0.1}) panel.values.push_back(value);
  }
  return panel;
}

TEST(EmbeddingPicture, NothingIsClipped) {
  Embeddings envs{"environments",
                  {"a maze with a name that is longer than any maze's name should ever be", "map1", "map2"},
                  {},
                  2,
                  {0, 0, 1, 1, 2, 0}};
  Embeddings alike{"alike", {"x", "y"}, {}, 2, {1, 1, 1, 1}};
  for (const double scale : {0.5, 1.0, 2.0}) {
    const EmbeddingStyle style{"title", "caption", scale};
    for (const auto& panels :
         {std::vector{envs, tasks_on_a_line(20)}, std::vector{alike}, std::vector{tasks_on_a_line(2)}}) {
      EXPECT_EQ(draw_embedding_map(panels, style, font()).clipped(), 0) << scale;
      EXPECT_EQ(draw_embedding_distances(panels, Distance::kCosine, style, font()).clipped(), 0) << scale;
      EXPECT_EQ(draw_embedding_distances(panels, Distance::kEuclidean, style, font()).clipped(), 0) << scale;
    }
  }
  EXPECT_ANY_THROW(draw_embedding_map({tasks_on_a_line(1)}, {}, font()));
}

TEST(EmbeddingPicture, ATaskHasTheColoursOfItsTreasures) {
  Canvas canvas(20, 20, font());
  draw_task(canvas, {0, 0, 20, 20}, {2, 4});
  const auto same = [](Rgb a, Rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; };
  EXPECT_TRUE(same(canvas.at(5, 10), kPaperTreasures[2]));
  EXPECT_TRUE(same(canvas.at(15, 10), kPaperTreasures[4]));
}

TEST(Labels, KeepApart) {
  std::vector<LabelledPoint> points;
  for (int i = 0; i < 6; ++i) points.push_back({{100 + 3 * i, 100 + 9 * i, 8, 8}, "name"});
  const Box plot = {0, 0, 300, 300};
  const std::vector<Box> labels = place_labels(points, 12, plot, font());
  ASSERT_EQ(labels.size(), points.size());
  const auto apart = [](const Box& a, const Box& b) {
    return a.right() <= b.x || b.right() <= a.x || a.bottom() <= b.y || b.bottom() <= a.y;
  };
  for (size_t i = 0; i < labels.size(); ++i)
    for (size_t j = 0; j < i; ++j) EXPECT_TRUE(apart(labels[i], labels[j])) << i << " " << j;
  const std::vector<Box> cornered = place_labels({{{292, 292, 8, 8}, "name"}}, 12, plot, font());
  EXPECT_LE(cornered[0].right(), 300);
  EXPECT_LE(cornered[0].bottom(), 300);
}

}  // namespace
}  // namespace synpo
