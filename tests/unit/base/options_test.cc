#include "base/cli/options.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

struct Settings {
  bool flag = false, toggle = false, kept = true;
  int64_t count = 7;
  int small = 3;
  double part = 0.5;
  std::string name = "none", colour = "red", called;
  std::vector<std::string> operands;
  bool count_given = false;
};

Settings parsed(std::vector<std::string> arguments, int least = 0, int most = 0) {
  Settings s;
  Options options("tool", "[OPTION]...", "A tool.");
  options.flag('f', "flag", "a flag", s.flag)
      .section("More")
      .toggle("toggle", "on or off", s.toggle)
      .toggle("keep", "on at first", s.kept)
      .integer('n', "count", "N", "a count", s.count, 0, 1000000)
      .integer(0, "small", "N", "a small count", s.small, -5, 5)
      .real(0, "part", "P", "a part", s.part, 0, 1)
      .text('o', "output", "FILE", "a name", s.name)
      .choice(0, "colour", "NAME", "a colour", s.colour, {"red", "green", "blue"})
      .call(0, "call", "X", "a function", [&](const std::string& text) {
        if (text == "bad") throw std::invalid_argument("expected good");
        s.called = text;
      });
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  s.operands = options.parse(int(argv.size()) - 1, argv.data(), least, most);
  s.count_given = options.given("count");
  return s;
}

std::string wrong_usage(const std::vector<std::string>& arguments, int least = 0, int most = 0) {
  return thrown([&] { parsed(arguments, least, most); });
}

TEST(Options, SetValues) {
  const Settings none = parsed({});
  EXPECT_EQ(none.count, 7);
  EXPECT_FALSE(none.count_given);
  const Settings s =
      parsed({"-f", "x", "-n", "2e4", "--part=0.25", "-oa b", "--call", "good", "--colour", "blue", "--", "-y"}, 1, 2);
  EXPECT_TRUE(s.flag);
  EXPECT_EQ(s.count, 20000);
  EXPECT_TRUE(s.count_given);
  EXPECT_EQ(s.part, 0.25);
  EXPECT_EQ(s.name, "a b");
  EXPECT_EQ(s.called, "good");
  EXPECT_EQ(none.colour, "red");
  EXPECT_EQ(s.colour, "blue");
  EXPECT_EQ(s.operands, (std::vector<std::string>{"x", "-y"}));
}

TEST(Options, AreReadAsGetoptLongDoes) {
  const Settings together = parsed({"-fn5"});
  EXPECT_TRUE(together.flag);
  EXPECT_EQ(together.count, 5);
  EXPECT_EQ(parsed({"--small", "-2"}).small, -2);
  EXPECT_EQ(parsed({"-o", "--"}).name, "--");
  EXPECT_EQ(parsed({"--coun", "4"}).count, 4);
  EXPECT_EQ(parsed({"--cou=4"}).count, 4);
  EXPECT_EQ(parsed({"-"}, 0, 1).operands, (std::vector<std::string>{"-"}));
  EXPECT_EQ(parsed({"a", "-f", "b", "--", "-f"}, 0, 3).operands, (std::vector<std::string>{"a", "b", "-f"}));
}

TEST(Options, AToggleIsOnOffOrTheOlderOneOrZero) {
  EXPECT_FALSE(parsed({}).toggle);
  EXPECT_TRUE(parsed({}).kept);
  for (const std::vector<std::string>& on :
       std::vector<std::vector<std::string>>{{"--toggle"}, {"--toggle", "1"}, {"--toggle=1"}, {"--no-toggle", "--tog"}})
    EXPECT_TRUE(parsed(on).toggle);
  for (const std::vector<std::string>& off :
       std::vector<std::vector<std::string>>{{"--no-keep"}, {"--keep", "0"}, {"--keep=0"}, {"--keep", "--no-k"}})
    EXPECT_FALSE(parsed(off).kept);
  // What is no number is not its argument.
  const Settings s = parsed({"--toggle", "x", "--no-keep", "1"}, 0, 2);
  EXPECT_TRUE(s.toggle);
  EXPECT_FALSE(s.kept);
  EXPECT_EQ(s.operands, (std::vector<std::string>{"x", "1"}));
}

TEST(Options, AnEmptyArgumentIsNone) {
  const std::string help = "; try 'tool --help'";
  for (const char* option : {"--output=", "-o"}) {
    std::vector<std::string> arguments = {option};
    if (arguments[0] == "-o") arguments.push_back("");
    EXPECT_EQ(wrong_usage(arguments), "64 option --output: found '', expected FILE" + help);
  }
  EXPECT_EQ(wrong_usage({"--call", ""}), "64 option --call: found '', expected X" + help);
  EXPECT_EQ(wrong_usage({"--colour", ""}), "64 option --colour: found '', expected red, green or blue" + help);
  EXPECT_EQ(wrong_usage({"--count", ""}),
            "64 option --count: found '', expected a whole number from 0 to 1000000" + help);
  EXPECT_EQ(wrong_usage({"--keep="}), "64 option --keep: found '', expected 0 or 1" + help);
}

