#include "world/grid/grid_set.h"

#include <gtest/gtest.h>

#include <set>

#include "helpers/mazes.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(GridSet, FindsNames) {
  const GridSet world = GridSet::open("gridworld");
  EXPECT_EQ(world.env_index("map20"), 19);
  EXPECT_EQ(world.env_index("map21"), -1);
  EXPECT_EQ(world.task_index("P-O"), 19);
  EXPECT_EQ(world.task_index("O"), -1);
  std::set<uint64_t> numbers;
  for (int env = 0; env < world.envs(); ++env)
    for (int task = 0; task < world.task_count(); ++task) numbers.insert(world.pair_number({env, task}));
  EXPECT_EQ(numbers.size(), 400u);
  EXPECT_EQ(thrown([] { GridSet::open("kitchen"); }),
            "64 unknown world 'kitchen', expected gridworld or gridworld:DIR");
  EXPECT_EQ(thrown([] { GridSet({open_maze(), open_maze()}); }), "65 two environments are named 'open'");
}

}  // namespace
}  // namespace synpo
