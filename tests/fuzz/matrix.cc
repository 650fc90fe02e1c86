// Success matrices: what was read is written as a matrix that reads the same, and can be merged, summed up and shown.
#include "format/matrix.h"

#include "fuzz.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/merge.h"
#include "stats/report/summary.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::accepts([&] {
    fuzz::Bytes bytes(fuzz::text(data, size));
    const Matrix matrix = read_matrix(bytes.input());
    const auto text = [](const Matrix& of) { return fuzz::written([&](Output& output) { write_matrix(output, of); }); };
    const std::string again = text(matrix);
    fuzz::Bytes written(again);
    fuzz::require(text(read_matrix(written.input())) == again, "what is written reads the same");
    fuzz::accepts([&] { arrange({{"", pool_matrix(matrix)}}, {}, HeatOrder::kMean, HeatOrder::kNatural); });
    const Matrix merged = merge_matrices({{"bytes", matrix}});
    fuzz::require(merge_matrices({{"merged", merged}}).rows.size() == merged.rows.size(), "merging ends");
    summary_text(summarise(merged));
  });
  return 0;
}
