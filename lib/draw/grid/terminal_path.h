// An episode on a terminal: its maze, three or four columns a cell, and at every cell the last step that led there.
#pragma once
#include <string>

#include "draw/grid/film.h"
#include "draw/terminal/terminal.h"

namespace synpo {

// With colours the cells are blocks, darker towards the end; without them walls are ####. Ends with what describe()
// says.
std::string terminal_path(const Film& film, TerminalColour colour);

}  // namespace synpo
