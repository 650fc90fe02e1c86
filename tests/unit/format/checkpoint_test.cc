#include "format/checkpoint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/cli/version.h"
#include "base/hash.h"
#include "format/safetensors.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

constexpr char kGolden[] = "tests/data/v1/";

SafeTensors tensors_of(const std::string& bytes) {
  return read_text(bytes, [](Input& input) { return read_safetensors(input); });
}

Checkpoint small_checkpoint() {
  Checkpoint c;
  c.window = 2;
  c.envs = {{"map1", 0xfedcba9876543210, "####\n"}, {"map2", 1, "#@@#\n"}};
  c.tasks = {"R-B", "B-G"};
  c.seen = {{"map1", "R-B"}, {"map2", "B-G"}};
  c.shape = {{"feature", 128}, {"hidden", 512}};
  c.options = {{"lr", "0.001"}, {"note", "\"quoted\""}};
  c.updates = 20000;
  c.states = 10240000;
  c.seed = 7;
  const float weights[2] = {1, 2};
  c.file.add("theta", {2}, weights, 2);
  c.file.add("train/m/theta", {2}, weights, 2);
  return c;
}

Checkpoint checkpoint_of(const std::string& bytes) {
  return read_text(bytes, [](Input& input) { return read_checkpoint(input); });
}

TEST(Checkpoint, ComesBack) {
  const Checkpoint want = small_checkpoint();
  const std::string bytes = format_checkpoint(want);
  const Checkpoint got = checkpoint_of(bytes);
  EXPECT_EQ(got.method, "synpo");
  EXPECT_EQ(got.world, "gridworld");
  EXPECT_EQ(got.rules, 1);
  EXPECT_EQ(got.window, 2);
  ASSERT_EQ(got.envs.size(), 2u);
  EXPECT_EQ(got.envs[0].name, "map1");
  EXPECT_EQ(got.envs[0].hash, 0xfedcba9876543210u);
  EXPECT_EQ(got.envs[1].content, "#@@#\n");
  EXPECT_EQ(got.tasks, want.tasks);
  EXPECT_EQ(got.seen, want.seen);
  EXPECT_EQ(got.shape, want.shape);
  EXPECT_EQ(got.options, want.options);
  EXPECT_EQ(got.updates, 20000);
  EXPECT_EQ(got.states, 10240000);
  EXPECT_EQ(got.seed, 7u);
  EXPECT_EQ(got.file.get<float>("theta"), (std::vector<float>{1, 2}));
  EXPECT_EQ(format_checkpoint(got), bytes);
  for (const uint64_t seed : {uint64_t{0}, uint64_t(INT64_MAX)}) {
    Checkpoint other = want;
    other.seed = seed;
    EXPECT_EQ(checkpoint_of(format_checkpoint(other)).seed, seed);
  }
}

TEST(Checkpoint, DescribesItself) {
  const nlohmann::json description = nlohmann::json::parse(small_checkpoint().describe());
  EXPECT_EQ(description["updates"], 20000);
  EXPECT_EQ(description["envs"][1]["name"], "map2");
  EXPECT_EQ(description["weights_hash"], hex(small_checkpoint().weights_hash()));
  EXPECT_EQ(description["tensors"]["theta"], nlohmann::json::array({2}));
  EXPECT_EQ(nlohmann::json::parse(Checkpoint().describe())["envs"], nlohmann::json::array());
}

TEST(Checkpoint, DescribesItselfWithoutWhatATerminalActsOn) {
  const std::string risky = "\x1b\x7f\u009b\u202e\u2066\u200f\u061c\t\n", fine = "\u00e9\u00a0\U0001f600";
  Checkpoint c = small_checkpoint();
  c.extractor = risky + fine;
  const std::string text = c.describe();
  EXPECT_NE(text.find(R"("\u001b\u007f\u009b\u202e\u2066\u200f\u061c\t\n)" + fine + "\""), std::string::npos)
      << quoted(text);
  EXPECT_EQ(nlohmann::json::parse(text)["extractor"], risky + fine);
}

