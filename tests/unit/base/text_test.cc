#include "base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files/file_uses.h"
#include "base/files/io.h"
#include "base/parallel.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Text, AlternativesReadAsASentence) {
  EXPECT_EQ(alternatives({}), "");
  EXPECT_EQ(alternatives({"td"}), "td");
  EXPECT_EQ(alternatives({"td", "q"}), "td or q");
  EXPECT_EQ(alternatives({"td", "q", "ce"}), "td, q or ce");
}

TEST(Text, FirstBadByte) {
  const auto bad = [](std::string_view text) { return int64_t(first_bad_byte(text)); };
  for (const char* good : {"", "a\tb", "\u00e9", "\u20ac", "\U0010ffff", "\uffff"}) EXPECT_EQ(bad(good), -1) << good;
  EXPECT_EQ(bad("ab\n"), 2);
  EXPECT_EQ(bad("\x7f"), 0);
  EXPECT_EQ(bad(std::string_view("a\0", 2)), 1);
  // A lone continuation, a sequence cut off, overlong forms, a surrogate, beyond U+10FFFF.
  for (const char* wrong : {"\x80", "\xc3", "\xe2\x82", "\xc0\xaf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf", "\xed\xa0\x80",
                            "\xf4\x90\x80\x80", "\xff"})
    EXPECT_EQ(bad(std::string("x") + wrong), 1);
}

// C0, DEL, C1, and the marks that turn the direction: of each range its first and last, and what stands beside them.
TEST(Text, PrintableLengthIsZeroForWhatATerminalActsOn) {
  for (const char* no : {"\x01", "\t", "\n", "\x1b", "\x1f", "\x7f", "\xc2\x80", "\xc2\x9b", "\xc2\x9f", "\u061c",
                         "\u200e", "\u200f", "\u202a", "\u202e", "\u2066", "\u2069", "\xff", "\xc2", ""})
    EXPECT_EQ(printable_length(no, 0), 0u) << quoted(no);
  EXPECT_EQ(printable_length(std::string_view("\0", 1), 0), 0u);
  for (const char* yes : {" ", "~", "\u00a0", "\u00e9", "\u061b", "\u061d", "\u200d", "\u2010", "\u2029", "\u202f",
                          "\u2065", "\u206a", "\U0010ffff"})
    EXPECT_EQ(printable_length(yes, 0), std::string_view(yes).size()) << yes;
}

TEST(Text, CharactersHaveTheNumbersOfUnicode) {
  for (const auto& [text, code] : std::initializer_list<std::pair<const char*, uint32_t>>{
           {"A", 0x41}, {"\u00e9", 0xe9}, {"\u20ac", 0x20ac}, {"\U0010ffff", 0x10ffff}}) {
    const Character found = character_at(std::string("x") + text, 1);
    EXPECT_EQ(found.code, code);
    EXPECT_EQ(found.length, std::string_view(text).size());
  }
  EXPECT_EQ(character_at("\xff", 0).length, 0u);
}

TEST(Text, FaultOfName) {
  for (const char* good : {"map1", "Küche", "a b", "-", "R-B"}) EXPECT_EQ(fault_of_name(good), "") << good;
  EXPECT_EQ(fault_of_name(std::string(255, 'x')), "");
  EXPECT_EQ(fault_of_name(std::string(256, 'x')), "found a name of 256 bytes, expected at most 255");
  EXPECT_EQ(fault_of_name(""), "found an empty name, expected one of 1 to 255 bytes");
  EXPECT_EQ(fault_of_name("caf\xe9"), "found invalid UTF-8 at byte 4 of the name (\\xe9), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("a\tb"), "found a control character at byte 2 of the name (\\x09), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("a\nb\xff"), "found a control character at byte 2 of the name (\\x0a), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("a\xc2\x9b"),
            "found a control character at byte 2 of the name (\\xc2\\x9b), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("\x7f"), "found a control character at byte 1 of the name (\\x7f), expected UTF-8 text");
}

TEST(Text, ASlipOfThePenIsFound) {
  const std::vector<std::string> names = {"split", "summary", "table", "rows", "show", "map1", "map3", "map13", "R-B"};
  EXPECT_EQ(did_you_mean("sumary", names), " (did you mean 'summary'?)");
  EXPECT_EQ(did_you_mean("tabel", names), " (did you mean 'table'?)");
  EXPECT_EQ(did_you_mean("Split", names), " (did you mean 'split'?)");
  EXPECT_EQ(did_you_mean("summ", names), " (did you mean 'summary'?)");
  EXPECT_EQ(did_you_mean("ros", names), " (did you mean 'rows'?)");
  EXPECT_EQ(did_you_mean("mpa13", names), " (did you mean 'map13'?)");
  EXPECT_EQ(did_you_mean("r-b", names), " (did you mean 'R-B'?)");
}

TEST(Text, WhatIsNoSlipOfThePenIsNotGuessed) {
  const std::vector<std::string> names = {"split", "summary", "map1", "map3", "map13"};
  EXPECT_EQ(did_you_mean("map2", names), "");  // another number is another thing
  EXPECT_EQ(did_you_mean("nothing", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
  EXPECT_EQ(did_you_mean("s", names), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 's'), names), "");
  EXPECT_EQ(did_you_mean("split", {}), "");
  EXPECT_EQ(did_you_mean("bat", {"cat", "rat", "bar"}), " (did you mean 'cat', 'rat' or 'bar'?)");
  EXPECT_EQ(did_you_mean("bat", {"cat", "rat", "bar", "bag"}), "");
}

TEST(Text, ColumnsOnATerminal) {
  EXPECT_EQ(columns_of("map10"), 5u);
  EXPECT_EQ(columns_of("\u00e9"), 1u);
  EXPECT_EQ(columns_of("e\u0301"), 1u);                   // the accent stands on the letter
  EXPECT_EQ(columns_of("\u73af\u5883"), 4u);              // Chinese
  EXPECT_EQ(columns_of("\U0001f34e"), 2u);                // an apple
  EXPECT_EQ(columns_of("\u05e9\u05dc\u05d5\u05dd"), 4u);  // Hebrew
  EXPECT_EQ(columns_of("\xff"), 1u);
  EXPECT_EQ(columns_of(""), 0u);
}

TEST(Text, CountedNouns) {
  EXPECT_EQ(counted(0, "step"), "0 steps");
  EXPECT_EQ(counted(1, "new task"), "1 new task");
  EXPECT_EQ(counted(2, "step"), "2 steps");
}

TEST(PercentText, IsAllOrNothingOnlyWhereItIsJustThat) {
  EXPECT_EQ(percent_text(0), "0 %");
  EXPECT_EQ(percent_text(1), "100 %");
  EXPECT_EQ(percent_text(0.001), "1 %");
  EXPECT_EQ(percent_text(0.999), "99 %");
  EXPECT_EQ(percent_text(0.625), "63 %");
  EXPECT_EQ(percent_text(std::nan("")), "-");
}

}  // namespace
}  // namespace synpo
