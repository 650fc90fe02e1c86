#include "draw/episode/episode_picture.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "draw/canvas/video.h"
#include "draw/colour.h"
#include "draw/face/path.h"
#include "draw/grid/grid_face.h"
#include "draw/grid/maze_picture.h"
#include "draw/paper.h"
#include "helpers/mazes.h"
#include "helpers/temporary.h"

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

// Agent at (1, 1), R at (1, 3), B at (1, 4), the others in the last row of floor.
GridState start() {
  GridState state;
  state.now.agent = cell(1, 1);
  state.now.treasures = {cell(1, 3), cell(1, 4), cell(14, 2), cell(14, 3), cell(14, 4)};
  return state;
}

Film film(const std::vector<uint8_t>& actions, const GridState& from = start()) {
  return play_film(face().world(), {0, face().world().task_index("R-B")}, to_world_state(from), actions, 1);
}

const std::vector<uint8_t> kSuccess = {kRight, kRight, kPick, kRight, kPick};

TEST(Film, SaysWhatCameOfAnEpisode) {
  EXPECT_EQ(face().describe(film(kSuccess)),
            "success after 5 steps (the fewest), reward 11.95; R at step 3, B at step 5");
  EXPECT_EQ(face().describe(film({kUp, kPick, kRight, kRight, kPick, kRight, kPick})),
            "success after 7 steps (5 would do), reward 11.92; R at step 5, B at step 7; 1 step into walls; 1 pick "
            "where nothing lies");
  EXPECT_EQ(face().describe(film({kRight, kRight, kRight, kPick})),
            "wrong pick after 4 steps (success takes 5), reward \u221210.04; B at step 4");
  EXPECT_EQ(face().describe(film(std::vector<uint8_t>(300, kUp))),
            "timeout after 300 steps (success takes 5), reward \u22126.00; no treasure picked; 300 steps into walls");
  EXPECT_EQ(face().outcome(film({kRight})), "unfinished");
}

