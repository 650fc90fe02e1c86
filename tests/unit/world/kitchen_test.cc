#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "base/error.h"
#include "base/hash.h"
#include "helpers/kitchens.h"
#include "world/kitchen/builtin_kitchens.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

const std::pair<int, int> kTable1[] = {{1, 129}, {2, 115}, {3, 104}, {4, 69},   {5, 99},  {6, 134},  {8, 172},
                                       {9, 76},  {11, 67}, {12, 79}, {18, 222}, {20, 80}, {22, 136}, {23, 96},
                                       {24, 61}, {25, 27}, {27, 43}, {28, 101}, {30, 59}};

const KitchenSet& world() {
  static const KitchenSet kitchens;
  return kitchens;
}

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Exit::kData);
    return error.what();
  }
  return "no error";
}

TEST(BuiltinKitchens, AreThoseOfTable1) {
  const std::vector<Kitchen>& kitchens = builtin_kitchens();
  ASSERT_EQ(kitchens.size(), std::size(kTable1));
  std::set<uint64_t> hashes;
  for (size_t i = 0; i < kitchens.size(); ++i) {
    EXPECT_EQ(kitchens[i].name, "FloorPlan" + std::to_string(kTable1[i].first));
    EXPECT_EQ(int(kitchens[i].floor.size()), kTable1[i].second) << kitchens[i].name;
    hashes.insert(kitchens[i].hash);
  }
  EXPECT_EQ(hashes.size(), kitchens.size());
}

TEST(BuiltinKitchens, ParseBack) {
  for (const Kitchen& kitchen : builtin_kitchens()) {
    const Kitchen again = parse_kitchen(kitchen.name, kitchen.text, kitchen.name);
    EXPECT_EQ(again.hash, kitchen.hash);
    EXPECT_EQ(again.text, kitchen.text);
    EXPECT_EQ(again.floor, kitchen.floor);
  }
}

// Made anew they must be those that older files name.
TEST(BuiltinKitchens, StayWhatTheyAre) {
  Hash hash;
  for (const Kitchen& kitchen : builtin_kitchens()) hash.add(kitchen.text);
  EXPECT_EQ(hex(hash.value()), "4c1493329de188d5");
}

TEST(BuiltinKitchens, HaveRoomForTheObjects) {
  for (int env = 0; env < world().envs(); ++env) {
    EXPECT_GE(world().tables(env).slots.size(), 10u);
    EXPECT_LE(world().tables(env).slots.size(), size_t(kMaxKitchenSlots));
  }
}

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

TEST(KitchenSet, NamesThings) {
  EXPECT_EQ(world().name(), "kitchen");
  EXPECT_EQ(world().envs(), 19);
  ASSERT_EQ(world().task_count(), 21);
  EXPECT_EQ(world().task_names()[0], "Container-Fridge");
  EXPECT_EQ(world().task_names()[8], "Mug-Sink");
  EXPECT_EQ(world().task_names()[20], "Bowl-Sink");
  EXPECT_EQ(world().task_index("Apple-Microwave"), 16);
  EXPECT_EQ(world().actions(), 7);
  EXPECT_EQ(world().env_index("FloorPlan30"), 18);
}

constexpr KitchenTask kMugToFridge = {2, kFridge}, kMugToSink = {2, kSink};

// Objects 0 to 6 on slots 4 to 9 and 3, but the Mug on `mug` and the Tomato on `tomato`.
KitchenState ring_state(int pose, int mug, int tomato) {
  KitchenState state;
  state.pose = uint16_t(pose);
  state.slots = {4, 5, uint8_t(mug), uint8_t(tomato), 6, 7, 8};
  return state;
}

KitchenState with_mug(int pose, int doors) {
  KitchenState state = ring_state(pose, kNoSlot, 9);
  state.hand = 2;
  state.doors = uint8_t(doors);
  return state;
}

void expect_step(KitchenTask task, KitchenState state, int action, int cents, const KitchenState& after) {
  const WorldStep step = kitchen_step(ring_tables(), task, state, action);
  EXPECT_EQ(step.reward_cents, cents) << kKitchenActionNames[action];
  EXPECT_FALSE(step.ended() || step.success || step.wrong) << kKitchenActionNames[action];
  KitchenState expected = after;
  expected.steps = 1;
  EXPECT_EQ(state, expected) << kKitchenActionNames[action];
}

void expect_end(KitchenTask task, KitchenState state, int cents, bool success) {
  const WorldStep step = kitchen_step(ring_tables(), task, state, kPickupPut);
  EXPECT_EQ(step.reward_cents, cents);
  EXPECT_TRUE(step.terminated);
  EXPECT_FALSE(step.truncated);
  EXPECT_EQ(step.success, success);
  EXPECT_EQ(step.wrong, !success);
}

