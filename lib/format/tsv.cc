#include "format/tsv.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "base/error.h"
#include "base/text.h"
#include "format/kind.h"

namespace synpo {
namespace {

// "invalid UTF-8" or "control character", with its bytes.
std::string name_bad_byte(std::string_view line, size_t at) {
  const size_t length = utf8_length(line, at);
  return (length > 0 ? "control character " : "invalid UTF-8 at byte ") +
         printable(line.substr(at, std::max<size_t>(1, length)));
}

}  // namespace

TsvReader::TsvReader(Input& input, bool growing) : input_(input), growing_(growing) {
  if (!row(columns_)) fail(Exit::kData, input_.name(), ": empty, expected a header line with the names of the columns");
  std::unordered_set<std::string> names;
  for (size_t i = 0; i < columns_.size(); ++i) {
    const std::string where = concat(input_.name(), ": line 1, column ", i + 1, ": ");
    if (columns_[i].starts_with("\xef\xbb\xbf"))
      fail(Exit::kData, where, "found a byte order mark, expected plain UTF-8 without one");
    if (columns_[i].empty()) fail(Exit::kData, where, "found an empty name, expected the name of a column");
    if (!names.insert(columns_[i]).second)
      fail(Exit::kData, where, "the name ", quoted(columns_[i]), " stands there twice");
  }
}

int TsvReader::find(const std::string& column) const {
  const auto it = std::find(columns_.begin(), columns_.end(), column);
  return it == columns_.end() ? -1 : int(it - columns_.begin());
}

int TsvReader::need(const std::string& column) const {
  const int at = find(column);
  if (at >= 0) return at;
  std::string found;
  for (size_t i = 0; i < columns_.size() && i < 8; ++i) found += (i ? ", " : "") + quoted(columns_[i]);
  if (columns_.size() > 8) found += ", ...";
  fail(Exit::kData, input_.name(), ": line 1: no column '", column, "', found ", found,
       columns_.size() == 1 ? another_kind(columns_[0], FileKind::kTable) : "");
}

bool TsvReader::next() { return row(fields_); }

bool TsvReader::row(std::vector<std::string>& fields) {
  std::string line;
  const uint64_t begin_of_line = input_.offset();
  if (!input_.line(line)) return false;
  // A number that was cut off may still be a number.
  const bool cut = input_.offset() - begin_of_line == line.size();
  if (cut && growing_) return false;
  if (cut) input_.bad_line("found no line end, expected LF: was the file cut off?");
  const bool header = &fields == &columns_;
  if (line.ends_with('\r'))
    input_.bad_line("ends in CR LF, expected LF alone: take the CRs out first, for instance with tr -d '\\r'");
  const size_t count = std::count(line.begin(), line.end(), '\t') + 1;
  if (header && count > size_t(kTsvColumns))
    input_.bad_line(concat("found ", count, " columns, expected at most ", kTsvColumns));
  if (const size_t bad = first_bad_byte(line); bad != std::string::npos) {
    const auto column = std::count(line.begin(), line.begin() + bad, '\t') + 1;
    fail(Exit::kData, input_.name(), ": line ", input_.line_number(), ", column ", column, ": found ",
         name_bad_byte(line, bad), ", expected UTF-8 text", header ? another_kind(line, FileKind::kTable) : "");
  }
  if (!header && count != columns_.size()) {
    if (line.empty())
      input_.bad_line(concat("found an empty line, expected ", columns_.size(), " fields as in the header"));
    input_.bad_line(concat("found ", counted(int64_t(count), "field"), ", expected ", columns_.size(),
                           " as in the header (fields are separated by one tab each)"));
  }
  fields.resize(count);
  size_t begin = 0;
  for (size_t i = 0; i < count; ++i) {
    const size_t end = std::min(line.find('\t', begin), line.size());
    fields[i].assign(line, begin, end - begin);
    begin = end + 1;
  }
  return true;
}

const std::string& TsvReader::name(int column, const std::string& expected) const {
  const std::string& found = field(column);
  if (found.empty()) bad(column, expected);
  if (found.size() > kLongestName) bad(column, concat(expected, ", of at most ", kLongestName, " bytes"));
  return found;
}

int64_t TsvReader::integer(int column, int64_t low, int64_t high) const {
  int64_t value = 0;
  if (parse_whole(fields_[column], value) && value >= low && value <= high) return value;
  if (high == std::numeric_limits<int64_t>::max()) bad(column, concat("a whole number, at least ", low));
  bad(column, concat("a whole number from ", low, " to ", high));
}

double TsvReader::real(int column) const {
  double value = 0;
  if (!parse_whole(fields_[column], value) || !std::isfinite(value)) bad(column, "a finite number");
  return value;
}

void TsvReader::bad(int column, const std::string& expected) const {
  fail(Exit::kData, input_.name(), ": line ", line(), ", column ", column + 1, " (", quoted(columns_[column]),
       "): found ", quoted(fields_[column]), ", expected ", expected);
}

void TsvWriter::separate() {
  if (started_) row_ += '\t';
  started_ = true;
}

TsvWriter& TsvWriter::text(std::string_view value) {
  if (first_bad_byte(value) != std::string_view::npos || value.find('\t') != std::string_view::npos)
    fail(Exit::kData, "the name ", quoted(std::string(value)),
         " holds a tab, a line end or bytes that are no text, and cannot stand in a table");
  separate();
  row_ += value;
  return *this;
}

TsvWriter& TsvWriter::whole(int64_t value) {
  separate();
  row_ += std::to_string(value);
  return *this;
}

TsvWriter& TsvWriter::whole(uint64_t value) {
  separate();
  row_ += std::to_string(value);
  return *this;
}

TsvWriter& TsvWriter::real(double value) {
  separate();
  if (std::isnan(value)) {
    row_ += "NA";
    return *this;
  }
  row_ += shortest(value);
  return *this;
}

void TsvWriter::end_row() {
  row_ += '\n';
  output_.write(row_);
  row_.clear();
  started_ = false;
}

}  // namespace synpo
