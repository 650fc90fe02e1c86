#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/half.h"
#include "base/hash.h"
#include "base/random.h"
#include "format/checkpoint.h"
#include "format/matrix.h"
#include "format/pairs.h"
#include "format/run_log.h"
#include "format/safetensors.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

constexpr char kGolden[] = "tests/data/v1/";

// A safetensors file of this header and this many bytes of data.
std::string safetensors(const std::string& header, size_t bytes) {
  const uint64_t length = header.size();
  return std::string(reinterpret_cast<const char*>(&length), 8) + header + std::string(bytes, '\0');
}

SafeTensors tensors_of(const std::string& bytes) {
  return read_text(bytes, [](Input& input) { return read_safetensors(input); });
}

std::string tensors_refused(const std::string& bytes) {
  return thrown([&] { tensors_of(bytes); });
}

SafeTensors small_file() {
  SafeTensors file;
  file.metadata = {{"name", "a \"b\" \xc3\xa9"}, {"x", ""}};
  const float floats[6] = {1, -2.5f, INFINITY, 1e-45f, 0, -0.0f};
  const double reals[1] = {M_PI};
  const int64_t wholes[2] = {INT64_MIN, 7};
  const uint64_t big[1] = {~0ull};
  const uint8_t bytes[3] = {0, 128, 255};
  const int32_t ints[2] = {INT32_MIN, -1};
  const Half halves[3] = {{0x3c00}, {0x8000}, {0x7bff}};
  file.add("h", {3}, halves, 3);
  file.add("n", {1, 2}, ints, 2);
  file.add("f", {2, 3}, floats, 6);
  file.add("d", {}, reals, 1);
  file.add("i", {2}, wholes, 2);
  file.add("u", {1, 1}, big, 1);
  file.add("b", {3}, bytes, 3);
  file.add("none", {0, 5}, bytes, 0);
  return file;
}

TEST(SafeTensors, ComesBack) {
  const std::string bytes = format_safetensors(small_file());
  const SafeTensors file = tensors_of(bytes);
  EXPECT_EQ(file.metadata, small_file().metadata);
  ASSERT_EQ(file.tensors.size(), 8u);
  for (const auto& [name, tensor] : small_file().tensors) {
    EXPECT_EQ(file.tensors.at(name).shape, tensor.shape) << name;
    EXPECT_EQ(file.tensors.at(name).bytes, tensor.bytes) << name;
    EXPECT_EQ(file.tensors.at(name).type, tensor.type) << name;
  }
  EXPECT_EQ(file.get<int64_t>("i"), (std::vector<int64_t>{INT64_MIN, 7}));
  EXPECT_EQ(file.get<uint8_t>("b"), (std::vector<uint8_t>{0, 128, 255}));
  EXPECT_EQ(file.get<int32_t>("n"), (std::vector<int32_t>{INT32_MIN, -1}));
  EXPECT_EQ(to_float(file.get<Half>("h")[2]), 65504.0f);
  EXPECT_TRUE(file.get<uint8_t>("none").empty());
  EXPECT_EQ(format_safetensors(file), bytes);
  uint64_t length;
  std::memcpy(&length, bytes.data(), 8);
  EXPECT_EQ(length % 8, 0u);
}

TEST(SafeTensors, WhatIsAskedForMustBeThere) {
  const SafeTensors file = small_file();
  float six[6];
  file.get("f", six, 6);
  EXPECT_EQ(six[1], -2.5f);
  EXPECT_EQ(thrown([&] { file.get("f", six, 5); }), "65 tensor 'f': found 6 values, expected 5");
  EXPECT_EQ(thrown([&] { file.get("g", six, 6); }), "65 no tensor 'g'");
  EXPECT_EQ(thrown([&] { file.get("d", six, 1); }), "65 tensor 'd': found type F64, expected F32");
  EXPECT_EQ(thrown([&] { file.meta("y"); }), "65 no metadata 'y'");
}

TEST(SafeTensors, EveryTruncationIsRefused) {
  const std::string bytes = format_safetensors(small_file());
  EXPECT_EQ(tensors_refused(""), "65 cannot read IN: it is empty");
  for (size_t size = 1; size < bytes.size(); ++size) {
    const std::string message = tensors_refused(bytes.substr(0, size));
    ASSERT_TRUE(message.starts_with(concat("65 cannot read IN: it ends at byte ", size, ", ")))
        << size << " " << message;
  }
  EXPECT_EQ(tensors_refused(bytes + "x"), "65 cannot read IN: bytes follow the last tensor");
}

