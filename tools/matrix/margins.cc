// synpo-matrix rows and cols: tasks and environments, the worst first.
#include "stats/report/margins.h"
#include "base/cli/options.h"
#include "matrix/matrix.h"
#include "stats/matrix/merge.h"

namespace synpo {
namespace {

int write(Axis axis, const char* command, const char* purpose, int argc, char** argv) {
  std::string output_path = "-";
  int64_t most = 1000000;
  bool table = false;
  Options options(command, "[OPTION]... [MATRIX]...", purpose);
  options.integer('n', "count", "COUNT", "the so many worst", most, 1, INT64_MAX)
      .shown_as("all")
      .flag(0, "tsv", "a table for machines", table)
      .text('o', "output", "FILE", "where the means go", output_path);
  const std::vector<GroupMargins> groups = margins(read_matrices(options.parse(argc, argv, 0, kMostFiles)), axis);
  Output output(output_path);
  if (table)
    write_margins(output, groups, axis, size_t(most));
  else
    output.write(margins_text(groups, axis, size_t(most)));
  output.finish();
  return 0;
}

}  // namespace

int matrix_rows(int argc, char** argv) {
  return write(Axis::kTasks, "synpo-matrix rows", "Success at each task, over environments and runs, worst first.",
               argc, argv);
}

int matrix_cols(int argc, char** argv) {
  return write(Axis::kEnvs, "synpo-matrix cols", "Success in each environment, over tasks and runs, worst first.", argc,
               argv);
}

}  // namespace synpo
