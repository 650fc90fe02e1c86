#include "world/kitchen/geometry/kitchen.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "helpers/kitchens.h"
#include "helpers/table_helpers.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

TEST(Kitchen, ReadsText) {
  const Kitchen kitchen = small_kitchen();
  EXPECT_EQ(kitchen.rows, 11);
  EXPECT_EQ(kitchen.columns, 10);
  EXPECT_EQ(kitchen.at(1, 2), 'F');
  EXPECT_EQ(kitchen.at(5, 3), 't');
  EXPECT_EQ(kitchen.floor.size(), 7u * 5 - 4);
  const Kitchen::Footprint& fridge = kitchen.receptacles[kFridge];
  EXPECT_EQ((std::array{fridge.row, fridge.column, fridge.rows, fridge.columns, fridge.back}),
            (std::array{1, 2, 2, 2, 0}));
  EXPECT_EQ(kitchen.receptacles[kMicrowave].back, 2);
  std::string other = kSmallPlan;
  other.pop_back();
  for (size_t at = 0; (at = other.find('\n', at)) != std::string::npos; at += 2) other.insert(at, "\r");
  EXPECT_EQ(parse_kitchen("small", other, "small.txt").hash, kitchen.hash);
}

TEST(Kitchen, RefusesHostileText) {
  const auto error = [](const std::string& text) {
    return message_of([&] { KitchenSet({parse_kitchen("k", text, "k.txt")}); });
  };
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kSmallPlan;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_EQ(error(kSmallPlan), "no error");
  EXPECT_EQ(error(""), "k.txt: found nothing, expected a kitchen's plan");
  EXPECT_EQ(error("##\n##\n"), "k.txt: found no floor");
  EXPECT_EQ(error(std::string(41, '#')), "k.txt: line 1: found 41 characters, expected at most 40");
  EXPECT_EQ(error(std::string(100000, '#')), "k.txt: line 1: found 100000 characters, expected at most 40");
  EXPECT_EQ(error(std::string(100000, '\n')),
            "k.txt: found more than 40 lines, expected a kitchen of at most that many");
  EXPECT_EQ(error("\n\n"), "k.txt: found no floor");
  EXPECT_EQ(error("###\n#.#\n##\n"), "k.txt: line 3: found 2 characters, expected 3 as in line 1");
  EXPECT_EQ(error("###\n#.#\n#.#\n"), "k.txt: line 3, column 2: found '.', expected the outer wall");
  EXPECT_EQ(error("###\nc.#\n###\n"), "k.txt: line 2, column 1: found 'c', expected the outer wall");
  EXPECT_EQ(error(with("tt", "t@")), "k.txt: line 6, column 5: found '@', expected one of # . c t F M S");
  EXPECT_EQ(error(with("tt", std::string("t\0", 2))),
            "k.txt: line 6, column 5: found U+0000, expected one of # . c t F M S");
  EXPECT_EQ(error(with("#..tt...##\n#..tt...", "#ccttccc##\n#ccttccc")),
            "k.txt: line 8, column 2: this floor cannot be reached from that in line 4, column 2");
  EXPECT_EQ(error(with("SSSc", "SScc")), "k.txt: the cells of the Sink ('S') are not one rectangle of at most 4 x 4");
  EXPECT_EQ(error(with("tt", "tS")), "k.txt: the cells of the Sink ('S') are not one rectangle of at most 4 x 4");
  EXPECT_EQ(error(with("FFcSSSc#\n#cFF", "cccSSSc#\n#ccc")), "k.txt: found no 'F', expected a Fridge");
  // A Fridge behind walls that nobody can open.
  EXPECT_EQ(error(with("#cFFcSSSc#\n#cFFcSSSc#", "#cFF#SSSc#\n#####SSSc#")),
            "k: the Fridge cannot be used from row 3, column 1, heading 0, horizon -30");
  const Kitchen bare = parse_kitchen("bare", "#######\n#FMS..#\n#.....#\n#######\n", "bare");
  EXPECT_EQ(message_of([&] { KitchenSet({bare}); }),
            "bare: found 0 places on which an object can lie and be picked up, expected at least 7");
  EXPECT_EQ(message_of([] { KitchenSet({small_kitchen(), small_kitchen()}); }), "two environments are named 'small'");
}

}  // namespace
}  // namespace synpo
