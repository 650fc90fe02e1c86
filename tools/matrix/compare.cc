// synpo-matrix compare: two methods, or two trainings of one, pair by pair.
#include "stats/report/compare.h"
#include "base/cli/options.h"
#include "base/error.h"
#include "matrix/matrix.h"

namespace synpo {

int matrix_compare(int argc, char** argv) {
  std::string output_path = "-";
  int64_t most = 10, unused_samples = 2000, unused_seed = 1;
  bool any_start = false, table = false;
  Options options("synpo-matrix compare", "[OPTION]... A B",
                  "What B does better and worse than A, pair by pair on the start states that both were given.");
  options.integer('n', "count", "COUNT", "list so many of the pairs that changed most", most, 0, 1000000)
      .flag(0, "any-start", "compare pairs whose start states differ, too", any_start)
      .flag(0, "tsv", "a table for machines, of all pairs", table);
  // Nothing is drawn, but scripts may name a seed.
  options.integer(0, "samples", "COUNT", "has no effect: nothing is drawn", unused_samples, 100, 1000000)
      .integer('s', "seed", "SEED", "has no effect either", unused_seed, 0, INT64_MAX);
  options.text('o', "output", "FILE", "where the comparison goes", output_path);
  const std::vector<std::string> files = options.parse(argc, argv, 2, 2);
  if (files[0] == "-" && files[1] == "-") fail(Exit::kUsage, "A and B cannot both be standard input");
  const MatrixSource a{files[0] == "-" ? "standard input" : files[0], read_matrices({files[0]})};
  const MatrixSource b{files[1] == "-" ? "standard input" : files[1], read_matrices({files[1]})};
  const Comparison comparison = compare(a, b, any_start);
  Output output(output_path);
  if (table)
    write_comparison(output, comparison);
  else
    output.write(comparison_text(comparison, size_t(most)));
  output.finish();
  return 0;
}

}  // namespace synpo
