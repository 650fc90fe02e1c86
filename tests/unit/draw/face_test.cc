// Worlds that the pictures know nothing of: one without a face, and the same with a small one.
#include "draw/face/world_face.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "draw/episode/agent_view.h"
#include "draw/episode/episode_picture.h"
#include "draw/face/path.h"
#include "draw/grid/grid_face.h"
#include "draw/kitchen/kitchen_face.h"
#include "draw/worlds/faces.h"
#include "helpers/corridor.h"
#include "helpers/font.h"
#include "helpers/mazes.h"

namespace synpo {
namespace {

constexpr Rgb kCarpet = {40, 160, 200};

class CorridorFace : public WorldFace {
 public:
  using WorldFace::WorldFace;
  PlanSize plan_size(int) const override { return {1, Corridor::kCells}; }
  int agent_cell(int, const WorldState& state) const override { return state.bytes[0]; }
  void draw_ground(Canvas& canvas, const PlanGrid& place, const Film&, int, Shown) const override {
    for (int cell = 0; cell < Corridor::kCells; ++cell) canvas.fill(place.box(cell), kCarpet);
  }
};

const WorldFace& plain() {
  static const std::unique_ptr<const WorldFace> face = face_of(std::make_shared<const Corridor>());
  return *face;
}

const WorldFace& own() {
  static const CorridorFace face(std::make_shared<const Corridor>());
  return face;
}

Film film(const WorldFace& face, const std::vector<uint8_t>& actions) {
  return play_film(face.world(), {0, 1}, face.world().start_state(0, {{"agent", {0, 2}}}), actions, 0);
}

const std::vector<uint8_t> kThere = {1, 0, 1, 1, 1};

int64_t pixels_of(const Canvas& canvas, Rgb colour) {
  int64_t count = 0;
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) count += canvas.at(x, y) == colour;
  return count;
}

TEST(WorldFace, SaysInWordsWhatItCannotDraw) {
  EXPECT_EQ(plain().film_text(film(plain(), kThere), TerminalColour::kTrue),
            "short, task right\n"
            "1: RIGHT\n"
            "2: LEFT\n"
            "3: RIGHT\n"
            "4: RIGHT\n"
            "5: RIGHT\n"
            "success after 5 steps (3 would do), reward 0.95\n");
  EXPECT_EQ(plain().describe(film(plain(), {0, 0})), "wrong after 2 steps (success takes 3), reward \u22120.02");
  EXPECT_EQ(plain().outcome(film(plain(), {0})), "unfinished");
  EXPECT_EQ(plain().view_title(film(plain(), {1})), "short, task right, step 1; the expert's next action: RIGHT");
  EXPECT_EQ(plain().view_title(film(plain(), kThere)), "short, task right, step 5: success");
  EXPECT_EQ(plain().plans_text({0}, {}, TerminalColour::kNone, 80), "short\n");
  EXPECT_EQ(plain().key_moments(film(plain(), kThere), 3), (std::vector<int>{0, 2, 4}));
}

TEST(WorldFace, EveryPictureComesOutWhole) {
  for (const WorldFace* face : {&plain(), &own()})
    for (const double scale : {0.25, 1.0, 2.0}) {
      MapStyle plans;
      plans.scale = scale;
      EXPECT_EQ(face->draw_plans({0}, plans, font()).clipped(), 0);
      EXPECT_THROW(face->draw_plans({}, plans, font()), Error);
      EpisodeStyle style;
      style.scale = scale;
      for (const auto& actions : {kThere, std::vector<uint8_t>{0}, std::vector<uint8_t>{0, 0}}) {
        const Film each = film(*face, actions);
        EXPECT_EQ(draw_episode(*face, each, style, font()).clipped(), 0) << scale;
        const Canvas first = draw_episode_frame(*face, each, 0, style, font());
        for (int moment = 0; moment <= each.steps(); ++moment) {
          const Canvas frame = draw_episode_frame(*face, each, moment, style, font());
          EXPECT_EQ(frame.clipped(), 0) << scale;
          EXPECT_EQ(frame.width(), first.width());
          EXPECT_EQ(frame.height(), first.height());
        }
        for (const bool history : {false, true})
          EXPECT_EQ(draw_agent_view(*face, each, {history, "", scale}, font()).clipped(), 0) << scale << history;
      }
    }
}

TEST(WorldFace, TheAgentsPicturesAreThoseOfTheNetwork) {
  Canvas canvas(60, 60, font());
  const Film each = film(plain(), kThere);
  ASSERT_EQ(plain().seen_unit(), Corridor::kCells);
  plain().draw_seen(canvas, {0, 0, 60, 60}, each, 1);
  const ObservationSpec& spec = plain().world().observation_spec();
  EXPECT_EQ(canvas.at(35, 25), spec.palette[2]) << "the agent is in cell 3";
  EXPECT_EQ(canvas.at(25, 25), spec.palette[1]);
  plain().draw_input(canvas, {0, 0, 60, 60}, each, -1);
  EXPECT_EQ(pixels_of(canvas, spec.palette[0]), 60 * 60);
}

TEST(WorldFace, AFewLinesGiveAPlanAndTheWayOverIt) {
  const Film each = film(own(), kThere);
  EpisodeStyle style;
  style.scale = 1;
  style.strip = 0;
  EXPECT_EQ(pixels_of(draw_episode(plain(), each, style, font()), kCarpet), 0);
  const int64_t cell = 20 * 20, carpet = pixels_of(draw_episode(own(), each, style, font()), kCarpet);
  EXPECT_LT(carpet, 6 * cell - 200) << "the way lies on it";
  EXPECT_GT(carpet, 3 * cell);
  std::set<std::string> frames;
  for (int moment = 0; moment <= each.steps(); ++moment)
    frames.insert(draw_episode_frame(own(), each, moment, style, font()).png());
  EXPECT_EQ(frames.size(), size_t(each.steps()) + 1);
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

TEST(Path, RunsOverAPlanOfAnyWidth) {
  const PlanGrid place = {0, 0, 100, 30};
  const std::vector<PathCorner> corners = path_corners(place, {31, 61, 62});
  EXPECT_EQ(corners.front().at.x, 150);
  EXPECT_EQ(corners.front().at.y, 150);
  EXPECT_EQ(corners.back().at.x, 250);
  EXPECT_EQ(corners.back().at.y, 250);
}

TEST(Faces, AreChosenByTheWorldAndByItsName) {
  EXPECT_NE(dynamic_cast<const GridFace*>(open_face("gridworld").get()), nullptr);
  EXPECT_NE(dynamic_cast<const KitchenFace*>(open_face("kitchen").get()), nullptr);
  EXPECT_STREQ(plain().kind().environment, "environment");
  EXPECT_EQ(drawn_worlds(), "gridworld, gridworld:DIR or kitchen");
  EXPECT_EQ(worlds_with(&FaceKind::has_policy_picture), "gridworld");
  EXPECT_EQ(environments_with(&FaceKind::has_window), "mazes");
  EXPECT_THROW(open_face("corridor"), Error);
  EXPECT_THROW(open_face("kitchen:folder"), Error);
}

}  // namespace
}  // namespace synpo