TEST(KitchenRules, MovesCostOneCentAndFailedOnesTwo) {
  const KitchenState at = ring_state(1, 0, 9);
  expect_step(kMugToFridge, at, kRotateRight, -1, ring_state(2, 0, 9));
  expect_step(kMugToFridge, at, kRotateLeft, -1, ring_state(0, 0, 9));
  for (const int action : {kMoveAhead, kLookUp, kLookDown}) expect_step(kMugToFridge, at, action, -2, at);
}

TEST(KitchenRules, DoorsOpenAndCloseTheNearest) {
  for (const int pose : {0, 1})
    expect_step(kMugToFridge, ring_state(pose, 0, 9), kOpenClose, -2, ring_state(pose, 0, 9));
  for (const int pose :
       {2,
        3}) {  // the Sink, which has no door, stands before the Fridge in the one, the Microwave behind it in the other
    KitchenState open = ring_state(pose, 0, 9);
    open.doors = 1;
    expect_step(kMugToFridge, ring_state(pose, 0, 9), kOpenClose, -1, open);
    expect_step(kMugToFridge, open, kOpenClose, -1, ring_state(pose, 0, 9));
  }
}

TEST(KitchenRules, PickupTakesTheNearest) {
  expect_step(kMugToFridge, ring_state(0, 0, 9), kPickupPut, -2, ring_state(0, 0, 9));
  expect_step(kMugToFridge, ring_state(1, 9, 3), kPickupPut, -2, ring_state(1, 9, 3));
  for (const auto& [mug, tomato] :
       {std::pair{0, 9}, {1, 0}, {2, 0}, {1, 2}, {2, 1}}) {  // of equally near ones the Mug comes first
    KitchenState after = ring_state(1, kNoSlot, tomato);
    after.hand = 2;
    expect_step(kMugToFridge, ring_state(1, mug, tomato), kPickupPut, 99, after);
  }
  for (const int tomato : {1, 2}) expect_end(kMugToFridge, ring_state(1, 0, tomato), -1001, false);
  expect_end({3, kFridge}, ring_state(1, 1, 2), -1001, false);
  expect_end({3, kFridge}, ring_state(1, 2, 1), -1001, false);
}

TEST(KitchenRules, PutFillsTheNearestThatIsOpen) {
  for (const int doors : {0, 1, 2, 3})
    for (const int pose : {0, 1})
      expect_step(kMugToFridge, with_mug(pose, doors), kPickupPut, -2, with_mug(pose, doors));
  expect_step(kMugToFridge, with_mug(3, 0), kPickupPut, -2, with_mug(3, 0));
  expect_end(kMugToFridge, with_mug(3, 1), 999, true);
  expect_end(kMugToFridge, with_mug(3, 3), 999, true);
  expect_end(kMugToFridge, with_mug(3, 2), -1001, false);
  expect_end({2, kMicrowave}, with_mug(3, 2), 999, true);
  expect_end({2, kMicrowave}, with_mug(3, 3), -1001, false);
  expect_end(kMugToFridge, with_mug(2, 1), -1001, false);
  expect_end(kMugToSink, with_mug(2, 1), 999, true);
}

TEST(KitchenRules, EpisodesAreCutAt300Steps) {
  KitchenState state = ring_state(0, 0, 9);
  for (int i = 1; i <= 300; ++i) {
    const WorldStep step = kitchen_step(ring_tables(), kMugToFridge, state, kPickupPut);
    ASSERT_EQ(step.truncated, i == 300);
    ASSERT_FALSE(step.terminated || step.success || step.wrong);
  }
  KitchenState last = with_mug(3, 1);
  last.steps = 299;
  const WorldStep step = kitchen_step(ring_tables(), kMugToFridge, last, kPickupPut);
  EXPECT_TRUE(step.terminated && step.success);
  EXPECT_FALSE(step.truncated);
}

TEST(KitchenRules, OnlyStatesOfRunningEpisodesAreValid) {
  const KitchenTables tables = ring_tables();
  const auto valid = [&](const KitchenState& state) { return kitchen_valid(tables, kMugToFridge, pack(state)); };
  EXPECT_TRUE(valid(ring_state(3, 0, 9)));
  EXPECT_TRUE(valid(with_mug(3, 3)));
  EXPECT_FALSE(valid(ring_state(5, 0, 9)));
  EXPECT_FALSE(valid(ring_state(3, 9, 9)));
  EXPECT_FALSE(valid(ring_state(3, 10, 9)));
  EXPECT_FALSE(valid(ring_state(3, kNoSlot, 9)));
  EXPECT_FALSE(valid(with_mug(3, 4)));
  KitchenState state = with_mug(0, 0);
  state.slots[2] = 0;
  EXPECT_FALSE(valid(state));
  state = ring_state(0, 0, kNoSlot);
  state.hand = 3;
  EXPECT_FALSE(valid(state));
  state.hand = 8;
  EXPECT_FALSE(valid(state));
  state = ring_state(0, 0, 9);
  state.steps = 300;
  EXPECT_FALSE(valid(state));
  WorldState world = pack(ring_state(0, 0, 9));
  EXPECT_EQ(unpack(world), ring_state(0, 0, 9));
  world.bytes[13] = 1;
  EXPECT_FALSE(kitchen_valid(tables, kMugToFridge, world));
}

