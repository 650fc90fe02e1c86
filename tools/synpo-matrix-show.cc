// synpo-matrix show: the matrix in the terminal.
#include <algorithm>
#include <stdexcept>

#include "draw/terminal.h"
#include "synpo-matrix.h"

namespace synpo {

int matrix_show(int argc, char** argv) {
  std::string method, scheme = "safe", when = "auto", by = "seen", output_path = "-";
  Options options("synpo-matrix show", "[OPTION]... [MATRIX]...",
                  "The matrix in the terminal, in coloured blocks where it has colour: tasks down, environments across, per cent.");
  options.text(0, "method", "NAME", "only the rows of this method", method)
      .call(0, "scheme", "NAME", "safe, purple-red or blue-red [safe]", [&](const std::string& name) { scheme = find_scheme(name).name; })
      .call(0, "by", "KIND", "tell apart seen from unseen pairs, or parts: seen or part [seen]",
            [&](const std::string& kind) {
              if (kind != "seen" && kind != "part") throw std::invalid_argument("expected seen or part");
              by = kind;
            })
      .call(0, "colour", "WHEN", "auto, always or never [auto]",
            [&](const std::string& given) {
              if (given != "auto" && given != "always" && given != "never") throw std::invalid_argument("expected auto, always or never");
              when = given;
            })
      .text('o', "output", "FILE", "where the matrix goes", output_path);
  const HeatTable table = pool_matrix(read_matrices(options.parse(argc, argv, 0, kMostFiles)), method, by == "part");
  Output output(output_path);
  const int fd = output.is_stdout() ? 1 : -1;
  TerminalColour colour = terminal_colour(fd);
  if (when == "never") colour = TerminalColour::kNone;
  // Asked for in so many words, whatever the environment says; 256 colours where it says nothing.
  if (when == "always" && colour == TerminalColour::kNone) colour = std::max(environment_colour(), TerminalColour::k256);
  output.write(terminal_matrix(table, find_scheme(scheme), colour, terminal_width(fd)));
  output.finish();
  return 0;
}

}  // namespace synpo
