#include "format/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

Trajectory short_trajectory() {
  Trajectory t;
  t.env = "map3";
  t.task = "R-B";
  t.env_hash = 0xfedcba9876543210;
  t.window = 2;
  t.seed = 18446744073709551615u;
  t.episode = INT64_MAX;
  t.start = {{"agent", {3, 4}}, {"R", {1, 14}}};
  t.actions = {0, 4, 3};
  t.labels = {0, 4, 1};
  t.reward_cents = {-1, 99, 1099};
  t.success = t.terminated = true;
  return t;
}

Trajectory parsed(const std::string& line) { return parse_trajectory(line, 300); }

void expect_equal(const Trajectory& a, const Trajectory& b) {
  EXPECT_EQ(a.world, b.world);
  EXPECT_EQ(a.rules, b.rules);
  EXPECT_EQ(a.env, b.env);
  EXPECT_EQ(a.task, b.task);
  EXPECT_EQ(a.env_hash, b.env_hash);
  EXPECT_EQ(a.window, b.window);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.episode, b.episode);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.actions, b.actions);
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.reward_cents, b.reward_cents);
  EXPECT_EQ(a.success, b.success);
  EXPECT_EQ(a.terminated, b.terminated);
  EXPECT_EQ(a.truncated, b.truncated);
}

TEST(Trajectory, IsOneLineOfPlainJson) {
  EXPECT_EQ(format_trajectory(short_trajectory()),
            R"({"format":"synpo-trajectory","version":1,"world":"gridworld","rules":1,"env":"map3","task":"R-B",)"
            R"("env_hash":"fedcba9876543210","window":2,"seed":18446744073709551615,"episode":9223372036854775807,)"
            R"("start":{"R":[1,14],"agent":[3,4]},"actions":[0,4,3],"labels":[0,4,1],"rewards":[-0.01,0.99,10.99],)"
            R"("return":11.97,"success":true,"terminated":true,"truncated":false})");
}

TEST(Trajectory, ComesBack) {
  expect_equal(parsed(format_trajectory(short_trajectory())), short_trajectory());
  Trajectory cut = short_trajectory();
  cut.labels.clear();
  cut.actions.assign(300, 2);
  cut.reward_cents.assign(300, -2);
  cut.success = cut.terminated = false;
  cut.truncated = true;
  expect_equal(parsed(format_trajectory(cut)), cut);
}

// The short trajectory with one field replaced (or taken away, where `value` is empty).
std::string with(const char* field, const std::string& value) {
  nlohmann::json line = nlohmann::json::parse(format_trajectory(short_trajectory()));
  if (value.empty())
    line.erase(field);
  else
    line[field] = "HERE";
  std::string text = line.dump();
  if (const size_t at = text.find("\"HERE\""); at != std::string::npos) text.replace(at, 6, value);
  return text;
}

std::string refused(const std::string& line) {
  return thrown([&] { parsed(line); });
}

TEST(Trajectory, ScoresAndProbabilitiesReadBackToTheBit) {
  Trajectory t = short_trajectory();
  t.policy = {2, 0.5, {0.1f, 1 / 3.0f, -3.4e38f, 1e-45f, 16777216, -0.0f}, {0.1, 1 / 3.0, 1, 5e-324, 0, 1 - 1e-16}};
  const std::string line = format_trajectory(t);
  const nlohmann::json object = nlohmann::json::parse(line);
  EXPECT_EQ(object["temperature"], 0.5);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(float(object["scores"][i / 2][i % 2].get<double>()), t.policy.scores[i]) << i;
    EXPECT_EQ(object["probabilities"][i / 2][i % 2].get<double>(), t.policy.probabilities[i]) << i;
  }
  EXPECT_EQ(object["scores"].size(), 3u);
  EXPECT_TRUE(line.find("\"scores\":[[0.1,0.33333334],[") != std::string::npos) << line;
  expect_equal(parsed(line), short_trajectory());
  t.policy.scores[1] = NAN;
  t.policy.scores[2] = INFINITY;
  EXPECT_TRUE(format_trajectory(t).find("\"scores\":[[0.1,null],[null,") != std::string::npos);
}

TEST(Trajectory, UnknownFieldsArePassedOver) {
  expect_equal(parsed(with("colour", R"({"a":[1,{"b":null}]})")), short_trajectory());
  expect_equal(parsed(with("return", "")), short_trajectory());
}

