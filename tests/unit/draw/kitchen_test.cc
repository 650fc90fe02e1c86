#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "draw/colour.h"
#include "draw/kitchen/kitchen_colours.h"
#include "draw/kitchen/kitchen_moment.h"
#include "draw/kitchen/kitchen_picture.h"
#include "draw/paper.h"
#include "draw/terminal/terminal.h"
#include "helpers/faces.h"
#include "helpers/font.h"
#include "world/kitchen/builtin_kitchens.h"

namespace synpo {
namespace {

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
  EXPECT_EQ(colour_in(canvas, 3, 1), tiles[0]);
  EXPECT_EQ(colour_in(canvas, 3, 2), tiles[1]);
  EXPECT_EQ(colour_in(canvas, 0, 0), kPaperWall);
  EXPECT_EQ(colour_in(canvas, 5, 8), kPaperWall);
  EXPECT_EQ(colour_in(canvas, 1, 1), kPaperCounter);
  EXPECT_EQ(colour_in(canvas, 6, 4), kPaperTable);
  EXPECT_EQ(colour_in(canvas, 1, 2), receptacle_colour(kFridge));
  EXPECT_EQ(colour_in(canvas, 1, 5), receptacle_colour(kSink));
  EXPECT_EQ(colour_in(canvas, 9, 3), receptacle_colour(kMicrowave));
  for (const Rgb tile : tiles) EXPECT_GT(luminance(tile), 0.45) << "dark for print";
}

TEST(KitchenPicture, DoorsAreMarkedAtTheFrontAndAreSeenToBeOpen) {
  const Kitchen kitchen = small_kitchen();
  const Canvas closed = plan(kitchen, 0), open = plan(kitchen, 1 << kFridge);
  const auto front = [](const Canvas& canvas) {
    return canvas.at(3 * kCell, 3 * kCell - 4);
  };  // of the Fridge, which faces down
  EXPECT_LT(luminance(front(closed)), luminance(receptacle_colour(kFridge)) / 2);
  EXPECT_EQ(closed.at(3 * kCell, kCell + 4), receptacle_colour(kFridge)) << "its back has no mark";
  EXPECT_EQ(open.at(2 * kCell + 7, kCell + 7), paper_colour(kInsideColour));
  EXPECT_EQ(colour_in(open, 9, 3), receptacle_colour(kMicrowave));
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
  EXPECT_EQ(kitchen_face().plans_text({0}, {}, TerminalColour::kNone, 80), expected);
  const std::string coloured = kitchen_face().plans_text({0}, {}, TerminalColour::kTrue, 80);
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
  const KitchenFrame frame = small_world().frame(0, kitchen_start());
  const PlanGrid place = {0, 0, kCell, kitchen.columns};
  Canvas canvas(kitchen.columns * kCell, kitchen.rows * kCell, font());
  kitchen_face().draw_moment(canvas, place, play_film(small_world(), {0, 0}, kitchen_start(), {}, 0), 0);
  for (int i = 0; i < kKitchenObjects; ++i) {
    const int cell = frame.objects[size_t(i)];
    const Point centre = place.centre(plan_cell(kitchen, cell / kRayStride, cell % kRayStride));
    EXPECT_EQ(canvas.at(int(centre.x) - 7, int(centre.y)), object_colour(i)) << kKitchenObjectNames[i];
  }
  const Point agent = place.centre(plan_cell(kitchen, frame.eye.row, frame.eye.column));
  EXPECT_EQ(canvas.at(int(agent.x), int(agent.y)), kPaper);
}

TEST(KitchenMoment, SmallPictureIsTheExtractors) {
  const KitchenFrame frame = small_world().frame(0, kitchen_start());
  uint8_t rgb[kSmallView * kSmallView * 3];
  render_small(small_world().solids(0), frame, rgb);
  Canvas canvas(3 * kSmallView, 3 * kSmallView, font());
  draw_small_seen(canvas, {0, 0, 3 * kSmallView, 3 * kSmallView}, small_world().solids(0), &frame);
  for (int at = 0; at < kSmallView * kSmallView; ++at) {
    const Rgb expected = {rgb[3 * at], rgb[3 * at + 1], rgb[3 * at + 2]};
    ASSERT_EQ(canvas.at(at % kSmallView * 3 + 1, at / kSmallView * 3 + 1), expected) << at;
  }
  draw_small_seen(canvas, {0, 0, 3 * kSmallView, 3 * kSmallView}, small_world().solids(0), nullptr);
  EXPECT_EQ(canvas.at(40, 40), (Rgb{0, 0, 0}));
}

TEST(KitchenFilm, KnowsWhatWasOpenedTakenAndFilled) {
  const Film film = kitchen_film("Mug-Fridge", "Mug-Fridge");
  std::vector<std::string> deeds;
  for (int i = 0; i < film.steps(); ++i)
    if (kitchen_face().event(film, i).deed != Deed::kNone) deeds.push_back(kitchen_face().action_words(film, i));
  std::sort(deeds.begin(), deeds.end());
  EXPECT_EQ(deeds, (std::vector<std::string>{"open Fridge", "pick Mug", "put in Fridge"}));
  EXPECT_TRUE(kitchen_face().describe(film).starts_with(
      concat("success after ", film.steps(), " steps (the fewest), reward 10.")))
      << kitchen_face().describe(film);
  EXPECT_TRUE(kitchen_face().describe(film).ends_with(concat("Fridge filled at step ", film.steps())))
      << kitchen_face().describe(film);
}

TEST(KitchenFilm, SaysWhatCameOfAnEpisode) {
  EXPECT_EQ(kitchen_face().outcome(kitchen_film("Mug-Fridge", "Tomato-Fridge")), "wrong object");
  EXPECT_EQ(kitchen_face().outcome(kitchen_film("Mug-Fridge", "Mug-Sink")), "wrong receptacle");
  const Film turns = kitchen_film("Mug-Fridge", std::vector<uint8_t>(300, kRotateLeft));
  EXPECT_TRUE(kitchen_face().describe(turns).starts_with("timeout after 300 steps (success takes "))
      << kitchen_face().describe(turns);
  EXPECT_TRUE(kitchen_face().describe(turns).ends_with("reward \u22123.00; nothing picked up"))
      << kitchen_face().describe(turns);
  const Film up = kitchen_film("Mug-Fridge", {kLookUp, kLookUp, kLookUp});
  EXPECT_TRUE(kitchen_face().describe(up).starts_with("unfinished after 3 steps (")) << kitchen_face().describe(up);
  EXPECT_TRUE(kitchen_face().describe(up).ends_with("reward \u22120.05; nothing picked up; 2 steps without effect"))
      << kitchen_face().describe(up);
  EXPECT_EQ(kitchen_face().action_words(up, 1), "LookUp");
}

TEST(KitchenFilm, KeyMomentsKeepFirstDeedsAndLast) {
  std::vector<uint8_t> actions(100, kRotateLeft);
  const Film direct = kitchen_film("Mug-Fridge", "Mug-Fridge");
  actions.insert(actions.end(), direct.actions.begin(), direct.actions.end());
  const Film film = kitchen_film("Mug-Fridge", actions);
  EXPECT_EQ(kitchen_face().outcome(film), "success");
  for (int count = 4; count <= film.steps() + 1; ++count) {
    const std::vector<int> moments = kitchen_face().key_moments(film, count);
    const std::set<int> distinct(moments.begin(), moments.end());
    EXPECT_EQ(distinct.size(), size_t(std::min(count, film.steps())));
    EXPECT_TRUE(std::is_sorted(moments.begin(), moments.end()));
    for (int i = 0; i < film.steps(); ++i) {
      const bool key = i == 0 || i == film.steps() - 1 || kitchen_face().event(film, i).deed != Deed::kNone;
      EXPECT_TRUE(!key || distinct.contains(i)) << i;
    }
  }
}

}  // namespace
}  // namespace synpo