TEST(Checkpoint, TheHashIsOfWhatEvaluationNeeds) {
  Checkpoint c = small_checkpoint();
  const uint64_t hash = c.weights_hash();
  const float other[2] = {1, 3};
  c.file.add("train/m/theta", {2}, other, 2);
  c.updates = 3;
  EXPECT_EQ(c.weights_hash(), hash);
  c.strip();
  EXPECT_FALSE(c.file.has("train/m/theta"));
  EXPECT_TRUE(c.file.has("theta"));
  EXPECT_EQ(c.weights_hash(), hash);
  EXPECT_EQ(checkpoint_of(format_checkpoint(c)).weights_hash(), hash);
  c.file.add("theta", {2}, other, 2);
  EXPECT_NE(c.weights_hash(), hash);
}

TEST(Checkpoint, HalvesAreTheNearestOfWhatTheyCanHold) {
  Checkpoint c = small_checkpoint();
  const float weights[4] = {1, 1.0f / 3, -1e-9f, 65504}, large[2] = {1, 65505}, broken[2] = {NAN, 1};
  c.file.add("weights", {2, 2}, weights, 4);
  c.file.add("bias", {4}, weights, 4);
  c.file.add("large", {1, 2}, large, 2);
  c.file.add("broken", {1, 2}, broken, 2);
  const int64_t whole[1] = {3};
  c.file.add("whole", {1, 1}, whole, 1);
  c.halve();
  const Checkpoint read = checkpoint_of(format_checkpoint(c));
  EXPECT_EQ(read.file.tensors.at("weights").type, TensorType::kF16);
  EXPECT_EQ(read.file.tensors.at("weights").shape, (std::vector<int64_t>{2, 2}));
  EXPECT_EQ(read.file.get<float>("weights"), (std::vector<float>{1, 0.333251953125f, -0.0f, 65504}));
  EXPECT_EQ(read.file.get<float>("bias"), (std::vector<float>{1, 1.0f / 3, -1e-9f, 65504}));
  for (const char* name : {"bias", "large", "broken"})
    EXPECT_EQ(read.file.tensors.at(name).type, TensorType::kF32) << name;
  EXPECT_EQ(read.file.get<int64_t>("whole")[0], 3);
}

TEST(Checkpoint, SaysWhichBuildWroteIt) {
  EXPECT_EQ(checkpoint_of(format_checkpoint(small_checkpoint())).written_by, "synpo " + version_text());
  // What an older build wrote says so until it is written again, and what the first release wrote says nothing.
  SafeTensors file = tensors_of(format_checkpoint(small_checkpoint()));
  file.metadata["written_by"] = "synpo 0.1.9";
  Checkpoint older = checkpoint_of(format_safetensors(file));
  EXPECT_EQ(older.written_by, "synpo 0.1.9");
  EXPECT_NE(older.describe().find("synpo 0.1.9"), std::string::npos);
  EXPECT_EQ(checkpoint_of(format_checkpoint(older)).written_by, "synpo " + version_text());
  file.metadata.erase("written_by");
  EXPECT_EQ(checkpoint_of(format_safetensors(file)).written_by, "");
}

// The small checkpoint with one entry of its metadata replaced, or taken away.
std::string checkpoint_refused(const char* key, const std::string& value, bool erase = false) {
  SafeTensors file = tensors_of(format_checkpoint(small_checkpoint()));
  if (erase)
    file.metadata.erase(key);
  else
    file.metadata[key] = value;
  return thrown([&] { checkpoint_of(format_safetensors(file)); });
}

TEST(Checkpoint, RefusesCountsAtWhichARunCouldComeToTheEndOfTheType) {
  for (const char* key : {"updates", "states"}) {
    EXPECT_EQ(checkpoint_refused(key, "9007199254740992"), "nothing thrown");
    EXPECT_TRUE(checkpoint_refused(key, "9007199254740993").starts_with("65 cannot read IN: metadata '")) << key;
  }
}