TEST(Options, WrongUsageIs64) {
  const std::string help = "; try 'tool --help'";
  EXPECT_EQ(wrong_usage({"-x"}), "64 unknown option -x" + help);
  EXPECT_EQ(wrong_usage({"--nothing"}), "64 unknown option '--nothing'" + help);
  EXPECT_EQ(wrong_usage({"--nothing=at-all"}), "64 unknown option '--nothing'" + help);
  EXPECT_EQ(wrong_usage({"--c", "x"}), "64 ambiguous option '--c': --count, --colour or --call" + help);
  EXPECT_EQ(wrong_usage({"--no-"}), "64 ambiguous option '--no-': --no-toggle or --no-keep" + help);
  EXPECT_EQ(wrong_usage({"-n"}), "64 option -n needs an argument" + help);
  EXPECT_EQ(wrong_usage({"--count"}), "64 option --count needs an argument" + help);
  EXPECT_EQ(wrong_usage({"-n", "1000001"}),
            "64 option --count: found '1000001', expected a whole number from 0 to 1000000" + help);
  EXPECT_EQ(wrong_usage({"-n", "ten"}),
            "64 option --count: found 'ten', expected a whole number from 0 to 1000000" + help);
  EXPECT_EQ(wrong_usage({"--part", "nan"}), "64 option --part: found 'nan', expected a number from 0 to 1" + help);
  EXPECT_EQ(wrong_usage({"--part", "1.5"}), "64 option --part: found '1.5', expected a number from 0 to 1" + help);
  EXPECT_EQ(wrong_usage({"--small=6"}), "64 option --small: found '6', expected a whole number from -5 to 5" + help);
  EXPECT_EQ(wrong_usage({"--call", "bad"}), "64 option --call: found 'bad', expected good" + help);
  EXPECT_EQ(wrong_usage({"--colour", "grey"}), "64 option --colour: found 'grey', expected red, green or blue" + help);
  EXPECT_EQ(wrong_usage({"--flag=1"}), "64 option --flag takes no value, found '1'" + help);
  EXPECT_EQ(wrong_usage({"-f=1"}), "64 option -f takes no value, found '1'" + help);
  EXPECT_EQ(wrong_usage({"--no-keep=1"}), "64 option --no-keep takes no value, found '1'" + help);
  EXPECT_EQ(wrong_usage({"--keep=yes"}), "64 option --keep: found 'yes', expected 0 or 1" + help);
  EXPECT_EQ(wrong_usage({"--keep", "2"}), "64 option --keep: found '2', expected 0 or 1" + help);
  EXPECT_EQ(wrong_usage({"x"}), "64 unexpected operand 'x'" + help);
  EXPECT_EQ(wrong_usage({}, 1, 1), "64 an operand is missing" + help);
}

TEST(Options, AMisspelledNameIsGuessed) {
  const std::string help = "; try 'tool --help'";
  EXPECT_EQ(wrong_usage({"--cuont", "3"}), "64 unknown option '--cuont' (did you mean '--count'?)" + help);
  EXPECT_EQ(wrong_usage({"--no-kep"}), "64 unknown option '--no-kep' (did you mean '--no-keep'?)" + help);
}

TEST(Options, AreSpelledAsInAmericaToo) {
  EXPECT_EQ(parsed({"--color", "blue"}).colour, "blue");
  EXPECT_EQ(parsed({"--color=green"}).colour, "green");
  EXPECT_EQ(parsed({"--colo", "green"}).colour, "green");
  EXPECT_EQ(wrong_usage({"--color", "grey"}),
            "64 option --colour: found 'grey', expected red, green or blue; try 'tool --help'");
}

TEST(Options, HelpFitsTheWidth) {
  std::string name;
  bool flag = false;
  Options options("tool", "[-n COUNT] [-o FILE] [OPTION]... < INPUT > OUTPUT",
                  "Does a number of things, one after the other.");
  options.text('o', "output-of-the-tool", "FILE", "write what comes out to FILE, which is not there yet", name)
      .flag('f', "force", "write to a terminal too, where -o names none", flag);
  EXPECT_EQ(options.usage(120),
            "usage: tool [-n COUNT] [-o FILE] [OPTION]... < INPUT > OUTPUT\n"
            "Does a number of things, one after the other.\n\n"
            "  -o, --output-of-the-tool FILE\n"
            "                              write what comes out to FILE, which is not there yet\n"
            "  -f, --force                 write to a terminal too, where -o names none\n");
  EXPECT_EQ(options.usage(40),
            "usage: tool [-n COUNT] [-o FILE]\n"
            "       [OPTION]... < INPUT > OUTPUT\n"
            "Does a number of things, one after the\n"
            "other.\n\n"
            "  -o, --output-of-the-tool FILE\n"
            "        write what comes out to FILE,\n"
            "        which is not there yet\n"
            "  -f, --force\n"
            "        write to a terminal too,\n"
            "        where -o names none\n");
}

