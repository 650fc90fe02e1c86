// synpo-matrix table: methods against seen and unseen pairs, with means and standard deviations over runs.
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/files/io.h"
#include "format/matrix.h"
#include "matrix/matrix.h"
#include "stats/bootstrap.h"
#include "stats/matrix/merge.h"
#include "stats/matrix/runs.h"
#include "stats/matrix/split.h"
#include "stats/report/method_table.h"
#include "stats/report/text_table.h"

namespace synpo {

int matrix_table(int argc, char** argv) {
  std::string format = "text", output_path = "-";
  std::vector<std::string> subsets = {"seen", "unseen"};
  const MeasureKind* measure = &find_measure("success");
  BootstrapPlan plan;
  bool brief = false, pair_by_pair = false;
  Options options(
      "synpo-matrix table", "[OPTION]... [MATRIX]...",
      "A line per method: mean and sd over runs, interval and interquartile mean, for seen and unseen pairs.");
  options.choice('f', "format", "FORMAT", "text, tsv, markdown or latex", format, {"text", "tsv", "markdown", "latex"})
      .call(0, "subset", "LIST", "which columns, of seen, unseen, new, all, P, Q, rest [seen,unseen]",
            [&](const std::string& list) {
              subsets = split_names(list);
              for (const std::string& name : subsets)
                if (!is_subset(name))
                  throw std::invalid_argument("expected some of seen, unseen, new, all, P, Q, rest");
            })
      .call(0, "measure", "NAME", "success, reward, length, wrong or timeouts [success]",
            [&](const std::string& name) { measure = &find_measure(name); })
      .flag('b', "brief", "mean and sd alone", brief)
      .flag(0, "pair-by-pair", "the interval is a bootstrap's, with runs drawn in each pair on its own", pair_by_pair)
      .integer(0, "samples", "COUNT", "samples of that bootstrap", plan.samples, 100, 1000000)
      .seed(plan.seed, "its seed", "SEED")
      .text('o', "output", "FILE", "where the table goes", output_path);
  const Matrix matrix = read_matrices(options.parse(argc, argv, 0, kMostFiles));
  const MethodTable table = tabulate(matrix, subsets, *measure, pair_by_pair ? std::optional(plan) : std::nullopt);
  Output output(output_path);
  if (format == "tsv")
    write_method_table(output, table);
  else
    output.write(method_table_text(table,
                                   format == "latex"      ? TableFormat::kLatex
                                   : format == "markdown" ? TableFormat::kMarkdown
                                                          : TableFormat::kText,
                                   brief));
  output.finish();
  return 0;
}

}  // namespace synpo
