// Terminals: the colours that they have, and success matrices as coloured blocks.
#pragma once
#include <string>

#include "base/rgb.h"
#include "draw/colour.h"
#include "stats/matrix/heat_table.h"

namespace synpo {

enum class TerminalColour { kNone, k256, kTrue };  // 24 bits where COLORTERM says so

// The colours of a file descriptor: none where it is no terminal, where TERM is dumb or empty, and where NO_COLOR
// is set and not empty (https://no-color.org).
TerminalColour terminal_colour(int fd);
// As above, but taking it for a terminal.
TerminalColour environment_colour();
// Colours asked for in so many words, whatever the output is and NO_COLOR says: 256 where COLORTERM does not say more.
TerminalColour forced_colour();

// The escape sequence for a block of this colour with readable text on it.
std::string ground_code(Rgb ground, TerminalColour colour);
// The same for text of this colour.
std::string ink_code(Rgb ink, TerminalColour colour);
constexpr char kPlainCode[] = "\033[0m";

// Tasks down, environments across. Rates in per cent; with colours in the ramps of `scheme`, and without a mark after
// the rate for each kind of pairs but the seen ones. 100 and 0 stand there only where all or none succeeded. Where a
// line is wider than `width` columns (0: any width is well) long names of tasks are shortened so that they stay
// different, then coloured cells become smaller and lose their numbers. Ends with the means of the kinds.
std::string terminal_matrix(const HeatTable& table, const Scheme& scheme, TerminalColour colour, int width);

}  // namespace synpo