TEST(Options, WhatWasGivenIsGivenAgain) {
  std::string name = "-";
  bool flag = false, kept = true;
  int64_t count = 1;
  Options options("tool", "", "");
  options.text('o', "output", "FILE", "", name)
      .flag('f', "force", "", flag)
      .toggle("keep", "", kept)
      .integer('n', "count", "N", "", count, 0, 10)
      .integer(0, "small", "N", "", count, 0, 10);
  std::vector<std::string> words = {"tool", "-fn3", "--output=a b", "--no-keep", "--small", "2", "x"};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  options.parse(int(words.size()), argv.data(), 0, 1);
  EXPECT_EQ(options.given_again({}), "tool -f -n 3 -o 'a b' --no-keep --small 2");
  EXPECT_EQ(options.given_again({"count", "keep"}), "tool -f -o 'a b' --small 2");
}

TEST(Options, CountsAndTimes) {
  EXPECT_EQ(parse_count("20000"), 20000);
  EXPECT_EQ(parse_count("2e7"), 20000000);
  EXPECT_EQ(parse_count("9223372036854775807"), INT64_MAX);
  for (const char* bad : {"", "1.5", "1e30", "9223372036854775808", "0x10", "5 ", "nan", "ten"})
    EXPECT_THROW(parse_count(bad), std::invalid_argument) << bad;
  EXPECT_EQ(parse_seconds("90s"), 90);
  EXPECT_EQ(parse_seconds("30m"), 1800);
  EXPECT_EQ(parse_seconds("1.5h"), 5400);
  EXPECT_EQ(parse_seconds("45"), 45);
  for (const char* bad : {"", "m", "0", "-1s", "nan", "inf", "1d", "1e9", "3 m"})
    EXPECT_THROW(parse_seconds(bad), std::invalid_argument) << bad;
}

TEST(RunTool, TurnsWhatIsThrownIntoALineAndACode) {
  const auto run = [](int (*body)(int, char**)) {
    testing::internal::CaptureStderr();
    const int code = run_tool("tool", 0, nullptr, body);
    return std::to_string(code) + " " + testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(run([](int, char**) { return 3; }), "3 ");
  EXPECT_EQ(run([](int, char**) -> int { fail(Exit::kData, "line ", 3, ": no"); }), "65 tool: line 3: no\n");
  EXPECT_EQ(run([](int, char**) -> int { throw std::bad_alloc(); }), "70 tool: out of memory\n");
  EXPECT_EQ(run([](int, char**) -> int { throw std::logic_error("never"); }), "70 tool: never\n");
}

TEST(RunTool, AdvisesWhereTheCauseIsKnown) {
  static constexpr Cause kHot{"hot"}, kCold{"cold"};
  const auto run = [](int (*body)(int, char**), const std::vector<Advice>& advice) {
    testing::internal::CaptureStderr();
    const int code = run_tool("tool", 0, nullptr, body, advice);
    return std::to_string(code) + " " + testing::internal::GetCapturedStderr();
  };
  const auto hot = [](int, char**) -> int { fail(Exit::kData, kHot, "{} is hot"); };
  const auto placed = [](int, char**) -> int { throw Error(Exit::kData, "hot", kHot).at("line 3: "); };
  const std::vector<Advice> advice = {{kCold, "{}: -w"}, {kHot, "--lr: {} (see -c)"}};
  EXPECT_EQ(run(hot, advice), "65 tool: --lr: {} is hot (see -c)\n");
  EXPECT_EQ(run(placed, advice), "65 tool: --lr: line 3: hot (see -c)\n");
  EXPECT_EQ(run(hot, {}), "65 tool: {} is hot\n");
  EXPECT_EQ(run(hot, {{kCold, "{}: -w"}}), "65 tool: {} is hot\n");
  EXPECT_EQ(run([](int, char**) -> int { fail(Exit::kData, "no cause"); }, advice), "65 tool: no cause\n");
}

TEST(RunCommands, ACommandAdvisesForItself) {
  static constexpr Cause kHot{"hot"};
  const auto hot = [](int, char**) -> int { fail(Exit::kData, kHot, "hot"); };
  const std::vector<Command> commands = {{"a", "first", hot, {{kHot, "{}: -a"}}}, {"b", "second", hot}};
  const auto run = [&](std::string name) {
    char tool[] = "tool";
    char* argv[] = {tool, name.data(), nullptr};
    return thrown([&] { run_commands("tool", "Tools.", commands, 2, argv); });
  };
  EXPECT_EQ(run("a"), "65 hot: -a");
  EXPECT_EQ(run("b"), "65 hot");
  EXPECT_EQ(run("c"), "64 unknown command 'c'; try 'tool --help'");
  EXPECT_EQ(run(""), "64 unknown command ''; try 'tool --help'");
}

}  // namespace
}  // namespace synpo