TEST(SafeTensors, RefusesBadHeaders) {
  const auto length_only = [](uint64_t length) {
    return std::string(reinterpret_cast<const char*>(&length), 8) + "{}";
  };
  for (const uint64_t length : {uint64_t{0}, uint64_t{1}, uint64_t{100'000'001}, ~uint64_t{0}})
    EXPECT_EQ(tensors_refused(length_only(length)),
              concat("65 cannot read IN: not a safetensors file (header length ", length, ")"));
  EXPECT_EQ(tensors_refused(length_only(100'000'000)),
            "65 cannot read IN: it ends at byte 10, in the middle of the header");
  const std::string no_safetensors = "65 cannot read IN: not a safetensors file (the header";
  for (const char* header : {"[]", "null"})
    EXPECT_EQ(tensors_refused(safetensors(header, 0)), no_safetensors + " is no JSON object)");
  EXPECT_EQ(tensors_refused(safetensors("  ", 0)),
            no_safetensors +
                ": no JSON (byte 3: while parsing value - unexpected end of input; expected '[', '{', or a literal))");
  EXPECT_EQ(tensors_refused(safetensors("{}}", 0)),
            no_safetensors + ": no JSON (byte 3: while parsing value - unexpected '}'; expected end of input))");
  EXPECT_EQ(
      tensors_refused(safetensors("{\"a\"", 0)),
      no_safetensors + ": no JSON (byte 5: while parsing object separator - unexpected end of input; expected ':'))");
  EXPECT_EQ(tensors_refused(safetensors(std::string(1000000, '['), 0)),
            no_safetensors + ": more than 4 levels of nesting)");
  const char tensor[] = R"("a":{"dtype":"U8","shape":[0],"data_offsets":[0,0]})";
  EXPECT_EQ(tensors_refused(safetensors(concat("{", tensor, ",", tensor, "}"), 0)),
            no_safetensors + ": the name 'a' twice in one object)");
  // Numbers without end take no memory beyond the text's own.
  std::string numbers = R"({"a":{"dtype":"U8","data_offsets":[0,0],"shape":[1)";
  for (int i = 0; i < 2'000'000; ++i) numbers += ",1";
  EXPECT_EQ(tensors_refused(safetensors(numbers + "]}}", 0)), no_safetensors + ": more than 1048576 values and names)");
  EXPECT_EQ(tensors_refused(safetensors(R"({"__metadata__":{"a":1}})", 0)),
            "65 cannot read IN: metadata 'a' is no string");
  EXPECT_EQ(tensors_refused(safetensors(R"({"__metadata__":[]})", 0)), "65 cannot read IN: metadata is no object");
  EXPECT_EQ(tensors_of(safetensors("{}", 0)).tensors.size(), 0u);
}

std::string tensor_refused(const std::string& fields, size_t bytes = 8) {
  return tensors_refused(safetensors("{\"t\":{" + fields + "}}", bytes));
}

TEST(SafeTensors, RefusesBadTensors) {
  const std::string start = "65 cannot read IN: tensor 't': ";
  EXPECT_EQ(tensors_refused(safetensors(R"({"t":3})", 0)), start + "expected dtype, shape and data_offsets");
  EXPECT_EQ(tensor_refused(R"("dtype":"F32","shape":[2])"), start + "expected dtype, shape and data_offsets");
  EXPECT_EQ(tensor_refused(R"("dtype":"BF16","shape":[4],"data_offsets":[0,8])"),
            start + "type '\"BF16\"', this build reads F16, F32, F64, I32, I64, U8 and U64");
  EXPECT_EQ(tensor_refused(R"("dtype":4,"shape":[4],"data_offsets":[0,8])"),
            start + "type '4', this build reads F16, F32, F64, I32, I64, U8 and U64");
  EXPECT_EQ(tensor_refused(R"("dtype":"F32","shape":2,"data_offsets":[0,8])"),
            start + "shape is no array of at most 8 numbers");
  EXPECT_EQ(tensor_refused(R"("dtype":"F32","shape":[1,1,1,1,1,1,1,1,2],"data_offsets":[0,8])"),
            start + "shape is no array of at most 8 numbers");
  EXPECT_EQ(tensor_refused(R"("dtype":"F32","shape":[2],"data_offsets":[0,8,9])"), start + "data_offsets is no pair");
  for (const char* extent : {"-2", "2.0", "\"2\"", "null", "1e99"})
    EXPECT_TRUE(tensor_refused(concat(R"("dtype":"F32","shape":[)", extent, R"(],"data_offsets":[0,8])"))
                    .find("expected a whole number from 0") != std::string::npos);
  EXPECT_EQ(tensor_refused(R"("dtype":"F32","shape":[2],"data_offsets":[0,4])"),
            start + "data_offsets 0 to 4, expected 8 bytes");
  EXPECT_EQ(tensor_refused(R"("dtype":"F32","shape":[2],"data_offsets":[8,0])"),
            start + "data_offsets 8 to 0, expected 8 bytes");
  // Products of extents that are 8 modulo 2^64, and sizes that nothing holds.
  for (const char* shape : {"[4294967296,4294967296]", "[2305843009213693952,2]", "[18446744073709551615]",
                            "[3,6148914691236517206]", "[17179869184]"})
    EXPECT_EQ(tensor_refused(concat(R"("dtype":"F32","shape":)", shape, R"(,"data_offsets":[0,8])")),
              start + "larger than 17179869184 bytes")
        << shape;
  EXPECT_EQ(tensor_refused(R"("dtype":"U8","shape":[8000000000],"data_offsets":[0,8000000000])"),
            "65 cannot read IN: it ends at byte 87, in the middle of tensor 't'");
}

