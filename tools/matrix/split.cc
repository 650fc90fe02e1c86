// synpo-matrix split: draws which pairs of environments and tasks training sees.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"
#include "format/pairs.h"
#include "matrix/matrix.h"
#include "play/world_factory.h"
#include "stats/matrix/split.h"
#include "world/world.h"

namespace synpo {
namespace {

// Names of a world that this program does not know: those listed, or so many with numbers.
std::vector<std::string> any_names(const std::string& option, const std::string& chosen, const std::string& stem) {
  if (chosen.empty()) fail(Exit::kUsage, option, " is needed with -w any: how many, or names with commas between");
  const std::optional<int64_t> count = count_of_names(chosen);
  if (!count) return split_names(chosen);
  if (*count < 1 || *count > 1000000) fail(Exit::kUsage, option, " ", chosen, ": expected 1 to 1000000, or names");
  std::vector<std::string> names;
  for (int64_t i = 1; i <= *count; ++i) names.push_back(stem + std::to_string(i));
  return names;
}

// The help of -w.
std::string worlds_or_any() {
  std::string list;
  for (const std::string& name : world_names()) list += name + ", ";
  return list + "or any for names of your own";
}

// The plan's environments and tasks: those that were asked for, of all that the world has.
void take_names(const std::string& world, const std::string& envs, const std::string& tasks, SplitPlan& plan) {
  if (world == "any") {
    plan.envs = any_names("--envs", envs, "env");
    plan.tasks = any_names("--tasks", tasks, "task");
    return;
  }
  const std::unique_ptr<World> opened = open_world(world);
  plan.envs = choose_names("--envs", envs, opened->env_names());
  plan.tasks = choose_names("--tasks", tasks, opened->task_names());
}

// What --single gives: a pair, or the environment or the task alone whose name it is.
std::pair<std::string, std::string> find_single(const SplitPlan& plan, const std::string& text) {
  if (text.find(',') != std::string::npos) return split_pair_name(text);
  const auto among = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), text) != names.end();
  };
  const bool env = among(plan.envs), task = among(plan.tasks);
  if (env && task) fail(Exit::kUsage, "--single ", text, ": both an environment and a task");
  if (!env && !task)
    fail(Exit::kUsage, "--single ", text, ": ", quoted(text), " is no environment and no task of this split");
  return env ? std::pair(text, std::string()) : std::pair(std::string(), text);
}

}  // namespace

int matrix_split(int argc, char** argv) {
  SplitPlan plan;
  std::string world = "gridworld", envs, tasks, output_path = "-";
  std::vector<std::string> parts, singles;
  Options options("synpo-matrix split", "[OPTION]... > PAIRS",
                  "Draws which pairs of environments and tasks are seen in training.");
  options.integer('n', "seen", "COUNT", "seen pairs", plan.seen, 0, INT64_MAX)
      .shown_as("36 %: 144 of 400; with --setting 2 or 3 all of P")
      .call(0, "ratio", "R", "seen pairs as a share of all (of P), instead of -n",
            [&](const std::string& text) {
              if (!parse_whole(text, plan.ratio) || !(plan.ratio > 0 && plan.ratio <= 1))
                throw std::invalid_argument("expected a number over 0 and up to 1");
            })
      .integer(0, "cover", "COUNT", "at least so many seen per environment and task", plan.cover, 0, INT64_MAX)
      .shown_as("4, or what -n allows")
      .call(0, "single", "NAME",
            "an environment or a task seen in one pair only, or ENV,TASK: that pair; may be repeated",
            [&](const std::string& text) {
              const std::vector<std::string> names = split_names(text);
              if (names.size() > 2 || std::ranges::find(names, "") != names.end())
                throw std::invalid_argument("expected an environment, a task, or ENV,TASK");
              singles.push_back(text);
            })
      .seed(plan.seed, "seed of the draw", "SEED")
      .text('w', "world", "WORLD", worlds_or_any(), world)
      .suggest(world_kinds())
      .text(0, "envs", "LIST", "environments: how many, or names with commas between [all]", envs)
      .text(0, "tasks", "LIST", "tasks: how many, or names with commas between [all]", tasks)
      .section("Transfer settings")
      .integer(0, "setting", "N", "2 or 3: add the column part with P, Q and rest", plan.setting, 1, 3)
      .integer(0, "p-envs", "COUNT", "the first so many environments belong to P", plan.p_envs, 0, INT64_MAX)
      .shown_as("half")
      .integer(0, "p-tasks", "COUNT", "the first so many tasks belong to P", plan.p_tasks, 0, INT64_MAX)
      .shown_as("half")
      .call(0, "part", "LIST", "write only these parts, as in P or P,Q",
            [&](const std::string& list) {
              parts = split_names(list);
              for (const std::string& part : parts)
                if (part != "P" && part != "Q" && part != "rest") throw std::invalid_argument("expected P, Q or rest");
            })
      .section("Output")
      .text('o', "output", "FILE", "where the pairs go", output_path);
  options.parse(argc, argv);
  if (options.given("seen") && options.given("ratio")) fail(Exit::kUsage, "give either --seen or --ratio");
  if (!parts.empty() && plan.setting == 1)
    fail(Exit::kUsage, "--part ", quoted(parts[0]), ": there are no parts without --setting 2 or 3");
  take_names(world, envs, tasks, plan);
  for (const std::string& single : singles) plan.singles.push_back(find_single(plan, single));

  std::vector<PairRow> rows;
  for (const SplitPair& pair : split_pairs(plan))
    if (parts.empty() || std::find(parts.begin(), parts.end(), pair.part) != parts.end())
      rows.push_back({pair.env, pair.task, pair.seen, pair.part});
  Output output(output_path);
  write_pairs(output, rows);
  output.finish();
  return 0;
}

}  // namespace synpo
