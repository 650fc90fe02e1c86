#include "draw/terminal/text_curves.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "base/text.h"

namespace synpo {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TextCurvesStyle small() {
  TextCurvesStyle style;
  style.columns = 16;
  style.rows = 9;
  style.x_title = "x";
  style.y_title = "up";
  return style;
}

TEST(TextCurves, PointsStandWhereTheyBelong) {
  // 5 rows and 12 columns of plot beside labels of 2 columns and the axis.
  const std::vector<std::string> lines = lines_of(text_curves({{"a", {0, 11}, {0, 11}}}, small()));
  ASSERT_EQ(lines.size(), 9u);
  EXPECT_EQ(lines[0], "up");
  EXPECT_EQ(lines[1].substr(0, 4), "11 |");
  EXPECT_EQ(lines[1].back(), '*');
  EXPECT_EQ(lines[1].size(), 16u);
  EXPECT_EQ(lines[5].substr(0, 5), " 0 |*");
  EXPECT_EQ(lines[6], "   +------------");
  EXPECT_EQ(lines[7], "    0    x    11");
  EXPECT_EQ(lines[8], "* a 11");
}

TEST(TextCurves, BrailleHasEightDotsACell) {
  TextCurvesStyle style = small();
  style.braille = true;
  style.x_low = style.y_low = 0;
  style.x_high = style.y_high = 1;
  // A line along the upper edge, and a single dot in the lower left corner.
  std::string full;
  for (int i = 0; i < 12; ++i) full += "\u2809";
  EXPECT_NE(lines_of(text_curves({{"", {0, 1}, {1, 1}}}, style))[1].find(full), std::string::npos);
  const std::vector<std::string> lines = lines_of(text_curves({{"b", {0}, {0}}}, style));
  EXPECT_NE(lines[5].find("\u2502\u2840"), std::string::npos) << lines[5];
}

TEST(TextCurves, SeveralOfBrailleHaveMarksWhereThereIsNoColour) {
  TextCurvesStyle style = small();
  style.braille = true;
  const std::vector<TextCurve> curves = {{"a", {0, 1}, {1, 1}}, {"b", {0, 1}, {0, 0}}};
  const std::vector<std::string> lines = lines_of(text_curves(curves, style));
  EXPECT_NE(lines[1].find("\u2809*\u2809"), std::string::npos) << lines[1];
  EXPECT_NE(lines[5].find("o\u28c0"), std::string::npos) << lines[5];
  EXPECT_EQ(lines.back(), "* a 1   o b 0");
  style.colour = TerminalColour::kTrue;
  EXPECT_EQ(text_curves(curves, style).find('*'), std::string::npos);
}

TEST(TextCurves, LabelsOfAnAxisDifferAndHaveAsManyDigitsAsOneAnother) {
  TextCurvesStyle style = small();
  style.rows = 20;
  style.columns = 40;
  const auto labels = [&](double low, double high) {
    std::vector<std::string> all;
    for (const std::string& line : lines_of(text_curves({{"", {0, 1}, {low, high}}}, style)))
      if (const size_t bar = line.find(" |"); bar != std::string::npos && line.find_first_not_of(' ') < bar)
        all.push_back(line.substr(line.find_first_not_of(' '), bar - line.find_first_not_of(' ')));
    return all;
  };
  using Labels = std::vector<std::string>;
  EXPECT_EQ(labels(0, 100), (Labels{"100", "75", "50", "25", "0"}));
  EXPECT_EQ(labels(1.5922, 1.6217), (Labels{"1.622", "1.614", "1.607", "1.600", "1.592"}));
  EXPECT_EQ(labels(-1, 1), (Labels{"1.0", "0.5", "0.0", "-0.5", "-1.0"}));
  EXPECT_EQ(labels(1000000, 1000040), (Labels{"1.00004M", "1.00003M", "1.00002M", "1.00001M", "1.00000M"}));
  EXPECT_EQ(labels(0, 20000), (Labels{"20k", "15k", "10k", "5k", "0"}));
  EXPECT_EQ(labels(0, 4e-6), (Labels{"4e-06", "3e-06", "2e-06", "1e-06", "0"}));
  style.rows = 9;  // room for the ends alone
  EXPECT_EQ(labels(1.409, 1.752), (Labels{"1.75", "1.41"}));
  style.rows = 20;
  // Ends of the axis across.
  style.x_low = 1000000;
  style.x_high = 1000040;
  const std::string across = lines_of(text_curves({{"", {0, 1}, {0, 1}}}, style))[18];
  EXPECT_EQ(across.substr(across.find('1')), "1M              x         1.00004M") << across;
}

TEST(TextCurves, LongNamesAreShortenedSoThatTheyAndTheirValuesStayDifferent) {
  TextCurvesStyle style = small();
  style.columns = 24;
  const std::string stem = "a_long_name_of_a_run_with_the_seed_";
  const std::vector<std::string> lines =
      lines_of(text_curves({{stem + "1", {0}, {1}}, {stem + "2", {0}, {25}}}, style));
  EXPECT_EQ(lines[lines.size() - 2], "* a_long_na..e_seed_1 1") << lines[lines.size() - 2];
  EXPECT_EQ(lines.back(), "o a_long_na..e_seed_2 25");
}

TEST(TextCurves, NoLineIsWiderThanItsColumns) {
  const std::vector<TextCurve> curves = {
      {"a name that is longer than the terminal is wide", {1, 2, 3}, {1e-7, 5, 123456}},
      {"none", {}, {}},
      {"\xc3\xa9", {1}, {2}}};
  for (const bool braille : {false, true})
    for (int columns = 24; columns < 120; columns += 7) {
      TextCurvesStyle style;
      style.columns = columns;
      style.rows = 20;
      style.braille = braille;
      style.x_title = "updates";
      style.y_title = "a measure";
      for (const std::string& line : lines_of(text_curves(curves, style))) EXPECT_LE(columns_of(line), size_t(columns));
    }
}

TEST(TextCurves, RatesRunFrom0To100AndRangesCut) {
  TextCurvesStyle style = small();
  style.percent = true;
  EXPECT_EQ(lines_of(text_curves({{"", {0, 1}, {50, 60}}}, style))[1].substr(0, 3), "100");
  style.y_high = 55;
  const std::string text = text_curves({{"", {0, 1}, {50, 60}}}, style);
  EXPECT_EQ(lines_of(text)[1].substr(0, 2), "55");
  EXPECT_EQ(lines_of(text).back(), "* 60 %");
}

TEST(TextCurves, WhatIsAlikeOrNothingIsDrawnToo) {
  for (const std::vector<TextCurve>& curves : std::vector<std::vector<TextCurve>>{
           {{"", {3}, {7}}}, {{"", {1, 2}, {0, 0}}}, {{"", {}, {}}}, {{"", {1, 2}, {1e300, -1e300}}}})
    EXPECT_EQ(lines_of(text_curves(curves, small())).size(), 9u);
}

TEST(TextCurves, TheLocaleSaysWhetherThereIsBraille) {
  const auto is_utf8 = [](const char* all, const char* type, const char* lang) {
    setenv("LC_ALL", all, 1);
    setenv("LC_CTYPE", type, 1);
    setenv("LANG", lang, 1);
    return locale_is_utf8();
  };
  EXPECT_TRUE(is_utf8("", "", "en_GB.UTF-8"));
  EXPECT_TRUE(is_utf8("C.utf8", "", ""));
  EXPECT_FALSE(is_utf8("C", "de_DE.UTF-8", "de_DE.UTF-8"));
  EXPECT_FALSE(is_utf8("", "de_DE", "de_DE.UTF-8"));
  EXPECT_FALSE(is_utf8("", "", ""));
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) unsetenv(name);
}

}  // namespace
}  // namespace synpo
