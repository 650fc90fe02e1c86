#include "format/pairs.h"

#include <algorithm>
#include <unordered_map>

#include "base/error.h"
#include "format/tsv.h"

namespace synpo {
namespace {

constexpr size_t kMaxRows = 1000000;

}  // namespace

std::vector<PairRow> read_pairs(Input& input) {
  TsvReader reader(input);
  const int env = reader.need("env"), task = reader.need("task"), seen = reader.find("seen"),
            part = reader.find("part");
  std::vector<PairRow> rows;
  std::unordered_map<std::string, uint64_t> line_of;
  while (reader.next()) {
    if (rows.size() == kMaxRows) input.bad_line(concat("more than ", kMaxRows, " rows"));
    PairRow row;
    row.env = reader.name(env, "the name of an environment");
    row.task = reader.name(task, "the name of a task");
    if (seen >= 0) row.seen = reader.integer(seen, 0, 1) == 1;
    if (part >= 0) {
      row.part = reader.field(part);
      if (!row.part.empty() && row.part != "P" && row.part != "Q" && row.part != "rest")
        reader.bad(part, "P, Q, rest or nothing");
    }
    const auto [it, fresh] = line_of.try_emplace(row.env + '\t' + row.task, reader.line());
    if (!fresh)
      input.bad_line(
          concat("pair ", quoted(row.env), ", ", quoted(row.task), " stands in line ", it->second, " already"));
    row.line = reader.line();
    rows.push_back(std::move(row));
  }
  if (rows.empty()) fail(Exit::kData, input.name(), ": line 1: found a header and no row, expected at least one pair");
  return rows;
}

void write_pairs(Output& output, const std::vector<PairRow>& rows) {
  const bool parts = std::any_of(rows.begin(), rows.end(), [](const PairRow& row) { return !row.part.empty(); });
  TsvWriter writer(output);
  writer.text("env").text("task").text("seen");
  if (parts) writer.text("part");
  writer.end_row();
  for (const PairRow& row : rows) {
    writer.text(row.env).text(row.task).whole(int64_t{row.seen});
    if (parts) writer.text(row.part);
    writer.end_row();
  }
}

}  // namespace synpo
