#include "draw/grid/policy_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "draw/grid/grid_face.h"
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

const GridFace& face() {
  static const GridFace shared(std::make_shared<const GridSet>(std::vector{open_maze()}));
  return shared;
}

EnvTask red_blue() { return {0, face().world().task_index("R-B")}; }

GridState treasures() {
  GridState state;
  state.now.agent = cell(7, 7);
  state.now.treasures = {cell(1, 3), cell(3, 1), cell(14, 2), cell(14, 3), cell(14, 4)};
  return state;
}

// UP everywhere, with this probability.
PolicyStage always_up(size_t number, double probability) {
  PolicyStage stage = face().policy_stages(red_blue(), to_world_state(treasures()))[number];
  const double rest = (1 - probability) / 4;
  stage.choices =
      compare_to_expert(face().world(), red_blue(), stage.states,
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
  const auto stages = face().policy_stages(red_blue(), to_world_state(treasures()));
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
        return face().draw_policy(red_blue(), std::vector(size_t(stages), always_up(0, 0.6)),
                                  {"title", "caption", scale}, font());
      };
      EXPECT_EQ(draw().clipped(), 0) << scale;
      EXPECT_EQ(draw().png(), draw().png());
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