TEST(Trajectory, RefusesWhatIsNoObject) {
  for (const char* line : {"[]", "3", "null", "\"text\""})
    EXPECT_EQ(refused(line), "65 found " + quoted(line) + ", expected a JSON object");
  EXPECT_EQ(refused(""), "65 found an empty line, expected a JSON object");
  const auto no_json = [](const std::string& reason) {
    return "65 found no JSON (" + reason + "), expected a JSON object";
  };
  EXPECT_EQ(refused("x"), no_json("byte 1: while parsing value - invalid literal; last read: 'x'"));
  EXPECT_EQ(refused("NaN"), no_json("byte 1: while parsing value - invalid literal; last read: 'N'"));
  EXPECT_EQ(refused("{"),
            no_json("byte 2: while parsing object key - unexpected end of input; expected string literal"));
  EXPECT_EQ(refused("{\"format\":}"),
            no_json("byte 11: while parsing value - unexpected '}'; expected '[', '{', or a literal"));
  EXPECT_EQ(refused("{} {}"), no_json("byte 4: while parsing value - unexpected '{'; expected end of input"));
  EXPECT_EQ(refused("{\"a\":\"\xff\"}"),
            no_json("byte 7: while parsing value - invalid string: ill-formed UTF-8 byte; last read: '\"\\xff'"));
  EXPECT_EQ(refused(std::string("{}\0x", 4)), no_json("byte 3: a NUL byte"));
  EXPECT_EQ(refused("{\"a\":1e999}"), no_json("byte 6: number overflow parsing '1e999'"));
  EXPECT_EQ(refused("{\"a\":1,\"b\":{\"a\":1},\"a\":2}"),
            "65 found the name 'a' twice in one object, expected a JSON object");
  const std::string good = format_trajectory(short_trajectory());
  for (size_t size = 0; size < good.size(); ++size)
    ASSERT_TRUE(refused(good.substr(0, size)).ends_with("expected a JSON object")) << size;
  EXPECT_EQ(refused("{}"), "65 no field 'format'");
}

TEST(Trajectory, DeepNestingIsRefusedEarly) {
  for (const char* open : {"[", "{\"a\":"}) {
    std::string deep;
    for (int i = 0; i < 1000000; ++i) deep += open;
    EXPECT_EQ(refused(deep), "65 found more than 8 levels of nesting, expected a JSON object");
    EXPECT_EQ(refused(with("start", deep)), "65 found more than 8 levels of nesting, expected a JSON object");
  }
}

TEST(Trajectory, OtherVersionsAndFormatsAreNamed) {
  EXPECT_EQ(refused(with("version", "2")), "65 version 2, this build reads 1 to 1");
  EXPECT_EQ(refused(with("version", "0")), "65 version 0, this build reads 1 to 1");
  EXPECT_EQ(refused(with("version", "\"1\"")),
            "65 field 'version': found '\"1\"', expected a whole number from 0 to 2147483647");
  EXPECT_EQ(refused(with("format", "\"minari\"")), "65 field 'format': found '\"minari\"', expected synpo-trajectory");
}

TEST(Trajectory, MissingFieldsAreNamed) {
  for (const char* field : {"format", "version", "world", "rules", "env", "task", "env_hash", "window", "seed",
                            "episode", "start", "actions", "rewards", "success", "terminated", "truncated"})
    EXPECT_EQ(refused(with(field, "")), concat("65 no field '", field, "'"));
}