TEST(KitchenSet, StartsAnywhereAlike) {
  const int env = world().env_index("FloorPlan25");
  const KitchenTables& tables = world().tables(env);
  constexpr int kStarts = 20000;
  std::map<int, int> poses, mugs;
  for (uint64_t i = 0; i < kStarts; ++i) {
    Random random(1, Purpose::kEpisodeStart, 0, i);
    const WorldState start = world().reset(env, random);
    ASSERT_TRUE(world().valid({env, 0}, start));
    const KitchenState state = unpack(start);
    ASSERT_EQ(tables.poses[state.pose].horizon, 0);
    ASSERT_EQ(state.doors, 0);
    ASSERT_EQ(state.hand, kEmptyHand);
    ++poses[state.pose];
    ++mugs[state.slots[2]];
  }
  for (const auto& [counts, kinds] : {std::pair{&poses, tables.start_poses.size()}, {&mugs, tables.slots.size()}}) {
    EXPECT_EQ(counts->size(), kinds);
    double chi_square = 0;
    const double expected = double(kStarts) / double(kinds);
    for (const auto& [value, count] : *counts) chi_square += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi_square, double(kinds) + 5 * std::sqrt(2 * double(kinds)));
  }
}

TEST(KitchenSet, StartPlacesComeBack) {
  for (int i = 0; i < 400; ++i) {
    const int env = i % world().envs();
    Random random(2, Purpose::kEpisodeStart, 0, uint64_t(i));
    const WorldState start = world().reset(env, random);
    const StartPlaces places = world().start_places(env, start);
    ASSERT_EQ(places.size(), 9u);
    ASSERT_EQ(world().start_state(env, places), start);
    const KitchenPose& pose = world().tables(env).poses[unpack(start).pose];
    ASSERT_EQ(places.at("agent"), std::pair(int(pose.row), int(pose.column)));
    ASSERT_EQ(places.at("view"), std::pair(int(pose.heading), 0));
    const KitchenCell& bowl = world().tables(env).slots[unpack(start).slots[6]];
    ASSERT_EQ(places.at("Bowl"), std::pair(int(bowl.row), int(bowl.column)));
  }
}

TEST(KitchenSet, RefusesHostileStartPlaces) {
  const KitchenSet small({small_kitchen()});
  Random random(3, Purpose::kEpisodeStart, 0, 0);
  const StartPlaces good = small.start_places(0, small.reset(0, random));
  const auto error = [&](const std::string& name, std::pair<int, int> value) {
    StartPlaces places = good;
    places[name] = value;
    return message_of([&] { small.start_state(0, places); });
  };
  EXPECT_EQ(error("agent", {4, 4}), "no error");
  EXPECT_EQ(error("agent", {5, 3}), "'agent': found row 5, column 3, which is not a free cell");
  EXPECT_EQ(error("agent", {-1, 2000000000}), "'agent': found row -1, column 2000000000, which is not a free cell");
  EXPECT_EQ(error("agent", {4 + 65536, 4}), "'agent': found row 65540, column 4, which is not a free cell");
  EXPECT_EQ(error("view", {90, 30}), "'view': found heading 90, horizon 30, with which no episode starts");
  EXPECT_EQ(error("view", {45, 0}), "'view': found heading 45, horizon 0, with which no episode starts");
  EXPECT_EQ(error("view", {90 + 65536, 0}), "'view': found heading 65626, horizon 0, with which no episode starts");
  EXPECT_EQ(error("Plate", {4, 4}), "'Plate': found row 4, column 4, where no object can lie");
  EXPECT_EQ(error("Plate", good.at("Mug")), concat("'Plate': found row ", good.at("Mug").first, ", column ",
                                                   good.at("Mug").second, ", where another object lies"));
  EXPECT_EQ(error("Knife", {4, 4}), "found 'Knife', expected agent, view and the seven objects");
  for (const auto& [name, place] : good) {
    StartPlaces places = good;
    places.erase(name);
    EXPECT_EQ(message_of([&] { small.start_state(0, places); }), "'" + name + "': found none, expected two numbers");
  }
}

}  // namespace
}  // namespace synpo
