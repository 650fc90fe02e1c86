#include "format/tsv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

// Reads all of a table; "a|b" per row.
std::string rows_of(const std::string& text) {
  return read_text(text, [](Input& input) {
    TsvReader reader(input);
    std::string rows;
    while (reader.next()) {
      for (size_t i = 0; i < reader.columns().size(); ++i) rows += (i ? "|" : "") + reader.field(int(i));
      rows += "\n";
    }
    return rows;
  });
}

std::string refused(const std::string& text) {
  return thrown([&] { rows_of(text); });
}

TEST(Tsv, ReadsFieldsAndFindsColumns) {
  EXPECT_EQ(rows_of("a\tb\n1\t2\n\t\n\xc3\xa9 \xf0\x9f\x98\x80\t'\"\n"), "1|2\n|\n\xc3\xa9 \xf0\x9f\x98\x80|'\"\n");
  read_text("a\tb\n", [](Input& input) {
    TsvReader reader(input);
    EXPECT_EQ(reader.find("b"), 1);
    EXPECT_EQ(reader.find("c"), -1);
    EXPECT_EQ(thrown([&] { reader.need("c"); }), "65 IN: line 1: no column 'c', found 'a', 'b'");
    return 0;
  });
  for (const char* more : {"", "\ti"})
    read_text(concat("a\tb\tc\td\te\tf\tg\th", more, "\n"), [&](Input& input) {
      TsvReader reader(input);
      EXPECT_EQ(
          thrown([&] { reader.need("x"); }),
          concat("65 IN: line 1: no column 'x', found 'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'", *more ? ", ..." : ""));
      return 0;
    });
}

TEST(Tsv, RefusesWhatIsNoTable) {
  EXPECT_EQ(refused(""), "65 IN: empty, expected a header line with the names of the columns");
  EXPECT_EQ(refused("\n"), "65 IN: line 1, column 1: found an empty name, expected the name of a column");
  EXPECT_EQ(refused("a\t\tb\n"), "65 IN: line 1, column 2: found an empty name, expected the name of a column");
  EXPECT_EQ(refused("a\tb\ta\n"), "65 IN: line 1, column 3: the name 'a' stands there twice");
  EXPECT_EQ(refused("\xef\xbb\xbf"
                    "a\n"),
            "65 IN: line 1, column 1: found a byte order mark, expected plain UTF-8 without one");
  EXPECT_EQ(refused("a\tb\r\n1\t2\r\n"),
            "65 IN: line 1: ends in CR LF, expected LF alone: take the CRs out first, for instance with tr -d '\\r'");
  EXPECT_EQ(refused("a\tb\n1\t2\r\n"),
            "65 IN: line 2: ends in CR LF, expected LF alone: take the CRs out first, for instance with tr -d '\\r'");
  EXPECT_EQ(refused("a\tb\n1\t2\n3\t45"), "65 IN: line 3: found no line end, expected LF: was the file cut off?");
  EXPECT_EQ(refused("a\tb\n1\n"),
            "65 IN: line 2: found 1 field, expected 2 as in the header (fields are separated by one tab each)");
  EXPECT_EQ(refused("a\tb\n1\t2\t3\n"),
            "65 IN: line 2: found 3 fields, expected 2 as in the header (fields are separated by one tab each)");
  EXPECT_EQ(refused("a\tb\n1\t2\n\n"), "65 IN: line 3: found an empty line, expected 2 fields as in the header");
}

TEST(Tsv, RefusesBytesThatAreNoText) {
  for (const char* bad : {"\xff", "\x80", "\xc0\x80", "\xc3", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                          "\xf0\x80\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82"})
    EXPECT_TRUE(refused(std::string("a\tb\n1\tx") + bad + "\n")
                    .starts_with("65 IN: line 2, column 2: found invalid UTF-8 at byte \\x"))
        << bad;
  EXPECT_EQ(refused(std::string("a\tb\n\0\t2\n", 8)),
            "65 IN: line 2, column 1: found control character \\x00, expected UTF-8 text");
  EXPECT_EQ(refused("a\tb\n1\t\x1b[31m\n"),
            "65 IN: line 2, column 2: found control character \\x1b, expected UTF-8 text");
  EXPECT_EQ(refused("a\tb\n1\tx\xc2\x9b\n"),
            "65 IN: line 2, column 2: found control character \\xc2\\x9b, expected UTF-8 text");
}

TEST(Tsv, RefusesAMillionColumns) {
  std::string header = "c0";
  for (int i = 1; i < 1000000; ++i) header += "\tc" + std::to_string(i);
  EXPECT_EQ(refused(header + "\n"), "65 IN: line 1: found 1000000 columns, expected at most 1000");
}

std::string number_refused(const std::string& field, bool real) {
  return thrown([&] {
    read_text("a\tn\nx\t" + field + "\n", [&](Input& input) {
      TsvReader reader(input);
      reader.next();
      real ? reader.real(1) : double(reader.integer(1, 0, 99));
      return 0;
    });
  });
}

TEST(Tsv, RefusesWhatIsNoNumber) {
  for (const char* field : {"", "-1", "100", "1.0", "1e1", " 1", "1 ", "+1", "0x1", "99999999999999999999", "one"})
    EXPECT_EQ(number_refused(field, false), std::string("65 IN: line 2, column 2 ('n'): found '") + field +
                                                "', expected a whole number from 0 to 99");
  for (const char* field : {"", "nan", "NaN", "inf", "-inf", "1e999", "1,5", "0x1p3", " 1", "NA"})
    EXPECT_EQ(number_refused(field, true),
              std::string("65 IN: line 2, column 2 ('n'): found '") + field + "', expected a finite number");
  EXPECT_EQ(number_refused("99", false), "nothing thrown");
  EXPECT_EQ(number_refused("-1.5e-3", true), "nothing thrown");
}

TEST(Tsv, NumbersReadBackAsTheSame) {
  const double values[] = {
      0.1, -0.0, 1.0 / 3, 978.37, 1e15, 5e-324, std::numeric_limits<double>::max(), 123456789.123456789};
  const std::string text = written([&](Output& output) {
    TsvWriter writer(output);
    writer.text("r").text("i").text("u").end_row();
    for (double value : values)
      writer.real(value)
          .whole(std::numeric_limits<int64_t>::min())
          .whole(std::numeric_limits<uint64_t>::max())
          .end_row();
  });
  read_text(text, [&](Input& input) {
    TsvReader reader(input);
    for (double value : values) {
      EXPECT_TRUE(reader.next());
      EXPECT_EQ(reader.real(0), value);
      EXPECT_EQ(std::signbit(reader.real(0)), std::signbit(value));
      EXPECT_EQ(reader.integer(1, std::numeric_limits<int64_t>::min(), 0), std::numeric_limits<int64_t>::min());
      EXPECT_EQ(reader.field(2), "18446744073709551615");
    }
    EXPECT_FALSE(reader.next());
    return 0;
  });
}

TEST(Tsv, WriterRefusesNamesThatWouldBreakTheTable) {
  for (const char* name : {"a\tb", "a\nb", "a\rb", "a\xff"})
    EXPECT_TRUE(thrown([&] {
                  written([&](Output& output) { TsvWriter(output).text(name); });
                }).starts_with("65 the name 'a\\x"))
        << name;
  EXPECT_EQ(thrown([] { written([](Output& output) { TsvWriter(output).text("a\tb"); }); }),
            "65 the name 'a\\x09b' holds a tab, a line end or bytes that are no text, and cannot stand in a table");
}

}  // namespace
}  // namespace synpo
