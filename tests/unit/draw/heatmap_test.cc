#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "draw/canvas/canvas.h"
#include "draw/colour.h"
#include "draw/episode/agent_view.h"
#include "draw/grid/grid_face.h"
#include "draw/grid/maze_picture.h"
#include "draw/paper.h"
#include "draw/plot/heatmap.h"
#include "format/matrix.h"
#include "world/grid/view.h"

namespace synpo {
namespace {

// Kept for the whole run: each canvas refers to its font.
const Font& font() {
  static const Font shared;
  return shared;
}

MatrixRow row(const std::string& env, const std::string& task, bool seen, int64_t successes, int64_t episodes = 100) {
  MatrixRow out;
  out.method = "synpo";
  out.run = "00000000000000aa";
  out.env = env;
  out.task = task;
  out.seen = seen;
  out.episodes = episodes;
  out.successes = successes;
  return out;
}

Matrix square(int side, const std::string& env_stem = "map", const std::string& task_stem = "task") {
  Matrix matrix;
  for (int task = 1; task <= side; ++task)
    for (int env = 1; env <= side; ++env)
      matrix.rows.push_back(row(env_stem + std::to_string(env), task_stem + std::to_string(task), (env + task) % 3 == 0,
                                (env * 37 + task * 11) % 101));
  return matrix;
}

Exit failure(const Matrix& matrix, const std::string& method = "", bool by_part = false) {
  try {
    pool_matrix(matrix, method, by_part);
  } catch (const Error& error) {
    return error.code();
  }
  return Exit::kOk;
}

HeatFigure figure(const Matrix& matrix) { return arrange({{"", pool_matrix(matrix)}}, grid_task_names()); }

bool same(Rgb a, Rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

TEST(Pool, SumsRunsAndMeansOfGroups) {
  Matrix matrix;
  matrix.rows = {row("a", "x", true, 10), row("a", "x", true, 70), row("b", "x", false, 30),
                 row("c", "y", false, 50, 50)};
  matrix.rows[1].run = "00000000000000bb";
  const HeatTable table = pool_matrix(matrix);
  EXPECT_EQ(table.at(0, 0).episodes, 200);
  EXPECT_EQ(table.at(0, 0).successes, 80);
  EXPECT_FALSE(table.at(1, 0).evaluated());
  ASSERT_EQ(table.groups.size(), 2u);
  EXPECT_EQ(table.groups[0].name, "seen");
  EXPECT_DOUBLE_EQ(table.groups[0].rate(), 0.4);
  EXPECT_EQ(table.groups[1].pairs, 2);
  EXPECT_DOUBLE_EQ(table.groups[1].rate(), 80.0 / 150);
  EXPECT_EQ(table.caption, "synpo, 2 runs, 50 to 200 episodes a pair");
}

TEST(Pool, RefusesWhatCannotBePooled) {
  Matrix matrix = square(2);
  EXPECT_EQ(failure(matrix), Exit::kOk);
  EXPECT_EQ(failure(matrix, "mlp"), Exit::kData);
  EXPECT_EQ(failure(matrix, "", true), Exit::kData);
  Matrix other = matrix;
  other.rows.push_back(row("map1", "task1", !matrix.rows[0].seen, 1));
  EXPECT_EQ(failure(other), Exit::kData);
  other = matrix;
  other.rows.back().window = 0;
  EXPECT_EQ(failure(other), Exit::kData);
  other = matrix;
  other.rows.back().method = "mlp";
  EXPECT_EQ(failure(other), Exit::kData);
  EXPECT_EQ(failure(other, "synpo"), Exit::kOk);
}

TEST(Pool, PartsHaveMeansOfTheirOwn) {
  Matrix matrix;
  matrix.has_part = true;
  matrix.rows = {row("a", "x", true, 90), row("b", "x", true, 50), row("c", "x", false, 30)};
  matrix.rows[0].part = "P";
  matrix.rows[1].part = "Q";
  matrix.rows[2].part = "rest";
  const HeatTable by_seen = pool_matrix(matrix), by_part = pool_matrix(matrix, "", true);
  ASSERT_EQ(by_seen.parts.size(), 3u);
  EXPECT_DOUBLE_EQ(by_seen.parts[1].rate(), 0.5);
  ASSERT_EQ(by_part.groups.size(), 3u);
  EXPECT_EQ(by_part.groups[2].name, "rest");
  const Scheme& scheme = find_scheme("purple-red");
  EXPECT_EQ(&group_ramp(by_part, by_part.at(0, 1).group, scheme), &scheme.seen);
  EXPECT_EQ(&group_ramp(by_part, by_part.at(0, 2).group, scheme), &scheme.unseen);
}

TEST(RateText, OneAndZeroOnlyWhereAllOrNoneSucceeded) {
  EXPECT_EQ(rate_text(0, 100), "0.00");
  EXPECT_EQ(rate_text(1, 1000), "0.01");
  EXPECT_EQ(rate_text(833, 1000), "0.83");
  EXPECT_EQ(rate_text(999, 1000), "0.99");
  EXPECT_EQ(rate_text(7, 7), "1.00");
}

TEST(Colour, DarkerIsBetterAndSeenDiffersFromUnseen) {
  for (const char* name : {"safe", "purple-red", "blue-red"}) {
    const Scheme& scheme = find_scheme(name);
    for (const Ramp& ramp : {scheme.seen, scheme.unseen, scheme.other})
      for (int percent = 1; percent <= 100; ++percent)
        EXPECT_LT(luminance(ramp_colour(ramp, percent / 100.0)), luminance(ramp_colour(ramp, (percent - 1) / 100.0)))
            << name << " at " << percent << " %";
    for (int percent = 0; percent <= 100; percent += 5) {
      const Rgb seen = ramp_colour(scheme.seen, percent / 100.0), unseen = ramp_colour(scheme.unseen, percent / 100.0);
      EXPECT_GT(std::abs(seen.r - unseen.r) + std::abs(seen.g - unseen.g) + std::abs(seen.b - unseen.b), 20) << name;
      // The same rate is equally dark in both.
      EXPECT_NEAR(std::cbrt(luminance(seen)), std::cbrt(luminance(unseen)), 0.07) << name << " at " << percent << " %";
    }
  }
  EXPECT_THROW(find_scheme("grey"), std::invalid_argument);
}

TEST(Colour, InkHasAContrastOfAtLeastFourAndAHalf) {
  const Scheme& scheme = find_scheme("safe");
  for (int percent = 0; percent <= 100; ++percent)
    for (const Ramp& ramp : {scheme.seen, scheme.unseen}) {
      const Rgb ground = ramp_colour(ramp, percent / 100.0);
      const double a = luminance(ground) + 0.05, b = luminance(ink_on(ground)) + 0.05;
      EXPECT_GE(std::max(a, b) / std::min(a, b), 4.5);
    }
}

TEST(Text, FittedKeepsBothEndsAndFits) {
  const std::string name = "kitchen-with-a-long-name-FloorPlan12";
  for (int width = 40; width < 400; width += 23) {
    const std::string fitted = font().fitted(name, 17, width);
    EXPECT_LE(font().width(fitted, 17), width);
  }
  EXPECT_EQ(font().fitted("map12", 17, 400), "map12");
  const std::string cut = font().fitted(name, 17, 150);
  EXPECT_EQ(cut.front(), 'k');
  EXPECT_EQ(cut.back(), '2');
  // Whole characters only.
  EXPECT_EQ(font().fitted("\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9", 17, 45).size() % 2, 1u);
}

TEST(Text, WrappedLinesFit) {
  const auto lines = font().wrapped("one two three four five six seven " + std::string(80, 'w'), 20, 150);
  EXPECT_GT(lines.size(), 3u);
  for (const std::string& line : lines) EXPECT_LE(font().width(line, 20), 150);
}

TEST(Text, ClippingIsCounted) {
  Canvas canvas(60, 30, font());
  canvas.text(2, 2, "in", 12, kInk);
  EXPECT_EQ(canvas.clipped(), 0);
  canvas.text(40, 2, "out of it", 12, kInk);
  EXPECT_GT(canvas.clipped(), 0);
}

TEST(Font, MissingFontNamesThePackage) {
  EXPECT_THROW(Font("/nonexistent/font.ttf"), Error);
  ASSERT_EQ(setenv("SYNPO_FONT", "/nonexistent/font.ttf", 1), 0);
  EXPECT_THROW(Font(), Error);
  unsetenv("SYNPO_FONT");
}

TEST(Heatmap, NothingIsClippedAndLabelsKeepApart) {
  for (const int side : {1, 2, 5, 10, 20, 50, 70, 200})
    for (const double scale : {0.5, 1.0, 2.0}) {
      HeatmapStyle style;
      style.scale = scale;
      style.title =
          side % 2 ? "" : "A title that is rather long for a picture of a matrix of this size, and is wrapped";
      const HeatFigure matrix = figure(square(side));
      const HeatmapLayout layout = lay_out_heatmap(matrix, style, font());
      const Canvas canvas = draw_heatmap(matrix, style, font());
      EXPECT_EQ(canvas.clipped(), 0) << side << " at " << scale;
      EXPECT_EQ(canvas.width(), layout.width);
      EXPECT_EQ(canvas.height(), layout.height);
      EXPECT_EQ(layout.panels[0].matrix.width, side * layout.cell);
      EXPECT_GT(layout.legend.x, layout.panels[0].matrix.right());
      EXPECT_LE(layout.legend.right(), layout.width);
      const auto nameless = std::count(layout.env_labels.begin(), layout.env_labels.end(), "") +
                            std::count(layout.task_labels.begin(), layout.task_labels.end(), "");
      if (side <= 50 && scale >= 1) {
        EXPECT_EQ(nameless, 0) << side;
      }
      if (layout.value_size > 0) {
        EXPECT_LT(font().width("1.00", layout.value_size), layout.cell - layout.gap);
      }
    }
}

TEST(Heatmap, ValuesStandInTheCellsUpToFiftyAtTheDefaultScale) {
  const auto value_size = [](int side, bool values) {
    HeatmapStyle style;
    style.values = values;
    return lay_out_heatmap(figure(square(side)), style, font()).value_size;
  };
  EXPECT_GE(value_size(50, true), 14);
  EXPECT_EQ(value_size(50, false), 0);
  EXPECT_EQ(value_size(200, true), 0);
}

TEST(Heatmap, LongNamesFit) {
  const HeatFigure matrix =
      figure(square(5, std::string(300, 'e'), "put the tomato and the mug and the plate into the fridge "));
  const Canvas canvas = draw_heatmap(matrix, {}, font());
  EXPECT_EQ(canvas.clipped(), 0);
  EXPECT_LT(canvas.width(), 1500);
  const HeatmapLayout layout = lay_out_heatmap(matrix, {}, font());
  EXPECT_TRUE(layout.env_labels_up);
  EXPECT_EQ(std::set<std::string>(layout.env_labels.begin(), layout.env_labels.end()).size(), 5u);
}

TEST(Heatmap, CellsHaveTheirRampsColourAndMissingPairsAreEmpty) {
  Matrix matrix;
  matrix.rows = {row("a", "x", true, 80), row("b", "x", false, 80), row("a", "y", true, 20)};
  HeatmapStyle style;
  style.values = false;
  const Canvas canvas = draw_heatmap(figure(matrix), style, font());
  const HeatmapLayout layout = lay_out_heatmap(figure(matrix), style, font());
  const Box box = layout.panels[0].matrix;
  const auto middle = [&](int task, int env) {
    return canvas.at(box.x + env * layout.cell + layout.cell / 2, box.y + task * layout.cell + layout.cell / 3);
  };
  const Scheme& scheme = find_scheme("safe");
  EXPECT_TRUE(same(middle(0, 0), ramp_colour(scheme.seen, 0.8)));
  EXPECT_TRUE(same(middle(0, 1), ramp_colour(scheme.unseen, 0.8)));
  EXPECT_TRUE(same(middle(1, 0), ramp_colour(scheme.seen, 0.2)));
  EXPECT_TRUE(same(middle(1, 1), kPaper));
}

TEST(Heatmap, SameBytesEveryTime) {
  const HeatFigure matrix = figure(square(7));
  const Font another;
  const std::string first = draw_heatmap(matrix, {}, font()).png();
  EXPECT_EQ(first.substr(1, 3), "PNG");
  EXPECT_EQ(first, draw_heatmap(matrix, {}, another).png());
  // No chunk that could hold a date or a host.
  for (const char* chunk : {"tIME", "tEXt", "iTXt", "zTXt"}) EXPECT_EQ(first.find(chunk), std::string::npos);
}

TEST(Heatmap, TooLargeAPictureIsRefused) {
  HeatmapStyle style;
  style.cell_pt = 200;
  style.scale = 16;
  EXPECT_THROW(draw_heatmap(figure(square(20)), style, font()), Error);
}

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
    EXPECT_TRUE(same(canvas.at(cell % 16 * 10 + 5, cell / 16 * 10 + 5), maze.wall[cell] ? kPaperWall : kPaperFloor))
        << cell;
}

TEST(View, ShowsThePaletteOfTheAgentsPicture) {
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
        for (int x = 0; x < canvas.width(); ++x) wall += same(canvas.at(x, y), kPalette[kWall]);
      EXPECT_EQ(wall > 10'000, radius == 15) << radius;
    }
}

TEST(View, ExpertMomentsFollowThePlanner) {
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

}  // namespace
}  // namespace synpo
