// synpo-matrix: splits of pairs into seen and unseen, and what success matrices say. A command each in
// synpo-matrix-*.cc.
#include "matrix/matrix.h"

#include <cstdio>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "colour.h"
#include "draw/colour.h"
#include "draw/terminal/terminal.h"
#include "format/matrix.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/merge.h"
#include "stats/matrix/split.h"
#include "stats/report/compare.h"
#include "stats/report/summary.h"

namespace synpo {

namespace {

// The names of subsets on blocks of their colours in a matrix, as dark as their success; none where there is no colour.
PaintName paint_with(TerminalColour colour) {
  if (colour == TerminalColour::kNone) return nullptr;
  return [colour](const SubsetSummary& subset, const std::string& name) {
    const double rate = subset.success.pooled;
    if (!(rate >= 0 && rate <= 1)) return name;
    return ground_code(ramp_colour(subset_ramp(subset.name, find_scheme("safe")), rate), colour) + name + kPlainCode;
  };
}

}  // namespace

int matrix_summary(int argc, char** argv) {
  bool table = false, quiet = false;
  std::string output_path = "-";
  ColourOption colour;
  Options options(
      "synpo-matrix summary", "[OPTION]... [MATRIX]...",
      "Success, reward, length, wrong picks and timeouts over seen and unseen pairs; several runs with mean and sd.");
  options.flag(0, "tsv", "a table for machines", table).flag('q', "quiet", "no notes on stderr", quiet);
  colour.add_to(options);
  options.text('o', "output", "FILE", "where the summary goes", output_path);
  const std::vector<std::string> files = options.parse(argc, argv, 0, kMostFiles);
  if (table && options.given("colour")) fail(Exit::kUsage, "--colour is for text, not for --tsv");
  const std::vector<GroupSummary> groups = summarise(read_matrices(files));
  Output output(output_path);
  if (table)
    write_summary(output, groups);
  else
    output.write(summary_text(groups, paint_with(colour.of(output))));
  output.finish();
  for (const GroupSummary& group : groups)
    for (const std::string& note : group.notes)
      if (!quiet) std::fprintf(stderr, "synpo-matrix: note: %s\n", note.c_str());
  return 0;
}

int matrix_merge(int argc, char** argv) {
  std::string output_path = "-";
  Options options("synpo-matrix merge", "[OPTION]... [MATRIX]... > MATRIX",
                  "Puts matrices of shards and seeds together; refuses to count an episode twice.");
  options.text('o', "output", "FILE", "where the matrix goes", output_path);
  const Matrix matrix = read_matrices(options.parse(argc, argv, 0, kMostFiles));
  Output output(output_path);
  write_matrix(output, matrix);
  output.finish();
  return 0;
}

namespace {

constexpr Advice kOneMethod = {kSeveralMethods, "{}: choose one with --method"};

int run(int argc, char** argv) {
  return run_commands("synpo-matrix", "Splits pairs of environments and tasks, and works on success matrices.",
                      {{"split", "draw the pairs that training sees", matrix_split, {{kSinglePair, "--single {}"}}},
                       {"summary", "rates over seen and unseen pairs", matrix_summary},
                       {"table", "methods x seen/unseen, as text, TSV, Markdown or LaTeX", matrix_table},
                       {"compare",
                        "two methods pair by pair",
                        matrix_compare,
                        {{kOtherStarts, "{}; --any-start compares other start states, too"}}},
                       {"rows", "the tasks, worst first", matrix_rows},
                       {"cols", "the environments, worst first", matrix_cols},
                       {"show", "the matrix in the terminal", matrix_show, {kOneMethod}},
                       {"filter", "some of the rows", matrix_filter},
                       {"wide", "tasks down and environments across, for other programs", matrix_wide, {kOneMethod}},
                       {"merge", "several matrices into one", matrix_merge}},
                      argc, argv);
}

}  // namespace
}  // namespace synpo

int main(int argc, char** argv) { return synpo::run_tool("synpo-matrix", argc, argv, synpo::run); }
