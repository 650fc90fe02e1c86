// The option --colour of whatever writes text that may be coloured.
#pragma once
#include <string>

#include "base/cli/options.h"
#include "base/files/io.h"
#include "draw/terminal/terminal.h"

namespace synpo {

struct ColourOption {
  std::string when = "auto";

  void add_to(Options& options) {
    options.choice(0, "colour", "WHEN", "auto: where the output is a terminal that has colours; always or never", when,
                   {"auto", "always", "never"});
  }
  TerminalColour of(const Output& output) const {
    if (when == "never") return TerminalColour::kNone;
    return when == "always" ? forced_colour() : terminal_colour(output.is_stdout() ? 1 : -1);
  }
};

}  // namespace synpo
