#include "draw/terminal/block_plans.h"

#include <algorithm>
#include <climits>
#include <cstddef>

#include "base/text.h"
#include "draw/shortened.h"

namespace synpo {
namespace {

constexpr size_t kDefaultWidth = 80;

// As wide as its plan, or its name where there is none.
size_t width_of(const BlockPlan& plan) { return plan.rows > 0 ? 2 * size_t(plan.columns) : columns_of(plan.name); }

// Their names, none wider than the narrowest plan.
std::vector<std::string> names_of(const std::vector<BlockPlan>& plans) {
  std::vector<std::string> names;
  int room = INT_MAX;
  for (const BlockPlan& plan : plans) {
    names.push_back(plan.name);
    if (plan.rows > 0) room = std::min(room, 2 * plan.columns);
  }
  return fitted_apart(names, by_columns(), room);
}

// A row, each stretch of one kind under one colour; blanks below the plan.
std::string plan_row(const BlockPlan& plan, int row, TerminalColour colour) {
  if (row >= plan.rows) return std::string(width_of(plan), ' ');
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

}  // namespace

std::string terminal_plans(const std::vector<BlockPlan>& plans, const MapStyle& style, TerminalColour colour,
                           int width) {
  const std::string between = "  ";
  const std::vector<std::string> names = names_of(plans);
  std::string text = style.title.empty() ? "" : style.title + "\n\n";
  for (size_t first = 0, end; first < plans.size(); first = end) {
    size_t used = width_of(plans[first]);
    int rows = plans[first].rows;
    for (end = first + 1; end < plans.size() && (style.columns == 0 || end - first < size_t(style.columns)); ++end) {
      used += between.size() + width_of(plans[end]);
      if (used > (width > 0 ? size_t(width) : kDefaultWidth)) break;
      rows = std::max(rows, plans[end].rows);
    }
    if (first > 0) text += '\n';
    for (size_t i = first; i < end; ++i) {
      text += names[i];
      if (i + 1 < end)
        text +=
            std::string(width_of(plans[i]) + between.size() - std::min(width_of(plans[i]), columns_of(names[i])), ' ');
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

}  // namespace synpo
