#include "stats/matrix/split.h"

#include <algorithm>
#include <map>
#include <set>

#include "helpers/table_helpers.h"

namespace synpo {
namespace {

std::vector<std::string> names(const std::string& stem, int count) {
  std::vector<std::string> all;
  for (int i = 1; i <= count; ++i) all.push_back(stem + std::to_string(i));
  return all;
}

SplitPlan plan(int envs, int tasks, int64_t seen, uint64_t seed = 1) {
  SplitPlan p;
  p.envs = names("e", envs);
  p.tasks = names("t", tasks);
  p.seen = seen;
  p.seed = seed;
  return p;
}

// Names of the seen pairs, and how often an environment or task is seen.
struct Seen {
  explicit Seen(const SplitPlan& p, const std::string& part = "") {
    for (const std::string& name : p.envs) times[name] = 0;
    for (const std::string& name : p.tasks) times[name] = 0;
    for (const SplitPair& pair : split_pairs(p)) {
      if (!pair.seen || (!part.empty() && pair.part != part)) continue;
      pairs.insert(pair.env + " " + pair.task);
      ++times[pair.env];
      ++times[pair.task];
    }
  }
  int least() const {
    return std::min_element(times.begin(), times.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->second;
  }
  std::set<std::string> pairs;
  std::map<std::string, int> times;
};

TEST(Split, ListsEveryPairOnceInOrder) {
  const auto pairs = split_pairs(plan(3, 2, 4));
  ASSERT_EQ(pairs.size(), 6u);
  EXPECT_EQ(pairs[0].env + pairs[0].task, "e1t1");
  EXPECT_EQ(pairs[1].env + pairs[1].task, "e1t2");
  EXPECT_EQ(pairs[5].env + pairs[5].task, "e3t2");
  EXPECT_EQ(pairs[0].part, "");
}

TEST(Split, CountIsExactAndCoverKept) {
  const int sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {5, 5}, {20, 20}, {20, 3}, {4, 9}, {13, 12}, {12, 13}, {50, 20}};
  for (const auto& [envs, tasks] : sizes) {
    const int64_t longer = std::max(envs, tasks), shorter = std::min(envs, tasks), all = longer * shorter;
    for (uint64_t seed = 0; seed < 20; ++seed) {
      for (int64_t count = 1; count <= all; count += 1 + all / 37) {
        const Seen seen(plan(envs, tasks, count, seed));
        EXPECT_EQ(int64_t(seen.pairs.size()), count);
        EXPECT_GE(seen.least(), std::min({int64_t{4}, shorter, count / longer}))
            << envs << " x " << tasks << ", " << count << ", seed " << seed;
      }
      for (int64_t cover = 0; cover <= shorter; ++cover) {
        SplitPlan p = plan(envs, tasks, std::max<int64_t>(1, cover * longer), seed);
        p.cover = cover;
        EXPECT_GE(Seen(p).least(), cover) << envs << " x " << tasks << ", seed " << seed;
      }
    }
  }
}

TEST(Split, DefaultsAreThePapers) {
  const Seen seen(plan(20, 20, -1));
  EXPECT_EQ(seen.pairs.size(), 144u);
  EXPECT_GE(seen.least(), 4);
  SplitPlan p = plan(10, 10, -1);
  p.ratio = 0.2;
  EXPECT_EQ(Seen(p).pairs.size(), 20u);
}

TEST(Split, SameSeedSameSplitOtherSeedAnother) {
  EXPECT_EQ(Seen(plan(20, 20, 144, 7)).pairs, Seen(plan(20, 20, 144, 7)).pairs);
  std::set<std::set<std::string>> different;
  for (uint64_t seed = 0; seed < 50; ++seed) different.insert(Seen(plan(20, 20, 144, seed)).pairs);
  EXPECT_EQ(different.size(), 50u);
}

// The bytes of a seed are a promise: published splits are named by it.
TEST(Split, SmallSplitStaysAsItIs) {
  const auto picture = [](const SplitPlan& plan) {
    std::string text;
    for (const SplitPair& pair : split_pairs(plan)) text += pair.seen ? '1' : '0';
    return text;
  };
  SplitPlan p = plan(5, 5, 12, 1);
  EXPECT_EQ(picture(p), "0010101110100111100001010");
  p.cover = 0;
  EXPECT_EQ(picture(p), "0011100101000111010011001");
}

TEST(Split, EveryCellGetsItsTurn) {
  std::map<std::string, int> times;
  for (uint64_t seed = 0; seed < 1000; ++seed)
    for (const std::string& pair : Seen(plan(6, 4, 12, seed)).pairs) ++times[pair];
  ASSERT_EQ(times.size(), 24u);
  // 500 expected of each, sd 16.
  for (const auto& [pair, count] : times) EXPECT_NEAR(count, 500, 80) << pair;
}

TEST(Split, SmallerCountsLieInsideLargerOnes) {
  for (uint64_t seed = 0; seed < 5; ++seed) {
    std::set<std::string> before;
    for (int64_t count = 1; count <= 12 * 9; ++count) {
      const Seen seen(plan(12, 9, count, seed));
      EXPECT_TRUE(std::includes(seen.pairs.begin(), seen.pairs.end(), before.begin(), before.end()));
      before = seen.pairs;
    }
  }
}

// "The seen set at 20 % lies inside the one at 30 %", in every setting and for tables that are far from square.
TEST(Split, SharesAreNested) {
  for (uint64_t seed : {1, 2, 3}) {
    for (const auto& [envs, tasks] : {std::pair(20, 20), std::pair(7, 40), std::pair(100, 30)}) {
      for (int setting : {1, 2, 3}) {
        std::set<std::string> before;
        for (double ratio : {0.05, 0.2, 0.3, 0.36, 1.0}) {
          SplitPlan p = plan(envs, tasks, -1, seed);
          p.setting = setting;
          p.ratio = ratio;
          const Seen seen(p, setting == 1 ? "" : "P");
          EXPECT_TRUE(std::includes(seen.pairs.begin(), seen.pairs.end(), before.begin(), before.end())) << ratio;
          EXPECT_GT(seen.pairs.size(), before.size());
          before = seen.pairs;
        }
      }
    }
  }
}

TEST(Split, SinglePairsAreAlone) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    SplitPlan p = plan(10, 10, 20, seed);
    p.singles = {{"e3", "t9"}};
    Seen seen(p);
    EXPECT_EQ(seen.pairs.size(), 20u);
    EXPECT_EQ(seen.times["e3"], 1);
    EXPECT_EQ(seen.times["t9"], 1);
    EXPECT_TRUE(seen.pairs.contains("e3 t9"));
    seen.times.erase("e3");
    seen.times.erase("t9");
    EXPECT_GE(seen.least(), 2);
    p.singles.push_back({"e1", "t1"});
    Seen two(p);
    EXPECT_EQ(two.pairs.size(), 20u);
    EXPECT_EQ(two.times["e1"] + two.times["t1"] + two.times["e3"] + two.times["t9"], 4);
  }
}

