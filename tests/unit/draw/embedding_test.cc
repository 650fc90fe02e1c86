#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "draw/grid/maze_picture.h"
#include "draw/plot/embedding_picture.h"
#include "draw/plot/labels.h"
#include "helpers/font.h"

namespace synpo {
namespace {

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
  EXPECT_EQ(canvas.at(5, 10), kPaperTreasures[2]);
  EXPECT_EQ(canvas.at(15, 10), kPaperTreasures[4]);
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
