// Success matrices for tests.
#pragma once
#include <string>
#include <vector>

#include "stats/matrix/heat_table.h"
#include "world/grid/task.h"

namespace synpo {

inline MatrixRow matrix_row(const std::string& env, const std::string& task, bool seen, int64_t successes,
                            int64_t episodes = 100) {
  MatrixRow row;
  row.method = "synpo";
  row.run = "00000000000000aa";
  row.env = env;
  row.task = task;
  row.seen = seen;
  row.episodes = episodes;
  row.successes = successes;
  return row;
}

// Every pair of so many environments and tasks.
inline Matrix square(int side, const std::string& env_stem = "map", const std::string& task_stem = "task") {
  Matrix matrix;
  for (int task = 1; task <= side; ++task)
    for (int env = 1; env <= side; ++env)
      matrix.rows.push_back(matrix_row(env_stem + std::to_string(env), task_stem + std::to_string(task),
                                       (env + task) % 3 == 0, (env * 37 + task * 11) % 101));
  return matrix;
}

struct HeatPair {
  const char *env, *task;
  int64_t successes;  // of 100
  bool seen = true;
};

inline HeatTable heat_table(const std::vector<HeatPair>& pairs) {
  Matrix matrix;
  for (const HeatPair& pair : pairs) matrix.rows.push_back(matrix_row(pair.env, pair.task, pair.seen, pair.successes));
  return pool_matrix(matrix);
}

inline HeatFigure arranged(const HeatTable& table, HeatOrder tasks = HeatOrder::kPaper,
                           HeatOrder envs = HeatOrder::kPaper) {
  return arrange({{"", table}}, grid_task_names(), tasks, envs);
}

}  // namespace synpo
