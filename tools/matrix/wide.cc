// synpo-matrix wide: the matrix laid out for other programs.
#include <stdexcept>
#include <string>

#include "base/cli/options.h"
#include "base/files/io.h"
#include "format/matrix.h"
#include "matrix/matrix.h"
#include "stats/matrix/filter.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/merge.h"

namespace synpo {

int matrix_wide(int argc, char** argv) {
  std::string method, measure = "success", output_path = "-";
  Options options("synpo-matrix wide", "[OPTION]... [MATRIX]...",
                  "A line per task and a column per environment, for gnuplot, R and spreadsheets; rates from 0 to 1.");
  options.text(0, "method", "NAME", "only the rows of this method", method)
      .call(0, "measure", "NAME", "success, reward, length, wrong, timeouts; episodes, successes, seen [success]",
            [&](const std::string& name) {
              if (!is_wide_measure(name))
                throw std::invalid_argument(
                    "expected success, reward, length, wrong, timeouts, episodes, successes or seen");
              measure = name;
            })
      .text('o', "output", "FILE", "where the table goes", output_path);
  Matrix matrix = read_matrices(options.parse(argc, argv, 0, kMostFiles));
  if (!method.empty()) {
    RowFilter filter;
    filter.methods = {method};
    matrix = filter_rows(matrix, filter);
  }
  const HeatTable table = pool_matrix(matrix);
  Output output(output_path);
  write_wide(output, matrix, table.envs, table.tasks, measure);
  output.finish();
  return 0;
}

}  // namespace synpo