TEST(Checkpoint, RefusesOtherMetadata) {
  EXPECT_EQ(checkpoint_refused("version", "2"), "65 cannot read IN: version 2, this build reads 1 to 1");
  EXPECT_EQ(
      checkpoint_refused("version", "one"),
      "65 cannot read IN: metadata 'version': found 'one', expected a whole number from 0 to 9223372036854775807");
  EXPECT_EQ(checkpoint_refused("format", "other"), "65 cannot read IN: not a synpo checkpoint");
  EXPECT_EQ(checkpoint_refused("format", "", true), "65 cannot read IN: not a synpo checkpoint");
  for (const char* key :
       {"method", "world", "rules", "window", "updates", "states", "seed", "tasks", "seen", "shape", "options", "envs"})
    EXPECT_EQ(checkpoint_refused(key, "", true), concat("65 cannot read IN: no metadata '", key, "'"));
  for (const char* key : {"rules", "window", "updates", "states", "seed"})
    for (const char* value : {"-1", "1.5", "\"1\"", "", "[]", "1e30", "18446744073709551616"})
      EXPECT_EQ(checkpoint_refused(key, value), concat("65 cannot read IN: metadata '", key, "': found '", value,
                                                       "', expected a whole number from 0 to 9223372036854775807"));
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  for (const auto& [key, expected] : {std::pair{"tasks", "an array of names"},
                                      {"seen", "an array of pairs of names"},
                                      {"options", "an object of strings"},
                                      {"envs", "an array of objects with name, hash and content"},
                                      {"shape", "an object of numbers"}}) {
    const std::string start = concat("65 cannot read IN: metadata '", key, "': ");
    EXPECT_EQ(checkpoint_refused(key, "{"),
              start + "no JSON (byte 2: while parsing object key - unexpected end of input; expected string literal)");
    EXPECT_EQ(checkpoint_refused(key, deep), start + "more than 8 levels of nesting");
    for (const char* value : {"3", "[3]"}) EXPECT_EQ(checkpoint_refused(key, value), start + "expected " + expected);
    if (key == std::string("seen")) {
      EXPECT_EQ(checkpoint_refused(key, R"([["a","b","c"]])"), start + "expected " + expected);
    }
    if (key != std::string("shape")) {
      EXPECT_EQ(checkpoint_refused(key, "{\"a\":[]}"), start + "expected " + expected);
    }
  }
  EXPECT_EQ(checkpoint_refused("envs", R"([{"name":"a","hash":"0123456789abcdef"}])"),
            "65 cannot read IN: metadata 'envs': an object has no 'content'");
  for (const char* value : {"1.5", "1e300", "true", "\"1\"", "[]", "null"})
    EXPECT_EQ(checkpoint_refused("shape", concat("{\"a\":", value, "}")),
              "65 cannot read IN: metadata 'shape': 'a' is no whole number")
        << value;
}

// Files of version 1 keep loading: these were written by the first release.
TEST(GoldenV1, Checkpoint) {
  Input input(std::string(kGolden) + "checkpoint.safetensors");
  const Checkpoint c = read_checkpoint(input);
  EXPECT_EQ(c.method, "synpo");
  EXPECT_EQ(c.window, 2);
  ASSERT_EQ(c.envs.size(), 3u);
  EXPECT_EQ(c.envs[2].name, "map15");
  EXPECT_EQ(c.envs[2].hash, Hash().add(c.envs[2].content).value());
  EXPECT_EQ(c.tasks.size(), 20u);
  EXPECT_EQ(c.seen.size(), 4u);
  EXPECT_EQ(c.seen[3], (std::pair<std::string, std::string>{"map15", "P-O"}));
  EXPECT_EQ(c.shape.at("channels2"), 5);
  EXPECT_EQ(c.shape.at("normalise_input"), 1);
  EXPECT_EQ(c.options.at("roll-in"), "0.5");
  EXPECT_EQ(c.updates, 1234);
  EXPECT_EQ(c.states, 631808);
  EXPECT_EQ(c.seed, 42u);
  EXPECT_EQ(hex(c.weights_hash()), "e0507b4a3a05fe54");
}

}  // namespace
}  // namespace synpo