TEST(SafeTensors, TensorsLieOneBehindTheOther) {
  const auto two = [](const char* a, const char* b, size_t bytes) {
    return tensors_refused(safetensors(concat(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":)", a,
                                              R"(},"b":{"dtype":"F32","shape":[1],"data_offsets":)", b, "}}"),
                                       bytes));
  };
  EXPECT_EQ(two("[0,4]", "[0,4]", 8), "65 cannot read IN: tensor 'b' begins at 0, expected 4");
  EXPECT_EQ(two("[0,4]", "[2,6]", 8), "65 cannot read IN: tensor 'b' begins at 2, expected 4");
  EXPECT_EQ(two("[0,4]", "[8,12]", 12), "65 cannot read IN: tensor 'b' begins at 8, expected 4");
  EXPECT_EQ(two("[4,8]", "[8,12]", 12), "65 cannot read IN: tensor 'a' begins at 4, expected 0");
  EXPECT_EQ(two("[4,8]", "[0,4]", 8), "nothing thrown");
}

TEST(SafeTensors, DamagedFilesAreReadOrRefusedAndNothingElse) {
  const std::string good = format_safetensors(small_file());
  uint64_t length;
  std::memcpy(&length, good.data(), 8);
  for (uint64_t i = 0; i < 2000; ++i) {
    Random random(2, Purpose::kNoise, 0, i);
    std::string bytes = good;
    for (uint32_t changes = 1 + random.below(3); changes > 0; --changes)
      bytes[8 + random.below(uint32_t(length))] =
          random.below(4) ? good[8 + random.below(uint32_t(length))] : char(random.below(256));
    try {
      tensors_of(bytes);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::kData);
    }
  }
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

// The small checkpoint with one entry of its metadata replaced, or taken away.
std::string checkpoint_refused(const char* key, const std::string& value, bool erase = false) {
  SafeTensors file = tensors_of(format_checkpoint(small_checkpoint()));
  if (erase)
    file.metadata.erase(key);
  else
    file.metadata[key] = value;
  return thrown([&] { checkpoint_of(format_safetensors(file)); });
}

TEST(Checkpoint, RefusesOtherMetadata) {
  EXPECT_EQ(checkpoint_refused("version", "2"), "65 cannot read IN: version 2, this build reads 1 to 1");
  EXPECT_EQ(checkpoint_refused("version", "one"),
            "65 cannot read IN: metadata 'version': found 'one', expected a whole number from 0");
  EXPECT_EQ(checkpoint_refused("format", "other"), "65 cannot read IN: not a synpo checkpoint");
  EXPECT_EQ(checkpoint_refused("format", "", true), "65 cannot read IN: not a synpo checkpoint");
  for (const char* key :
       {"method", "world", "rules", "window", "updates", "states", "seed", "tasks", "seen", "shape", "options", "envs"})
    EXPECT_EQ(checkpoint_refused(key, "", true), concat("65 cannot read IN: no metadata '", key, "'"));
  for (const char* key : {"rules", "window", "updates", "states", "seed"})
    for (const char* value : {"-1", "1.5", "\"1\"", "", "[]", "1e30", "18446744073709551616"})
      EXPECT_EQ(checkpoint_refused(key, value),
                concat("65 cannot read IN: metadata '", key, "': found '", value, "', expected a whole number from 0"));
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
    if (key != std::string("shape")) EXPECT_EQ(checkpoint_refused(key, "{\"a\":[]}"), start + "expected " + expected);
  }
  EXPECT_EQ(checkpoint_refused("envs", R"([{"name":"a","hash":"0123456789abcdef"}])"),
            "65 cannot read IN: metadata 'envs': an object has no 'content'");
  for (const char* value : {"1.5", "1e300", "true", "\"1\"", "[]", "null"})
    EXPECT_EQ(checkpoint_refused("shape", concat("{\"a\":", value, "}")),
              "65 cannot read IN: metadata 'shape': 'a' is no whole number")
        << value;
}

