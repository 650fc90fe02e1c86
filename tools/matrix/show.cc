// synpo-matrix show: the matrix in the terminal.
#include <string>

#include "base/cli/options.h"
#include "base/cli/screen.h"
#include "base/files/io.h"
#include "colour.h"
#include "draw/colour.h"
#include "draw/terminal/terminal.h"
#include "format/matrix.h"
#include "matrix/matrix.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/merge.h"
#include "world/grid/task.h"

namespace synpo {

int matrix_show(int argc, char** argv) {
  std::string method, scheme = "safe", by = "seen", output_path = "-";
  ColourOption colour;
  Options options(
      "synpo-matrix show", "[OPTION]... [MATRIX]...",
      "The matrix in the terminal, in coloured blocks where it has colour: tasks down, environments across, per cent.");
  options.text(0, "method", "NAME", "only the rows of this method", method)
      .call(0, "scheme", "NAME", "safe, purple-red, blue-red or figure8 [safe]",
            [&](const std::string& name) { scheme = find_scheme(name).name; })
      .suggest(scheme_names())
      .choice(0, "by", "KIND", "tell apart seen from unseen pairs, or parts: seen or part", by, {"seen", "part"});
  colour.add_to(options);
  options.text('o', "output", "FILE", "where the matrix goes", output_path);
  const Matrix matrix = read_matrices(options.parse(argc, argv, 0, kMostFiles), true);
  const HeatFigure figure = arrange({{"", pool_matrix(matrix, method, by == "part")}}, grid_task_names());
  Output output(output_path);
  const int width = screen_size(output.is_stdout() ? 1 : -1).columns;
  output.write(terminal_matrix(figure.panels[0].table, find_scheme(scheme), colour.of(output), width));
  output.finish();
  return 0;
}

}  // namespace synpo
