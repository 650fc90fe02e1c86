// Tab-separated tables with one header line: UTF-8, no quoting, columns in any order.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/io.h"

namespace synpo {

constexpr int kTsvColumns = 1000;  // a table with more columns is refused

// Reads a table row by row. Every message names the input, the line and the column.
class TsvReader {
 public:
  // Reads the header. Throws kData for an empty input, a repeated or empty column name, more than kTsvColumns columns,
  // and, here as in every row, for CR LF line ends, a last line without LF, control characters or invalid UTF-8.
  // Of a table that is `growing`, a last line without LF is passed over: it is still being written.
  explicit TsvReader(Input& input, bool growing = false);

  const std::vector<std::string>& columns() const { return columns_; }
  // Position of a column, or -1.
  int find(const std::string& column) const;
  // Position of a column that must be there (kData when it is not).
  int need(const std::string& column) const;
  // The next row; false at the end. A row with another number of fields than the header is kData.
  bool next();
  const std::string& field(int column) const { return fields_[column]; }
  // The field where a name stands: not empty, and not too long (base/text.h). `expected` says whose name it is.
  const std::string& name(int column, const std::string& expected) const;
  // The field as a whole number in [low, high], or as a finite real number.
  int64_t integer(int column, int64_t low, int64_t high) const;
  double real(int column) const;
  // Throws kData: "name: line N, column C ('seen'): found 'text', expected ...".
  [[noreturn]] void bad(int column, const std::string& expected) const;
  // Throws kData: "name: line N: message".
  [[noreturn]] void bad_row(const std::string& message) const { input_.bad_line(message); }
  uint64_t line() const { return input_.line_number(); }

 private:
  bool row(std::vector<std::string>& fields);
  Input& input_;
  bool growing_;
  std::vector<std::string> columns_, fields_;
};

// Writes a table field by field; the header is a row like any other.
class TsvWriter {
 public:
  explicit TsvWriter(Output& output) : output_(output) {}
  // Throws kData for text that cannot stand in a table: tabs, line ends, other control characters, invalid UTF-8.
  TsvWriter& text(std::string_view value);
  TsvWriter& whole(int64_t value);
  TsvWriter& whole(uint64_t value);
  // The shortest decimal number that reads back as the same double; "NA" for NaN.
  TsvWriter& real(double value);
  void end_row();

 private:
  void separate();
  Output& output_;
  std::string row_;
  bool started_ = false;
};

}  // namespace synpo
