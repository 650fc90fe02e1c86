#include <algorithm>
#include <functional>

#include "draw/paper.h"
#include "draw/terminal/terminal.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

constexpr size_t kDefaultWidth = 80;

// A cell: twice `mark` on a block of its colour, or twice `plain` where there is no colour.
struct Block {
  Rgb ground;
  char mark, plain;
};

struct BlockPlan {
  std::string name;
  int rows, columns;
  std::function<Block(int row, int column)> block;
  size_t width() const { return 2 * size_t(columns); }
};

// A row, each stretch of one kind under one colour; blanks below the plan.
std::string plan_row(const BlockPlan& plan, int row, TerminalColour colour) {
  if (row >= plan.rows) return std::string(plan.width(), ' ');
  std::string text;
  for (int from = 0, to; from < plan.columns; from = to) {
    const Block first = plan.block(row, from);
    for (to = from + 1; to < plan.columns && plan.block(row, to).plain == first.plain;) ++to;
    const size_t length = 2 * size_t(to - from);
    if (colour == TerminalColour::kNone)
      text += std::string(length, first.plain);
    else
      text += ground_code(first.ground, colour) + std::string(length, first.mark) + kPlainCode;
  }
  return text;
}

std::string terminal_plans(const std::vector<BlockPlan>& plans, const MapStyle& style, TerminalColour colour,
                           int width) {
  const std::string between = "  ";
  std::string text = style.title.empty() ? "" : style.title + "\n\n";
  for (size_t first = 0, end; first < plans.size(); first = end) {
    size_t used = plans[first].width();
    int rows = plans[first].rows;
    for (end = first + 1; end < plans.size() && (style.columns == 0 || end - first < size_t(style.columns)); ++end) {
      used += between.size() + plans[end].width();
      if (used > (width > 0 ? size_t(width) : kDefaultWidth)) break;
      rows = std::max(rows, plans[end].rows);
    }
    if (first > 0) text += '\n';
    for (size_t i = first; i < end; ++i) {
      text += plans[i].name;
      if (i + 1 < end)
        text +=
            std::string(plans[i].width() + between.size() - std::min(plans[i].width(), text_width(plans[i].name)), ' ');
    }
    text += '\n';
    for (int row = 0; row < rows; ++row) {
      for (size_t i = first; i < end; ++i) text += (i > first ? between : "") + plan_row(plans[i], row, colour);
      text.erase(text.find_last_not_of(' ') + 1);
      text += '\n';
    }
  }
  return text;
}

}  // namespace

std::string terminal_maps(const std::vector<Maze>& mazes, const MapStyle& style, TerminalColour colour, int width) {
  std::vector<BlockPlan> plans;
  for (const Maze& maze : mazes)
    plans.push_back(
        {maze.name, kGridSide, kGridSide, [&maze](int row, int column) {
           return maze.wall[row * kGridSide + column] ? Block{kPaperWall, ' ', '#'} : Block{kPaperFloor, ' ', ' '};
         }});
  return terminal_plans(plans, style, colour, width);
}

std::string terminal_kitchens(const std::vector<Kitchen>& kitchens, const MapStyle& style, TerminalColour colour,
                              int width) {
  std::vector<BlockPlan> plans;
  for (const Kitchen& kitchen : kitchens)
    plans.push_back(
        {kitchen.name, kitchen.rows, kitchen.columns, [&kitchen](int row, int column) {
           const char c = kitchen.at(row, column);
           const bool lettered = std::string(kKitchenReceptacleLetters).find(c) != std::string::npos;
           return Block{kitchen_cell_colour(c, paper_floor(kitchen.hash)[0]), lettered ? c : ' ', c == '.' ? ' ' : c};
         }});
  return terminal_plans(plans, style, colour, width);
}

}  // namespace synpo
