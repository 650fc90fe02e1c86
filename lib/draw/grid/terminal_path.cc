#include "draw/grid/terminal_path.h"

#include "base/error.h"
#include "draw/paper.h"

namespace synpo {

std::string terminal_path(const Film& film, TerminalColour colour) {
  std::string content[kGridCells];
  Rgb ground[kGridCells];
  const bool coloured = colour != TerminalColour::kNone;
  const size_t width = coloured ? 3 : 4;  // numbers keep apart, by colours or by a blank
  for (int cell = 0; cell < kGridCells; ++cell) {
    ground[cell] = film.maze.wall[cell] ? kPaperWall : kPaperFloor;
    content[cell] = film.maze.wall[cell] && !coloured ? std::string(width, '#') : std::string(width, ' ');
  }
  for (int i = 0; i <= film.steps(); ++i) {
    const int cell = film.states[i].now.agent;
    if (i > 0 && film.states[i - 1].now.agent == cell) continue;
    ground[cell] = time_colour(double(i) / film.steps());
    const std::string step = concat(i);
    content[cell] = std::string(width - step.size(), ' ') + step;
  }
  for (int i = 0; i < kTreasures; ++i) {
    const int cell = film.states[0].now.treasures[i];
    ground[cell] = kPaperTreasures[i];
    content[cell] = concat(kTreasureLetters[i], content[cell].substr(1));
  }
  std::string text = film.maze.name + ", task " + film.task.name() + '\n';
  for (int cell = 0; cell < kGridCells; ++cell) {
    text += coloured ? ground_code(ground[cell], colour) + content[cell] + kPlainCode : content[cell];
    if (cell % kGridSide == kGridSide - 1) text += '\n';
  }
  return text + describe(film) + '\n';
}

}  // namespace synpo