struct RunLog : TsvLog {
  RunLog(const std::string& path, bool append) : TsvLog(path, append, run_log_columns()) {}
  void write(const RunLogRow& row) { TsvLog::write(run_log_values(row)); }
};

TEST(RunLog, WritesARowAReport) {
  const TemporaryFolder folder;
  {
    RunLog log(folder.file("log"), false);
    RunLogRow row;
    row.update = 100;
    row.states = 51200;
    row.trajectories = 2100;
    row.seconds = 1.5;
    row.loss = 2.25;
    row.right[0] = 0.5;
    row.right[1] = std::nan("");
    log.write(row);
    EXPECT_EQ(contents(folder.file("log"))
                  .find("100\t51200\t2100\t1.5\t0\t0\t2.25\t0\t0\t0\t0\t0.5\tNA\t0\t0\tNA\tNA\tNA\tNA\n"),
              contents(folder.file("log")).find('\n') + 1);
    row.evaluation = {0.25, -1, 0.125, -2};
    log.write(row);
  }
  const std::string text = contents(folder.file("log"));
  EXPECT_TRUE(text.starts_with("update\tstates\ttrajectories\tseconds\t"));
  EXPECT_TRUE(text.ends_with("\t0.25\t-1\t0.125\t-2\n"));
  // As many fields in every row.
  int tabs[3] = {}, line = 0;
  for (const char c : text) {
    tabs[line] += c == '\t';
    line += c == '\n' && line < 2;
  }
  EXPECT_EQ(tabs[0], 18);
  EXPECT_EQ(tabs[1], 18);
  EXPECT_EQ(tabs[2], 18);
}

TEST(RunLog, IsContinuedOrWrittenAnew) {
  const TemporaryFolder folder;
  const std::string path = folder.file("log");
  RunLog(path, true).write({});
  const std::string once = contents(path), header = once.substr(0, once.find('\n') + 1);
  EXPECT_TRUE(header.starts_with("update\t"));
  RunLog(path, true).write({});
  EXPECT_EQ(contents(path), once + once.substr(header.size()));
  RunLog(path, false).write({});
  EXPECT_EQ(contents(path), once);
}

TEST(RunLog, NamesWhatFails) {
  const TemporaryFolder folder;
  RunLog("", false).write({});
  RunLog full("/dev/full", false);
  EXPECT_FALSE(full.failed());
  full.check();
  full.write({});
  EXPECT_TRUE(full.failed());
  full.write({});
  EXPECT_EQ(thrown([&] { full.check(); }), "74 cannot write '/dev/full': No space left on device");
  EXPECT_EQ(thrown([&] { RunLog none(folder.file("a/b"), false); }),
            "73 cannot create '" + folder.file("a/b") + "': No such file or directory");
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

TEST(GoldenV1, Matrix) {
  Input input(std::string(kGolden) + "matrix.tsv");
  const Matrix matrix = read_matrix(input);
  ASSERT_EQ(matrix.rows.size(), 4u);
  EXPECT_TRUE(matrix.has_part);
  const MatrixRow& row = matrix.rows[1];
  EXPECT_EQ(row.run, "e0507b4a3a05fe54");
  EXPECT_EQ(row.env + " " + row.task, "map1 B-G");
  EXPECT_EQ(row.window, 2);
  EXPECT_EQ(row.successes + 10 * row.wrong + 100 * row.timeouts + 1000 * row.episodes, 3111);
  EXPECT_EQ(row.reward, -1.55);
  EXPECT_EQ(row.length, 355);
  EXPECT_TRUE(matrix.rows[0].seen);
  EXPECT_EQ(matrix.rows[3].part, "rest");
}

TEST(GoldenV1, Pairs) {
  Input input(std::string(kGolden) + "pairs.tsv");
  const std::vector<PairRow> rows = read_pairs(input);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].env + " " + rows[0].task, "map1 R-B");
  EXPECT_TRUE(rows[0].seen && rows[2].seen);
  EXPECT_FALSE(rows[1].seen || rows[3].seen);
  EXPECT_EQ(rows[2].part, "Q");
}

}  // namespace
}  // namespace synpo