TEST(Trajectory, WrongKindsAreNamed) {
  const std::string line_start = "65 field '";
  for (const char* field : {"format", "world", "env", "task", "env_hash"})
    for (const char* value : {"3", "null", "[]", "true"})
      EXPECT_EQ(refused(with(field, value)), concat("65 field '", field, "': found '", value, "', expected a string"));
  for (const char* field : {"success", "terminated", "truncated"})
    for (const char* value : {"1", "\"true\"", "null"})
      EXPECT_EQ(refused(with(field, value)),
                concat("65 field '", field, "': found ", quoted(value), ", expected true or false"));
  for (const char* field : {"rules", "window", "episode"})
    for (const char* value : {"-1", "1.5", "1e3", "\"1\"", "null", "[1]", "9223372036854775808", "1e999"}) {
      const std::string message = refused(with(field, value));
      EXPECT_TRUE(message.starts_with(concat("65 field '", field, "': found ")) ||
                  message.ends_with("expected a JSON object"))
          << message;
    }
  EXPECT_EQ(refused(with("seed", "-1")),
            "65 field 'seed': found '-1', expected a whole number from 0 to 18446744073709551615");
  EXPECT_EQ(refused(with("seed", "18446744073709551616")),
            "65 field 'seed': found '1.8446744073709552e+19', expected a whole number from 0 to 18446744073709551615");
  EXPECT_EQ(refused(with("window", "1001")), "65 field 'window': found '1001', expected a whole number from 0 to 1000");
  EXPECT_EQ(refused(with("env_hash", "\"12\"")), "65 found '12', expected a hash of 16 hexadecimal digits");
  EXPECT_EQ(refused(with("start", "[1,2]")), "65 field 'start': found '[1,2]', expected an object of places");
  EXPECT_EQ(refused(with("start", R"({"agent":[1]})")), "65 field 'start': found '[1]', expected [row, column]");
  EXPECT_EQ(refused(with("start", R"({"agent":[1,-2000000]})")),
            "65 field 'start': found '-2000000', expected a whole number from -1048576 to 1048576");
}

std::string array_of(size_t size, const std::string& value) {
  std::string text = "[";
  for (size_t i = 0; i < size; ++i) text += (i ? "," : "") + value;
  return text + "]";
}

TEST(Trajectory, ActionsAndRewardsAreHeldToTheirBounds) {
  EXPECT_EQ(refused(with("actions", "[0,256,1]")),
            "65 field 'actions': found '256', expected a whole number from 0 to 255");
  EXPECT_EQ(refused(with("actions", "[0,-1,1]")),
            "65 field 'actions': found '-1', expected a whole number from 0 to 255");
  EXPECT_EQ(refused(with("actions", "[]")), "65 field 'actions': found '[]', expected an array of 1 to 300 actions");
  EXPECT_TRUE(refused(with("actions", array_of(301, "0"))).ends_with("expected an array of 1 to 300 actions"));
  EXPECT_EQ(refused(with("actions", "{\"0\":1}")),
            "65 field 'actions': found '{\"0\":1}', expected an array of 1 to 300 actions");
  EXPECT_EQ(refused(with("labels", "[0,1]")), "65 found 2 labels for 3 actions");
  EXPECT_EQ(refused(with("labels", "[0,1,999]")),
            "65 field 'labels': found '999', expected a whole number from 0 to 255");
  EXPECT_EQ(refused(with("rewards", "[-0.01]")), "65 field 'rewards': found '[-0.01]', expected an array of 3 rewards");
  EXPECT_EQ(refused(with("rewards", "[0,0,0.005]")), "65 field 'rewards': found '0.005', expected a multiple of 0.01");
  EXPECT_EQ(refused(with("rewards", "[0,0,1e300]")), "65 field 'rewards': found '1e+300', expected a multiple of 0.01");
  EXPECT_EQ(refused(with("rewards", "[0,0,null]")), "65 field 'rewards': found 'null', expected a multiple of 0.01");
  EXPECT_TRUE(refused(with("rewards", "[0,0,NaN]")).ends_with("expected a JSON object"));
}

TEST(Trajectory, DamagedLinesAreReadOrRefusedAndNothingElse) {
  const std::string good = format_trajectory(short_trajectory());
  for (uint64_t i = 0; i < 5000; ++i) {
    Random random(1, Purpose::kNoise, 0, i);
    std::string line = good;
    for (uint32_t changes = 1 + random.below(3); changes > 0; --changes) {
      const size_t at = random.below(uint32_t(line.size()));
      if (random.below(3) == 0)
        line.erase(at, 1 + random.below(8));
      else
        line[at] = random.below(2) ? char(random.below(256)) : good[random.below(uint32_t(good.size()))];
    }
    try {
      parsed(line);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::kData);
    }
  }
}