// Figure 6: an environment and a task are each seen in one pair only, in different places, and not together.
TEST(Split, SingleEnvironmentAndSingleTaskApart) {
  std::map<std::string, int> partners;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    SplitPlan p = plan(10, 10, 20, seed);
    p.singles = {{"e1", ""}, {"", "t9"}};
    Seen seen(p);
    ASSERT_EQ(seen.pairs.size(), 20u);
    EXPECT_EQ(seen.times["e1"], 1);
    EXPECT_EQ(seen.times["t9"], 1);
    EXPECT_FALSE(seen.pairs.contains("e1 t9"));
    for (const std::string& pair : seen.pairs)
      if (pair.starts_with("e1 ") || pair.ends_with(" t9")) ++partners[pair];
    seen.times.erase("e1");
    seen.times.erase("t9");
    EXPECT_GE(seen.least(), 2);
    p.singles = {{"", "t9"}, {"e1", ""}};  // their order says nothing
    EXPECT_EQ(Seen(p).pairs, seen.pairs);
    p.seen = 40;
    const std::set<std::string> more = Seen(p).pairs;
    EXPECT_TRUE(std::includes(more.begin(), more.end(), seen.pairs.begin(), seen.pairs.end()));
  }
  ASSERT_EQ(partners.size(), 18u);  // nine of each, 33 times expected, sd 5.4
  for (const auto& [pair, count] : partners) EXPECT_NEAR(count, 33, 22) << pair;
}

TEST(Split, Quadrants) {
  for (int setting : {2, 3}) {
    SplitPlan p = plan(20, 20, -1);
    p.setting = setting;
    p.p_envs = 12;
    std::map<std::string, int> count;
    for (const SplitPair& pair : split_pairs(p)) {
      const bool old_env = std::stoi(pair.env.substr(1)) <= 12, old_task = std::stoi(pair.task.substr(1)) <= 10;
      const std::string part = old_env && old_task     ? "P"
                               : setting == 2          ? (old_env != old_task ? "Q" : "rest")
                               : !old_env && !old_task ? "Q"
                                                       : "rest";
      EXPECT_EQ(pair.part, part);
      EXPECT_EQ(pair.seen, part != "rest");
      ++count[part];
    }
    EXPECT_EQ(count["P"], 120);
    EXPECT_EQ(count["Q"], setting == 2 ? 120 + 80 : 80);
    p.seen = 60;
    const Seen in_p(p, "P"), in_q(p, "Q");
    EXPECT_EQ(in_p.pairs.size(), 60u);
    EXPECT_EQ(int(in_q.pairs.size()), count["Q"]);
    for (int i = 1; i <= 10; ++i) EXPECT_GE(in_p.times.at("e" + std::to_string(i)), 4);
  }
  SplitPlan odd = plan(5, 7, -1);
  odd.setting = 3;
  EXPECT_EQ(Seen(odd, "P").pairs.size(), 3u * 4u) << "the larger half";
  odd.p_envs = odd.p_tasks = 1;
  EXPECT_EQ(Seen(odd, "P").pairs.size(), 1u);
}

