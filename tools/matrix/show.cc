// synpo-matrix show: the matrix in the terminal.
#include <algorithm>
#include <string>

#include "base/cli/options.h"
#include "base/files/io.h"
#include "draw/colour.h"
#include "draw/terminal/terminal.h"
#include "format/matrix.h"
#include "matrix/matrix.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/merge.h"
#include "world/grid/task.h"

namespace synpo {

int matrix_show(int argc, char** argv) {
  std::string method, scheme = "safe", when = "auto", by = "seen", output_path = "-";
  Options options(
      "synpo-matrix show", "[OPTION]... [MATRIX]...",
      "The matrix in the terminal, in coloured blocks where it has colour: tasks down, environments across, per cent.");
  options.text(0, "method", "NAME", "only the rows of this method", method)
      .call(0, "scheme", "NAME", "safe, purple-red, blue-red or figure8 [safe]",
            [&](const std::string& name) { scheme = find_scheme(name).name; })
      .choice(0, "by", "KIND", "tell apart seen from unseen pairs, or parts: seen or part", by, {"seen", "part"})
      .choice(0, "colour", "WHEN", "auto, always or never", when, {"auto", "always", "never"})
      .text('o', "output", "FILE", "where the matrix goes", output_path);
  const Matrix matrix = read_matrices(options.parse(argc, argv, 0, kMostFiles));
  const HeatFigure figure = arrange({{"", pool_matrix(matrix, method, by == "part")}}, grid_task_names());
  Output output(output_path);
  const int fd = output.is_stdout() ? 1 : -1;
  TerminalColour colour = terminal_colour(fd);
  if (when == "never") colour = TerminalColour::kNone;
  // Asked for in so many words, whatever the environment says; 256 colours where it says nothing.
  if (when == "always" && colour == TerminalColour::kNone)
    colour = std::max(environment_colour(), TerminalColour::k256);
  output.write(terminal_matrix(figure.panels[0].table, find_scheme(scheme), colour, terminal_width(fd)));
  output.finish();
  return 0;
}

}  // namespace synpo