TEST(Film, KeyMomentsKeepFirstPicksAndLast) {
  std::vector<uint8_t> actions(100, kUp);
  for (const uint8_t action : kSuccess) actions.push_back(action);
  const Film long_one = film(actions);
  EXPECT_EQ(face().key_moments(long_one, 0), (std::vector<int>{}));
  EXPECT_EQ(face().key_moments(long_one, 1), (std::vector<int>{0}));
  EXPECT_EQ(face().key_moments(long_one, 2), (std::vector<int>{0, 104}));
  EXPECT_EQ(face().key_moments(long_one, 3), (std::vector<int>{0, 102, 104}));
  EXPECT_EQ(face().key_moments(long_one, 5), (std::vector<int>{0, 34, 68, 102, 104}));
  EXPECT_EQ(face().key_moments(film(kSuccess), 12), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(face().key_moments(film({kRight}), 12), (std::vector<int>{0}));
  for (int count = 3; count <= 106; ++count) {
    const std::vector<int> moments = face().key_moments(long_one, count);
    const std::set<int> distinct(moments.begin(), moments.end());
    EXPECT_EQ(distinct.size(), size_t(std::min(count, 105))) << count;
    EXPECT_TRUE(distinct.contains(0) && distinct.contains(102) && distinct.contains(104)) << count;
  }
}

TEST(Path, TimeDarkens) {
  for (int i = 0; i < 50; ++i) EXPECT_GT(luminance(time_colour(i / 50.0)), luminance(time_colour((i + 1) / 50.0))) << i;
}

TEST(Path, TheSameWayAgainRunsBesideTheFirst) {
  const PlanGrid place = {0, 0, 100, kGridSide};
  const uint8_t a = cell(1, 1), b = cell(1, 2);
  const std::vector<PathCorner> corners = path_corners(place, {a, b, a, b});
  std::set<double> rows;
  for (size_t i = 1; i < corners.size(); ++i)
    if (corners[i].step != corners[i - 1].step) rows.insert(corners[i].at.y);
  EXPECT_EQ(rows.size(), 3u);
  for (const double y : rows) EXPECT_LT(std::abs(y - 150), 50) << "inside its cells";
  EXPECT_EQ(path_corners(place, {a, a, a}).size(), 1u);
}

TEST(EpisodePicture, NothingIsClippedAndBytesAreTheSame) {
  const std::vector<uint8_t> into_the_wall(300, kUp);
  GridState on_treasure = start();
  on_treasure.now.agent = cell(1, 3);
  for (const Film& each : {film(kSuccess), film({kPick}, on_treasure), film({kRight, kRight, kRight, kPick}),
                           film(into_the_wall), film({kRight})})
    for (const double scale : {0.25, 1.0, 2.0}) {
      EpisodeStyle style;
      style.scale = scale;
      style.title =
          scale == 1
              ? "A title that is much too long for the picture, so that it has to be broken into several lines of text"
              : "";
      const Canvas canvas = draw_episode(face(), each, style, font());
      EXPECT_EQ(canvas.clipped(), 0) << scale;
      EXPECT_EQ(canvas.png(), draw_episode(face(), each, style, font()).png());
    }
}

TEST(EpisodePicture, TheStripMakesItHigher) {
  EpisodeStyle none, some, more;
  none.strip = 0;
  some.strip = 3;
  more.strip = 13;
  const Film waits = film(std::vector<uint8_t>(20, kUp));
  const int without = draw_episode(face(), waits, none, font()).height(),
            one_row = draw_episode(face(), waits, some, font()).height();
  EXPECT_GT(one_row, without + 100);
  EXPECT_GT(draw_episode(face(), waits, more, font()).height(), one_row + 200);
}

TEST(EpisodePicture, FramesAreOfOneSizeWithEvenSides) {
  const Film success = film(kSuccess);
  for (const double scale : {0.7, 1.0, 1.3}) {
    EpisodeStyle style;
    style.scale = scale;
    const Canvas first = draw_episode_frame(face(), success, 0, style, font());
    EXPECT_EQ(first.width() % 2 + first.height() % 2, 0);
    for (int moment = 0; moment <= success.steps(); ++moment) {
      const Canvas frame = draw_episode_frame(face(), success, moment, style, font());
      EXPECT_EQ(frame.width(), first.width());
      EXPECT_EQ(frame.height(), first.height());
      EXPECT_EQ(frame.clipped(), 0);
    }
  }
}

TEST(Video, IsWholeOrNotThere) {
  const TemporaryFolder folder;
  const Film success = film(kSuccess);
  const Canvas frame = draw_episode_frame(face(), success, 0, {}, font());
  {
    Video video(folder.file("a.avi"), 5, frame.width(), frame.height());
    video.add(frame);
    EXPECT_EQ(folder.files(), 1u);
  }
  EXPECT_EQ(folder.files(), 0u);
  for (const char* name : {"a.avi", "b.avi"}) {
    Video video(folder.file(name), 5, frame.width(), frame.height());
    for (int i = 0; i < 3; ++i) video.add(frame);
    video.finish();
  }
  EXPECT_EQ(folder.files(), 2u);
  EXPECT_EQ(contents(folder.file("a.avi")), contents(folder.file("b.avi")));
  EXPECT_THROW(Video(folder.file("c.png"), 5, 16, 16), Error);
  EXPECT_THROW(Video(folder.file("none/c.avi"), 5, 16, 16), Error);
  EXPECT_EQ(folder.files(), 2u);
}

TEST(TerminalPath, WithoutColour) {
  const std::string text = face().film_text(film(kSuccess), TerminalColour::kNone);
  const std::string wall(16 * 4, '#');
  EXPECT_TRUE(text.starts_with("open, task R-B\n" + wall + "\n####   0   1R  2B  4" + std::string(40, ' ') + "####\n"))
      << text;
  EXPECT_TRUE(text.ends_with(wall + "\n" + face().describe(film(kSuccess)) + "\n")) << text;
  EXPECT_EQ(text.find('\033'), std::string::npos);
}

TEST(TerminalPath, BlocksOfColour) {
  const std::string text = face().film_text(film(kSuccess), TerminalColour::kTrue);
  EXPECT_NE(text.find(ground_code(time_colour(0.2), TerminalColour::kTrue) + "  1" + kPlainCode), std::string::npos);
  EXPECT_NE(text.find(ground_code(kPaperTreasures[1], TerminalColour::kTrue) + "B 4" + kPlainCode), std::string::npos);
}

}  // namespace
}  // namespace synpo
