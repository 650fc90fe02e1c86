// The pictures of episodes and moments, which mazes and kitchens share.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/episode/agent_view.h"
#include "draw/episode/episode_picture.h"
#include "helpers/faces.h"
#include "helpers/font.h"

namespace synpo {
namespace {

void expect_whole_episodes(const WorldFace& face, const std::vector<Film>& films, const std::vector<double>& scales) {
  for (const Film& film : films)
    for (const double scale : scales) {
      EpisodeStyle style;
      style.scale = scale;
      style.title =
          scale == 1
              ? "A title that is much too long for the picture, so that it has to be broken into several lines of text"
              : "";
      const Canvas canvas = draw_episode(face, film, style, font());
      EXPECT_EQ(canvas.clipped(), 0) << scale << face.describe(film);
      EXPECT_EQ(canvas.png(), draw_episode(face, film, style, font()).png());
    }
}

TEST(EpisodePicture, NothingIsClippedAndBytesAreTheSame) {
  GridState on_treasure = grid_start();
  on_treasure.now.agent = cell(1, 3);
  expect_whole_episodes(
      grid_face(),
      {grid_film(kGridSuccess), grid_film({kPick}, on_treasure), grid_film({kRight, kRight, kRight, kPick}),
       grid_film(std::vector<uint8_t>(300, kUp)), grid_film({kRight})},
      {0.25, 1, 2});
  std::vector<uint8_t> to_and_fro;
  for (int i = 0; i < 60; ++i) to_and_fro.insert(to_and_fro.end(), {kMoveAhead, kRotateLeft, kRotateLeft});
  expect_whole_episodes(
      kitchen_face(),
      {kitchen_film("Mug-Fridge", "Mug-Fridge"), kitchen_film("Mug-Fridge", "Tomato-Fridge"),
       kitchen_film("Mug-Fridge", "Mug-Microwave"), kitchen_film("Mug-Sink", std::vector<uint8_t>(300, kRotateLeft)),
       kitchen_film("Mug-Sink", to_and_fro), kitchen_film("Mug-Sink", {kLookUp})},
      {0.25, 1});
}

void expect_higher_with_strips(const WorldFace& face, const Film& film) {
  EpisodeStyle none, some, more;
  none.strip = 0;
  some.strip = 3;
  more.strip = 13;
  const int without = draw_episode(face, film, none, font()).height(),
            one_row = draw_episode(face, film, some, font()).height();
  EXPECT_GT(one_row, without + 100);
  EXPECT_GT(draw_episode(face, film, more, font()).height(), one_row + 200);
}

TEST(EpisodePicture, TheStripMakesItHigher) {
  expect_higher_with_strips(grid_face(), grid_film(std::vector<uint8_t>(20, kUp)));
  expect_higher_with_strips(kitchen_face(), kitchen_film("Mug-Sink", std::vector<uint8_t>(20, kRotateLeft)));
}

void expect_equal_frames(const WorldFace& face, const Film& film, const std::vector<double>& scales) {
  for (const double scale : scales) {
    EpisodeStyle style;
    style.scale = scale;
    const Canvas first = draw_episode_frame(face, film, 0, style, font());
    EXPECT_EQ(first.width() % 2 + first.height() % 2, 0);
    std::set<std::string> different;
    for (int moment = 0; moment <= film.steps(); ++moment) {
      const Canvas frame = draw_episode_frame(face, film, moment, style, font());
      EXPECT_EQ(frame.width(), first.width());
      EXPECT_EQ(frame.height(), first.height());
      EXPECT_EQ(frame.clipped(), 0);
      different.insert(frame.png());
    }
    EXPECT_EQ(different.size(), size_t(film.steps()) + 1);
  }
}

TEST(EpisodePicture, FramesAreOfOneSizeWithEvenSides) {
  expect_equal_frames(grid_face(), grid_film(kGridSuccess), {0.7, 1, 1.3});
  expect_equal_frames(kitchen_face(), kitchen_film("Mug-Microwave", "Mug-Microwave"), {0.7, 1});
}

TEST(AgentView, NothingIsClippedAndBytesAreTheSame) {
  const struct {
    const WorldFace& face;
    EnvTask pair;
  } drawn[] = {{grid_face(), red_blue()}, {kitchen_face(), kitchen_pair("Mug-Fridge")}};
  for (const auto& [face, pair] : drawn)
    for (const double scale : {0.25, 1.0})
      for (const bool history : {false, true})
        for (const int64_t steps : {0, 2}) {
          const Film film = expert_film(face.world(), pair, Random(1, Purpose::kEpisodeStart), steps, 1);
          const Canvas canvas = draw_agent_view(face, film, {history, "", scale}, font());
          EXPECT_EQ(canvas.clipped(), 0) << scale << history << steps;
          EXPECT_EQ(canvas.png(), draw_agent_view(face, film, {history, "", scale}, font()).png());
        }
}

TEST(AgentView, TheExpertsEpisodeEnds) {
  const EnvTask pair = kitchen_pair("Mug-Fridge");
  const auto film = [&](int64_t steps) {
    return expert_film(small_world(), pair, Random(1, Purpose::kEpisodeStart), steps, 0);
  };
  int64_t steps = 0;
  while (!film(steps).terminated()) ++steps;
  EXPECT_EQ(draw_agent_view(kitchen_face(), film(steps), {}, font()).clipped(), 0);
  EXPECT_THROW(film(steps + 1), Error);
  const WorldState from = film(0).states[0];
  EXPECT_EQ(expert_steps(small_world(), pair, from), steps);
  EXPECT_EQ(small_world().planner(0).steps_to_success(kitchen_task(pair.task), unpack(from)), steps);
}

}  // namespace
}  // namespace synpo
