#include "stats/report/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "base/text.h"

namespace synpo {
namespace {

// A character of a cell in a tabular. In TeX's first encoding | < > " stand for others, two hyphens are a dash, and
// what stands next to the end of a row may be taken for its argument.
std::string latex_escaped(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '|':
      return "\\textbar{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '"':
      return "{''}";
    case '`':
      return "\\textasciigrave{}";
    case '~':
    case '^':
      return concat('\\', c, "{}");
    case '[':
    case ']':
    case '*':
      return concat('{', c, '}');
    default:
      return std::string("&%$#_{}").find(c) != std::string::npos ? concat('\\', c) : std::string(1, c);
  }
}

std::string escaped(const std::string& cell, TableFormat format) {
  std::string out;
  for (size_t i = 0; i < cell.size(); ++i) {
    const char c = cell[i];
    const bool pm = c == '+' && i + 1 < cell.size() && cell[i + 1] == '-';
    if (pm) {
      out += format == TableFormat::kLatex ? "$\\pm$" : "\xc2\xb1";
      ++i;
    } else if (format == TableFormat::kMarkdown) {
      if (std::string("|\\*_`<[&~$").find(c) != std::string::npos) out += '\\';
      out += c;
    } else if (cell.compare(i, 2, "--") == 0) {
      out += "-{}";
    } else {
      out += latex_escaped(c);
    }
  }
  return out;
}

constexpr int kMoreDigits = 6;  // after the point, at most, where a measure's own say too little

// An end of an interval. That of a rate is 100 or 0 only where all or none succeeded, which the mean tells.
std::string end_text(double end, double mean, const MeasureKind& kind, int digits) {
  if (!kind.rate) return decimal(end, digits);
  const double step = std::pow(10, -digits) / 100;
  if (mean > 0 && end < step) return percent(step, digits);
  if (mean < 1 && end > 1 - step) return percent(1 - step, digits);
  return percent(end, digits);
}

std::string latex(const std::vector<std::vector<std::string>>& rows, size_t left) {
  std::string text = "\\begin{tabular}{";
  for (size_t i = 0; i < rows[0].size(); ++i) text += i < left ? 'l' : 'r';
  text += "}\n\\toprule\n";
  for (size_t r = 0; r < rows.size(); ++r) {
    for (size_t i = 0; i < rows[r].size(); ++i) text += (i ? " & " : "") + escaped(rows[r][i], TableFormat::kLatex);
    text += r == 0 ? " \\\\\n\\midrule\n" : " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace

std::string decimal(double value, int digits) {
  if (std::isnan(value)) return "-";
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  const bool zero = std::string(text).find_first_of("123456789") == std::string::npos;
  return zero && text[0] == '-' ? text + 1 : text;
}

std::string percent(double rate, int digits) {
  const double step = std::pow(10, -digits);
  if (rate > 0 && rate < 1) return decimal(std::clamp(rate * 100, step, 100 - step), digits);
  return decimal(rate * 100, digits);
}

int range_digits(const Interval& interval, double mean, const MeasureKind& kind) {
  if (std::isnan(interval.low) || interval.low == interval.high) return kind.digits;
  int digits = kind.digits;
  while (digits < kind.digits + kMoreDigits &&
         end_text(interval.low, mean, kind, digits) == end_text(interval.high, mean, kind, digits))
    ++digits;
  return digits;
}

std::string range_text(const Interval& interval, double mean, const MeasureKind& kind) {
  if (std::isnan(interval.low)) return "-";
  const int digits = range_digits(interval, mean, kind);
  return end_text(interval.low, mean, kind, digits) + " to " + end_text(interval.high, mean, kind, digits);
}

std::string spread_text(const MeanSd& over_runs, const MeasureKind& kind, int digits) {
  digits = std::max(digits, kind.digits);
  const double mean = over_runs.mean * kind.scale(), sd = over_runs.sd * kind.scale();
  std::string one = kind.rate ? percent(over_runs.mean, digits) : decimal(mean, digits);
  if (std::isnan(sd)) return one;
  if (alike(over_runs)) return concat(one, " (", over_runs.count, " alike)");
  std::string shown_mean, shown_sd;
  for (const int most = digits + kMoreDigits; digits <= most; ++digits) {
    shown_mean = decimal(mean, digits);
    shown_sd = decimal(sd, digits);
    const double value = std::atof(shown_mean.c_str());
    if (std::atof(shown_sd.c_str()) > 0 && !(kind.rate && (value == 0 || value == 100))) break;
  }
  return shown_mean + " +- " + shown_sd;
}

std::string table_text(const std::vector<std::vector<std::string>>& rows, TableFormat format, size_t left) {
  if (format == TableFormat::kLatex) return latex(rows, left);
  const bool markdown = format == TableFormat::kMarkdown;
  std::vector<std::vector<std::string>> cells = rows;
  std::vector<size_t> widths(rows[0].size(), markdown ? 3 : 0);
  for (auto& row : cells) {
    for (size_t i = 0; i < row.size(); ++i) {
      row[i] = markdown ? escaped(row[i], format) : printable(row[i]);
      widths[i] = std::max(widths[i], columns_of(row[i]));
    }
  }
  std::string text;
  for (size_t r = 0; r < cells.size(); ++r) {
    std::string line;
    for (size_t i = 0; i < cells[r].size(); ++i) {
      const std::string blanks(widths[i] - columns_of(cells[r][i]), ' ');
      line += markdown ? (i ? " " : "| ") : i ? "  " : "";
      line += i < left ? cells[r][i] + blanks : blanks + cells[r][i];
      if (markdown) line += " |";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    if (!markdown || r > 0) continue;
    for (size_t i = 0; i < widths.size(); ++i)
      text += (i ? " " : "| ") + std::string(widths[i] - 1, '-') + (i < left ? "- |" : ": |");
    text += '\n';
  }
  return text;
}

}  // namespace synpo
