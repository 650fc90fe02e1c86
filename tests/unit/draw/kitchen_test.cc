#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "draw/colour.h"
#include "draw/episode/agent_view.h"
#include "draw/episode/episode_picture.h"
#include "draw/face/path.h"
#include "draw/kitchen/kitchen_colours.h"
#include "draw/kitchen/kitchen_face.h"
#include "draw/kitchen/kitchen_moment.h"
#include "draw/kitchen/kitchen_picture.h"
#include "draw/paper.h"
#include "draw/terminal/terminal.h"
#include "helpers/kitchen_rooms.h"
#include "world/kitchen/plan.h"

namespace synpo {
namespace {

const Font& font() {
  static const Font shared;
  return shared;
}

const KitchenFace& face() {
  static const KitchenFace shared(std::make_shared<const KitchenSet>(std::vector{small_kitchen()}));
  return shared;
}

const KitchenSet& small_world() { return dynamic_cast<const KitchenSet&>(face().world()); }

EnvTask pair_of(const char* task) { return {0, small_world().task_index(task)}; }

// Where the objects lie is the same for every task.
WorldState start() {
  Random random(7, Purpose::kEpisodeStart);
  return small_world().reset(0, random);
}

// The expert of one task plays while the episode's task is another.
Film play(const char* task, const char* played) {
  WorldState state = start();
  std::vector<uint8_t> actions;
  do actions.push_back(uint8_t(small_world().expert(pair_of(played), state)));
  while (!small_world().step(pair_of(task), state, actions.back()).ended());
  return play_film(small_world(), pair_of(task), start(), actions, 0);
}

Film play(const char* task, const std::vector<uint8_t>& actions) {
  return play_film(small_world(), pair_of(task), start(), actions, 0);
}

constexpr int kCell = 20;

Canvas plan(const Kitchen& kitchen, int doors, Lettering lettering = Lettering::kLetters) {
  Canvas canvas(kitchen.columns * kCell, kitchen.rows * kCell, font());
  draw_kitchen(canvas, {0, 0, kCell, kitchen.columns}, kitchen, doors, lettering);
  return canvas;
}

// In the upper left of a cell, where no letters are.
Rgb colour_in(const Canvas& canvas, int row, int column) { return canvas.at(column * kCell + 3, row * kCell + 3); }

TEST(KitchenPicture, EveryCellHasTheColourOfWhatStandsThere) {
  const Kitchen kitchen = small_kitchen();
  const Canvas canvas = plan(kitchen, 0);
  const auto tiles = paper_floor(kitchen.hash);
  EXPECT_TRUE(colour_in(canvas, 3, 1) == tiles[0]);
  EXPECT_TRUE(colour_in(canvas, 3, 2) == tiles[1]);
  EXPECT_TRUE(colour_in(canvas, 0, 0) == kPaperWall);
  EXPECT_TRUE(colour_in(canvas, 5, 8) == kPaperWall);
  EXPECT_TRUE(colour_in(canvas, 1, 1) == kPaperCounter);
  EXPECT_TRUE(colour_in(canvas, 6, 4) == kPaperTable);
  EXPECT_TRUE(colour_in(canvas, 1, 2) == receptacle_colour(kFridge));
  EXPECT_TRUE(colour_in(canvas, 1, 5) == receptacle_colour(kSink));
  EXPECT_TRUE(colour_in(canvas, 9, 3) == receptacle_colour(kMicrowave));
  for (const Rgb tile : tiles) EXPECT_GT(luminance(tile), 0.45) << "dark for print";
}

TEST(KitchenPicture, DoorsAreMarkedAtTheFrontAndAreSeenToBeOpen) {
  const Kitchen kitchen = small_kitchen();
  const Canvas closed = plan(kitchen, 0), open = plan(kitchen, 1 << kFridge);
  const auto front = [](const Canvas& canvas) {
    return canvas.at(3 * kCell, 3 * kCell - 4);
  };  // of the Fridge, which faces down
  EXPECT_LT(luminance(front(closed)), luminance(receptacle_colour(kFridge)) / 2);
  EXPECT_TRUE(closed.at(3 * kCell, kCell + 4) == receptacle_colour(kFridge)) << "its back has no mark";
  EXPECT_TRUE(open.at(2 * kCell + 7, kCell + 7) == paper_colour(kInsideColour));
  EXPECT_TRUE(colour_in(open, 9, 3) == receptacle_colour(kMicrowave));
  EXPECT_NE(open.png(), plan(kitchen, 1 << kMicrowave).png());
  EXPECT_NE(plan(kitchen, 0).png(), plan(kitchen, 0, Lettering::kNames).png());
}

TEST(KitchenPicture, AllKitchensAtOneScale) {
  for (const double scale : {0.25, 1.0, 2.0}) {
    MapStyle style;
    style.scale = scale;
    style.title = scale == 1 ? "The kitchens" : "";
    const Canvas canvas = draw_kitchens(builtin_kitchens(), style, font());
    EXPECT_EQ(canvas.clipped(), 0) << scale;
    EXPECT_EQ(canvas.png(), draw_kitchens(builtin_kitchens(), style, font()).png());
    EXPECT_EQ(draw_kitchens({builtin_kitchens()[15]}, style, font()).clipped(), 0) << "the smallest alone";
  }
  MapStyle row, column;
  row.columns = 19;
  column.columns = 1;
  EXPECT_GT(draw_kitchens(builtin_kitchens(), row, font()).width(), 3500);
  EXPECT_GT(draw_kitchens(builtin_kitchens(), column, font()).height(), 3500);
  EXPECT_THROW(draw_kitchens({}, row, font()), Error);
}

TEST(KitchenPicture, AsTextTheyAreTheirPlans) {
  const Kitchen kitchen = small_kitchen();
  std::string expected = "small\n";
  for (const char c : kitchen.text) expected += c == '\n' ? "\n" : std::string(2, c == '.' ? ' ' : c);
  EXPECT_EQ(face().plans_text({0}, {}, TerminalColour::kNone, 80), expected);
  const std::string coloured = face().plans_text({0}, {}, TerminalColour::kTrue, 80);
  EXPECT_NE(coloured.find(ground_code(receptacle_colour(kFridge), TerminalColour::kTrue) + "FFFF" + kPlainCode),
            std::string::npos);
  EXPECT_EQ(coloured.find('#'), std::string::npos);
  const std::string both = KitchenFace(std::make_shared<const KitchenSet>(std::vector{builtin_kitchens()[15], kitchen}))
                               .plans_text({0, 1}, {}, TerminalColour::kNone, 80);
  EXPECT_TRUE(both.starts_with("FloorPlan25" + std::string(9, ' ') + "small\n" + std::string(18, '#') + "  " +
                               std::string(20, '#') + "\n"))
      << both;
  EXPECT_EQ(both.find(" \n"), std::string::npos);
}

TEST(KitchenMoment, SightIsShadedAheadAndEndsAtWallsAndAtTheFridge) {
  const Kitchen kitchen = small_kitchen();
  const Canvas before = plan(kitchen, 0);
  const auto shaded = [&](int16_t row, int16_t column, int16_t heading, int at_row, int at_column) {
    Canvas canvas = plan(kitchen, 0);
    draw_sight(canvas, {0, 0, kCell, kitchen.columns}, kitchen, {row, column, heading, 0});
    const int x = at_column * kCell + kCell / 2 - 2, y = at_row * kCell + kCell / 2 - 2;
    return !(canvas.at(x, y) == before.at(x, y));
  };
  EXPECT_TRUE(shaded(4, 2, 90, 4, 5));
  EXPECT_TRUE(shaded(4, 2, 90, 5, 6));
  EXPECT_FALSE(shaded(4, 2, 90, 7, 4)) << "60 degrees";
  EXPECT_FALSE(shaded(4, 4, 90, 4, 2)) << "behind";
  EXPECT_TRUE(shaded(4, 1, 90, 4, 7)) << "six cells";
  EXPECT_FALSE(shaded(4, 1, 90, 4, 8)) << "seven cells";
  EXPECT_TRUE(shaded(4, 7, 90, 4, 8));
  EXPECT_FALSE(shaded(4, 7, 90, 4, 9)) << "a wall";
  EXPECT_TRUE(shaded(3, 2, 0, 1, 2)) << "the Fridge itself";
  EXPECT_FALSE(shaded(3, 2, 0, 0, 2));
}

TEST(KitchenMoment, ObjectsAndAgentLieWhereTheyAre) {
  const Kitchen kitchen = small_kitchen();
  const KitchenFrame frame = small_world().frame(0, start());
  const PlanGrid place = {0, 0, kCell, kitchen.columns};
  Canvas canvas(kitchen.columns * kCell, kitchen.rows * kCell, font());
  face().draw_moment(canvas, place, play_film(small_world(), {0, 0}, start(), {}, 0), 0);
  for (int i = 0; i < kKitchenObjects; ++i) {
    const int cell = frame.objects[size_t(i)];
    const Point centre = place.centre(plan_cell(kitchen, cell / kSceneStride, cell % kSceneStride));
    EXPECT_TRUE(canvas.at(int(centre.x) - 7, int(centre.y)) == object_colour(i)) << kKitchenObjectNames[i];
  }
  const Point agent = place.centre(plan_cell(kitchen, frame.eye.row, frame.eye.column));
  EXPECT_TRUE(canvas.at(int(agent.x), int(agent.y)) == kPaper);
}

TEST(KitchenMoment, SmallPictureIsTheExtractors) {
  const KitchenFrame frame = small_world().frame(0, start());
  uint8_t rgb[kSmallView * kSmallView * 3];
  render_small(small_world().scene(0), frame, rgb);
  Canvas canvas(3 * kSmallView, 3 * kSmallView, font());
  draw_small_seen(canvas, {0, 0, 3 * kSmallView, 3 * kSmallView}, small_world().scene(0), &frame);
  for (int at = 0; at < kSmallView * kSmallView; ++at) {
    const Rgb expected = {rgb[3 * at], rgb[3 * at + 1], rgb[3 * at + 2]};
    ASSERT_TRUE(canvas.at(at % kSmallView * 3 + 1, at / kSmallView * 3 + 1) == expected) << at;
  }
  draw_small_seen(canvas, {0, 0, 3 * kSmallView, 3 * kSmallView}, small_world().scene(0), nullptr);
  EXPECT_TRUE((canvas.at(40, 40) == Rgb{0, 0, 0}));
}

TEST(KitchenView, NothingIsClippedAndBytesAreTheSame) {
  for (const double scale : {0.25, 1.0})
    for (const bool history : {false, true})
      for (const int64_t steps : {0, 2}) {
        const Film film =
            expert_film(small_world(), pair_of("Mug-Fridge"), Random(1, Purpose::kEpisodeStart), steps, 0);
        const Canvas canvas = draw_agent_view(face(), film, {history, "", scale}, font());
        EXPECT_EQ(canvas.clipped(), 0) << scale << history << steps;
        EXPECT_EQ(canvas.png(), draw_agent_view(face(), film, {history, "", scale}, font()).png());
      }
}

TEST(KitchenView, TheExpertsEpisodeEnds) {
  const EnvTask pair = pair_of("Mug-Fridge");
  const auto film = [&](int64_t steps) {
    return expert_film(small_world(), pair, Random(1, Purpose::kEpisodeStart), steps, 0);
  };
  int64_t steps = 0;
  while (!film(steps).terminated()) ++steps;
  EXPECT_EQ(draw_agent_view(face(), film(steps), {}, font()).clipped(), 0);
  EXPECT_THROW(film(steps + 1), Error);
  const WorldState from = film(0).states[0];
  EXPECT_EQ(expert_steps(small_world(), pair, from), steps);
  EXPECT_EQ(small_world().planner(0).steps_to_success(kitchen_task(pair.task), unpack(from)), steps);
}

TEST(KitchenFilm, KnowsWhatWasOpenedTakenAndFilled) {
  const Film film = play("Mug-Fridge", "Mug-Fridge");
  std::vector<std::string> deeds;
  for (int i = 0; i < film.steps(); ++i)
    if (face().event(film, i).deed != Deed::kNone) deeds.push_back(face().action_words(film, i));
  std::sort(deeds.begin(), deeds.end());
  EXPECT_EQ(deeds, (std::vector<std::string>{"open Fridge", "pick Mug", "put in Fridge"}));
  EXPECT_TRUE(
      face().describe(film).starts_with(concat("success after ", film.steps(), " steps (the fewest), reward 10.")))
      << face().describe(film);
  EXPECT_TRUE(face().describe(film).ends_with(concat("Fridge filled at step ", film.steps()))) << face().describe(film);
}

TEST(KitchenFilm, SaysWhatCameOfAnEpisode) {
  EXPECT_EQ(face().outcome(play("Mug-Fridge", "Tomato-Fridge")), "wrong object");
  EXPECT_EQ(face().outcome(play("Mug-Fridge", "Mug-Sink")), "wrong receptacle");
  const Film turns = play("Mug-Fridge", std::vector<uint8_t>(300, kRotateLeft));
  EXPECT_TRUE(face().describe(turns).starts_with("timeout after 300 steps (success takes ")) << face().describe(turns);
  EXPECT_TRUE(face().describe(turns).ends_with("reward \u22123.00; nothing picked up")) << face().describe(turns);
  const Film up = play("Mug-Fridge", {kLookUp, kLookUp, kLookUp});
  EXPECT_TRUE(face().describe(up).starts_with("unfinished after 3 steps (")) << face().describe(up);
  EXPECT_TRUE(face().describe(up).ends_with("reward \u22120.05; nothing picked up; 2 steps without effect"))
      << face().describe(up);
  EXPECT_EQ(face().action_words(up, 1), "LookUp");
}

TEST(KitchenFilm, KeyMomentsKeepFirstDeedsAndLast) {
  std::vector<uint8_t> actions(100, kRotateLeft);
  const Film direct = play("Mug-Fridge", "Mug-Fridge");
  actions.insert(actions.end(), direct.actions.begin(), direct.actions.end());
  const Film film = play("Mug-Fridge", actions);
  EXPECT_EQ(face().outcome(film), "success");
  for (int count = 4; count <= film.steps() + 1; ++count) {
    const std::vector<int> moments = face().key_moments(film, count);
    const std::set<int> distinct(moments.begin(), moments.end());
    EXPECT_EQ(distinct.size(), size_t(std::min(count, film.steps())));
    EXPECT_TRUE(std::is_sorted(moments.begin(), moments.end()));
    for (int i = 0; i < film.steps(); ++i) {
      const bool key = i == 0 || i == film.steps() - 1 || face().event(film, i).deed != Deed::kNone;
      EXPECT_TRUE(!key || distinct.contains(i)) << i;
    }
  }
}

TEST(KitchenPath, RunsOverAPlanOfAnyWidth) {
  const PlanGrid place = {0, 0, 100, 30};
  const std::vector<PathCorner> corners = path_corners(place, {31, 61, 62});
  EXPECT_EQ(corners.front().at.x, 150);
  EXPECT_EQ(corners.front().at.y, 150);
  EXPECT_EQ(corners.back().at.x, 250);
  EXPECT_EQ(corners.back().at.y, 250);
}

TEST(KitchenEpisode, NothingIsClippedAndBytesAreTheSame) {
  std::vector<uint8_t> to_and_fro;
  for (int i = 0; i < 60; ++i) to_and_fro.insert(to_and_fro.end(), {kMoveAhead, kRotateLeft, kRotateLeft});
  for (const Film& film :
       {play("Mug-Fridge", "Mug-Fridge"), play("Mug-Fridge", "Tomato-Fridge"), play("Mug-Fridge", "Mug-Microwave"),
        play("Mug-Sink", std::vector<uint8_t>(300, kRotateLeft)), play("Mug-Sink", to_and_fro),
        play("Mug-Sink", {kLookUp})})
    for (const double scale : {0.25, 1.0}) {
      EpisodeStyle style;
      style.scale = scale;
      style.title =
          scale == 1
              ? "A title that is much too long for the picture, so that it has to be broken into several lines of text"
              : "";
      const Canvas canvas = draw_episode(face(), film, style, font());
      EXPECT_EQ(canvas.clipped(), 0) << scale << face().describe(film);
      EXPECT_EQ(canvas.png(), draw_episode(face(), film, style, font()).png());
    }
}

TEST(KitchenEpisode, TheStripMakesItHigher) {
  EpisodeStyle none, some, more;
  none.strip = 0;
  some.strip = 3;
  more.strip = 13;
  const Film film = play("Mug-Sink", std::vector<uint8_t>(20, kRotateLeft));
  const int without = draw_episode(face(), film, none, font()).height(),
            one_row = draw_episode(face(), film, some, font()).height();
  EXPECT_GT(one_row, without + 100);
  EXPECT_GT(draw_episode(face(), film, more, font()).height(), one_row + 200);
}

TEST(KitchenEpisode, FramesAreOfOneSizeWithEvenSides) {
  const Film film = play("Mug-Microwave", "Mug-Microwave");
  for (const double scale : {0.7, 1.0}) {
    EpisodeStyle style;
    style.scale = scale;
    const Canvas first = draw_episode_frame(face(), film, 0, style, font());
    EXPECT_EQ(first.width() % 2 + first.height() % 2, 0);
    std::set<std::string> different;
    for (int moment = 0; moment <= film.steps(); ++moment) {
      const Canvas frame = draw_episode_frame(face(), film, moment, style, font());
      EXPECT_EQ(frame.width(), first.width());
      EXPECT_EQ(frame.height(), first.height());
      EXPECT_EQ(frame.clipped(), 0);
      different.insert(frame.png());
    }
    EXPECT_EQ(different.size(), size_t(film.steps()) + 1);
  }
}

}  // namespace
}  // namespace synpo
