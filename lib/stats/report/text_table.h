// Numbers and tables as text: aligned for a terminal, Markdown, LaTeX.
#pragma once
#include <string>
#include <vector>

#include "stats/interval.h"
#include "stats/matrix/runs.h"

namespace synpo {

enum class TableFormat { kText, kMarkdown, kLatex };

// "3.14"; "-" for NaN.
std::string decimal(double value, int digits);
// A rate in per cent. 100.0 and 0.0 stand there only where all or none succeeded: 0.9999 is 99.9.
std::string percent(double rate, int digits = 1);
// Digits after the point at which the ends of the interval can be told apart: the measure's own, or more. 100.0 and
// 0.0 stand there only where `mean` is all or none.
int range_digits(const Interval& interval, double mean, const MeasureKind& kind);
// "81.2 to 86.0", with that many digits. "-" where there is no interval.
std::string range_text(const Interval& interval, double mean, const MeasureKind& kind);

// "85.0 +- 1.2", of one value "85.0", with at least `digits` of them after the point. Never "100.0 +- 0.0": runs that
// are all alike are "100.0 (3 alike)", and where a value would be rounded to a spread of 0 or to a mean of 100 that it
// isn't, more digits are shown.
std::string spread_text(const MeanSd& over_runs, const MeasureKind& kind, int digits = 0);

// Rows of cells, the header first: the first `left` columns to the left, the others to the right. Text puts two blanks
// between columns; LaTeX is a tabular with the lines of booktabs. "+-" becomes the sign where the format has one, and
// what a format would take as a command is escaped.
std::string table_text(const std::vector<std::vector<std::string>>& rows, TableFormat format = TableFormat::kText,
                       size_t left = 1);

}  // namespace synpo