// Written by the first release.
TEST(GoldenV1, Trajectories) {
  const std::string text = contents("tests/data/v1/trajectories.jsonl");
  const size_t middle = text.find('\n');
  ASSERT_NE(middle, std::string::npos);
  const Trajectory first = parsed(text.substr(0, middle)),
                   second = parsed(text.substr(middle + 1, text.size() - middle - 2));
  EXPECT_EQ(first.env + " " + first.task, "map2 P-O");
  EXPECT_EQ(first.env_hash, 0x65e773aea34ee04fu);
  EXPECT_EQ(first.start.at("agent"), (std::pair{3, 1}));
  EXPECT_EQ(first.start.at("G"), (std::pair{14, 8}));
  EXPECT_EQ(first.seed, 1u);
  EXPECT_EQ(first.labels.size(), first.actions.size());
  EXPECT_NE(first.labels, first.actions);
  EXPECT_EQ(second.env + " " + second.task, "map20 G-O");
  EXPECT_EQ(second.episode, 1);
  EXPECT_EQ(second.reward_cents.back(), 1099);
  EXPECT_TRUE(second.success && second.terminated);
  EXPECT_FALSE(second.truncated);
  EXPECT_EQ(format_trajectory(first) + "\n" + format_trajectory(second) + "\n", text);
}

// The lines that hold trajectories, joined by spaces, of a stream of these.
std::string lines_of(const std::string& text, bool must_end = false) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  std::fputs(text.c_str(), file.get());
  std::rewind(file.get());
  Input input(fileno(file.get()), "input");
  TrajectoryLines lines(input);
  std::string line, all;
  while (lines.next(line)) all += line + " ";
  if (must_end) lines.check_end();
  return all;
}

TEST(TrajectoryLines, AnEndCountsWhatCame) {
  const std::string end = R"({"format":"synpo-end","version":1,"trajectories":2})";
  EXPECT_EQ(format_end(2), end);
  EXPECT_EQ(lines_of("a\nb\n" + end + "\n", true), "a b ");
  // As any program may write it, without the last newline, in any place, and several.
  EXPECT_EQ(lines_of("a\nb\n{ \"trajectories\": 2, \"version\": 1, \"format\": \"synpo-end\" }", true), "a b ");
  EXPECT_EQ(lines_of(end + "\na\nb\n", true), "a b ");
  EXPECT_EQ(lines_of("a\n" + format_end(1) + "\nb\nc\n" + format_end(2) + "\n", true), "a b c ");
  EXPECT_EQ(lines_of(format_end(0), true), "");
}

TEST(TrajectoryLines, AStreamNeedNotSayItsEnd) {
  EXPECT_EQ(lines_of("a\nb\n"), "a b ");
  EXPECT_EQ(thrown([] { lines_of("a\nb\n", true); }),
            "65 input: it ended after 2 trajectories, expected a last line that says its end");
  EXPECT_EQ(thrown([] { lines_of("", true); }),
            "65 input: it ended after 0 trajectories, expected a last line that says its end");
}

TEST(TrajectoryLines, MissingLinesAreNoticed) {
  EXPECT_EQ(thrown([] { lines_of("a\n" + format_end(2)); }),
            "65 input: found 1 trajectories, expected 2 as its end says: lines are missing, or some were chosen");
  EXPECT_EQ(thrown([] { lines_of("a\nb\nc\n" + format_end(2)); }),
            "65 input: found 3 trajectories, expected 2 as its end says: lines are missing, or some were chosen");
  EXPECT_EQ(thrown([] { lines_of("a\n" + format_end(1) + "\nb\n" + format_end(2)); }),
            "65 input: found 2 trajectories, expected 3 as its ends say: lines are missing, or some were chosen");
}

TEST(TrajectoryLines, AMalformedEndIsRefusedAndAnotherLineIsNone) {
  const auto bad = [](const std::string& line) { return thrown([&] { lines_of("a\n" + line + "\n"); }); };
  EXPECT_EQ(bad(R"({"format":"synpo-end","version":2,"trajectories":1})"),
            "65 input: line 2: version 2, this build reads 1 to 1");
  EXPECT_EQ(bad(R"({"format":"synpo-end","version":1})"), "65 input: line 2: no field 'trajectories'");
  EXPECT_EQ(
      bad(R"({"format":"synpo-end","version":1,"trajectories":-1})"),
      "65 input: line 2: field 'trajectories': found '-1', expected a whole number from 0 to 9223372036854775807");
  const std::string most = format_end(INT64_MAX);
  EXPECT_EQ(bad(most + "\n" + most),
            "65 input: line 3: field 'trajectories': found '9223372036854775807', expected a whole number from 0 to 0");
  EXPECT_EQ(lines_of(R"({"env":"synpo-end"})"), R"({"env":"synpo-end"} )");
  EXPECT_EQ(lines_of("synpo-end"), "synpo-end ");
  EXPECT_EQ(lines_of(R"({"format":"synpo-end)"), R"({"format":"synpo-end )");
}

}  // namespace
}  // namespace synpo