std::string refused(SplitPlan p) {
  return thrown([&] { split_pairs(p); });
}

TEST(Split, RefusesPlansThatCannotBeMet) {
  EXPECT_EQ(refused(plan(5, 5, 26)), "64 cannot have 26 seen pairs: 5 x 5 pairs allow 1 to 25");
  EXPECT_EQ(refused(plan(5, 5, 0)), "64 cannot have 0 seen pairs: 5 x 5 pairs allow 1 to 25");
  EXPECT_EQ(refused(plan(0, 5, 1)), "64 there is no environment to split");
  EXPECT_EQ(refused(plan(1001, 1000, 1)), "64 split: 1001 x 1000 pairs, at most 1000000");
  SplitPlan p = plan(5, 4, 14);
  p.cover = 3;
  EXPECT_EQ(refused(p), "64 cannot cover every environment and task 3 times with 14 seen pairs: it takes 15");
  p.cover = 5;
  EXPECT_EQ(refused(p), "64 cannot cover every environment and task 5 times: at most 4 times is possible");
  p = plan(5, 5, 18);
  p.singles = {{"e1", "t1"}};
  EXPECT_EQ(refused(p), "64 cannot have 18 seen pairs: 5 x 5 pairs with these single ones allow 1 to 17");
  p.singles.push_back({"e1", "t2"});
  EXPECT_EQ(refused(p), "64 e1,t2: its environment or its task has another single pair already");
  EXPECT_TRUE(fails_for(kSinglePair, [&] { split_pairs(p); }));
  p.singles = {{"e1", "t1"}, {"", "t1"}};
  EXPECT_EQ(refused(p), "64 t1: its environment or its task has another single pair already");
  p.singles = {{"", "t9"}};
  EXPECT_EQ(refused(p), "64 t9: 't9' is no task of this split");
  p.singles = {{"e1", ""}, {"e2", ""}, {"", "t1"}};
  EXPECT_EQ(refused(p), "64 cannot have 18 seen pairs: 5 x 5 pairs with these single ones allow 3 to 15");
  p.singles = {{"e1", ""}, {"e2", ""}, {"e3", ""}, {"e4", ""}, {"e5", ""}, {"", "t1"}};
  EXPECT_EQ(refused(p), "64 no environment or no task is left that a single one could be seen with");
  p.singles = {{"e9", "t1"}};
  EXPECT_EQ(refused(p), "64 e9,t1: 'e9' is no environment of this split");
  EXPECT_TRUE(fails_for(kSinglePair, [&] { split_pairs(p); }));
  p.singles = {{"e1", "t1"}};
  p.setting = 2;
  EXPECT_EQ(refused(p), "64 single pairs belong to setting 1");
  p = plan(5, 5, 9);
  p.p_envs = 2;
  EXPECT_EQ(refused(p), "64 setting 1 has no part P");
  p.setting = 3;
  p.p_envs = 5;
  EXPECT_EQ(refused(p),
            "64 part P of 5 environments and 3 tasks, expected at least 1 and fewer than the 5 and 5 there are");
  p.p_envs = 2;
  p.p_tasks = 0;
  EXPECT_EQ(refused(p),
            "64 part P of 2 environments and 0 tasks, expected at least 1 and fewer than the 5 and 5 there are");
  p = plan(2, 2, 2);
  p.envs = {"e1", "e1"};
  EXPECT_EQ(refused(p), "64 the environment 'e1' is named twice");
  p.envs = {"e1", ""};
  EXPECT_EQ(refused(p), "64 an environment has no name");
  p = plan(2, 2, 2);
  p.tasks = {"", "t1"};
  EXPECT_EQ(refused(p), "64 a task has no name");
  // What no reader of pairs takes.
  p.tasks = {"a\tb"};
  EXPECT_EQ(refused(p),
            "64 the task 'a\\x09b': found a control character at byte 2 of the name (\\x09), expected UTF-8 text");
  p.tasks = {std::string(256, 'x')};
  EXPECT_TRUE(refused(p).ends_with("...': found a name of 256 bytes, expected at most 255"));
}

TEST(Split, ChoosesNames) {
  const std::vector<std::string> all = {"map1", "map2", "map10"};
  EXPECT_EQ(choose_names("--envs", "", all), all);
  EXPECT_EQ(choose_names("--envs", "2", all), (std::vector<std::string>{"map1", "map2"}));
  EXPECT_EQ(choose_names("--envs", "map10,map1", all), (std::vector<std::string>{"map10", "map1"}));
  EXPECT_EQ(thrown([&] { choose_names("--envs", "4", all); }), "64 --envs 4: expected 1 to 3, or names");
  EXPECT_EQ(thrown([&] { choose_names("--envs", "99999999999999999999", all); }),
            "64 --envs 99999999999999999999: expected 1 to 3, or names");
  EXPECT_EQ(thrown([&] { choose_names("--envs", "map3", all); }),
            "64 --envs: there is no 'map3', expected names such as map1 or a count");
}

}  // namespace
}  // namespace synpo
