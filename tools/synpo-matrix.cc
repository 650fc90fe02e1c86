// synpo-matrix: splits of pairs into seen and unseen, and what success matrices say.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "base/error.h"
#include "base/io.h"
#include "base/options.h"
#include "format/matrix.h"
#include "format/pairs.h"
#include "stats/merge.h"
#include "stats/summary.h"
#include "world/maze.h"
#include "world/split.h"
#include "world/task.h"

namespace {

using namespace synpo;

constexpr int kMostFiles = 100000;

std::vector<std::string> env_names(const std::string& world) {
  std::vector<std::string> names;
  for (const Maze& maze : open_mazes(world)) names.push_back(maze.name);
  return names;
}

int split(int argc, char** argv) {
  SplitPlan plan;
  std::string world = "gridworld", envs, tasks, parts, output_path = "-";
  int64_t seed = 1, setting = 1;
  double ratio = 0;
  const auto count_into = [](int64_t& value) {
    return [&value](const std::string& text) {
      value = parse_count(text);
      if (value < 0) throw std::invalid_argument("expected a whole number, at least 0");
    };
  };
  const auto add_single = [&](const std::string& text) {
    const std::vector<std::string> names = split_names(text);
    if (names.size() != 2) throw std::invalid_argument("expected ENV,TASK");
    plan.singles.emplace_back(names[0], names[1]);
  };
  Options options("synpo-matrix split", "[OPTION]... >PAIRS", "Draws which pairs of environments and tasks are seen in training.");
  options.call('n', "seen", "COUNT", "seen pairs [36 %: 144 of 400; with --setting 2 or 3 all of P]", count_into(plan.seen))
      .call(0, "ratio", "R", "seen pairs as a share of all (of P), instead of -n",
            [&](const std::string& text) {
              char* end = nullptr;
              ratio = std::strtod(text.c_str(), &end);
              if (text.empty() || *end || !(ratio > 0 && ratio <= 1)) throw std::invalid_argument("expected a number over 0 and up to 1");
            })
      .call(0, "cover", "COUNT", "at least so many seen per environment and task [4, or what -n allows]", count_into(plan.cover))
      .call(0, "single", "ENV,TASK", "the one seen pair of this environment and this task; may be repeated", add_single)
      .integer('s', "seed", "SEED", "seed of the draw", seed, 0, INT64_MAX)
      .text('w', "world", "WORLD", "gridworld, or gridworld:DIR for the mapN.txt of a folder", world)
      .text(0, "envs", "LIST", "environments: how many, or names with commas between [all]", envs)
      .text(0, "tasks", "LIST", "tasks: how many, or names with commas between [all]", tasks)
      .section("Transfer settings")
      .integer(0, "setting", "N", "2 or 3: add the column part with P, Q and rest", setting, 1, 3)
      .call(0, "p-envs", "COUNT", "the first so many environments belong to P [half]", count_into(plan.p_envs))
      .call(0, "p-tasks", "COUNT", "the first so many tasks belong to P [half]", count_into(plan.p_tasks))
      .text(0, "part", "LIST", "write only these parts, as in P or P,Q", parts)
      .section("Output")
      .text('o', "output", "FILE", "where the pairs go", output_path);
  options.parse(argc, argv);
  if (options.given("seen") && options.given("ratio")) fail(Exit::kUsage, "give either --seen or --ratio");
  plan.envs = choose_names("--envs", envs, env_names(world));
  std::vector<std::string> task_names;
  for (const Task& task : grid_tasks()) task_names.push_back(task.name());
  plan.tasks = choose_names("--tasks", tasks, task_names);
  plan.seed = uint64_t(seed);
  plan.setting = int(setting);
  plan.ratio = ratio;

  const std::vector<std::string> wanted = split_names(parts);
  for (const std::string& part : wanted)
    if (!parts.empty() && (setting == 1 || (part != "P" && part != "Q" && part != "rest")))
      fail(Exit::kUsage, "--part ", quoted(part),
           setting == 1 ? ": there are no parts without --setting 2 or 3" : ": expected P, Q or rest");
  std::vector<PairRow> rows;
  for (const SplitPair& pair : split_pairs(plan))
    if (parts.empty() || std::find(wanted.begin(), wanted.end(), pair.part) != wanted.end())
      rows.push_back({pair.env, pair.task, pair.seen, pair.part});
  Output output(output_path);
  write_pairs(output, rows);
  output.finish();
  return 0;
}

Matrix read_all(std::vector<std::string> files) {
  if (files.empty()) files = {"-"};
  std::vector<MatrixSource> sources;
  for (const std::string& file : files) {
    Input input(file);
    sources.push_back({input.name(), read_matrix(input)});
  }
  return merge_matrices(std::move(sources));
}

int summary(int argc, char** argv) {
  bool table = false, quiet = false;
  std::string output_path = "-";
  Options options("synpo-matrix summary", "[OPTION]... [MATRIX]...",
                  "Success, reward, length, wrong picks and timeouts over seen and unseen pairs; several runs with mean and sd.");
  options.flag(0, "tsv", "a table for machines", table)
      .flag('q', "quiet", "no notes on stderr", quiet)
      .text('o', "output", "FILE", "where the summary goes", output_path);
  const std::vector<GroupSummary> groups = summarise(read_all(options.parse(argc, argv, 0, kMostFiles)));
  Output output(output_path);
  if (table)
    write_summary(output, groups);
  else
    output.write(summary_text(groups));
  output.finish();
  for (const GroupSummary& group : groups)
    for (const std::string& note : group.notes)
      if (!quiet) std::fprintf(stderr, "synpo-matrix: note: %s\n", note.c_str());
  return 0;
}

int merge(int argc, char** argv) {
  std::string output_path = "-";
  Options options("synpo-matrix merge", "[OPTION]... [MATRIX]... >MATRIX",
                  "Puts matrices of shards and seeds together; refuses to count an episode twice.");
  options.text('o', "output", "FILE", "where the matrix goes", output_path);
  const Matrix matrix = read_all(options.parse(argc, argv, 0, kMostFiles));
  Output output(output_path);
  write_matrix(output, matrix);
  output.finish();
  return 0;
}

int run(int argc, char** argv) {
  return run_commands("synpo-matrix", "Splits pairs of environments and tasks, and works on success matrices.",
                      {{"split", "draw the pairs that training sees", split},
                       {"summary", "rates over seen and unseen pairs", summary},
                       {"merge", "several matrices into one", merge}},
                      argc, argv);
}

}  // namespace

int main(int argc, char** argv) { return synpo::run_tool("synpo-matrix", argc, argv, run); }
