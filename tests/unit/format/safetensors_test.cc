#include "format/safetensors.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "base/half.h"
#include "base/hash.h"
#include "base/random.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

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

// 1, -0, the largest, the smallest, 1/3 and infinity, as the IEEE formats have them.
TEST(SafeTensors, NumbersOfTwoBytesAreReadAsFloats) {
  const uint16_t halves[6] = {0x3c00, 0x8000, 0x7bff, 0x0001, 0x3555, 0x7c00};
  const uint16_t brains[6] = {0x3f80, 0x8000, 0x7f7f, 0x0001, 0x3eab, 0x7f80};
  const auto floats_of = [](const char* type, const uint16_t* bits) {
    std::string file =
        safetensors(concat(R"({"t":{"dtype":")", type, R"(","shape":[2,3],"data_offsets":[0,12]}})"), 12);
    std::memcpy(file.data() + file.size() - 12, bits, 12);
    return tensors_of(file).get<float>("t");
  };
  const std::vector<float> of_halves = floats_of("F16", halves), of_brains = floats_of("BF16", brains);
  EXPECT_EQ(of_halves[0], 1.0f);
  EXPECT_EQ(std::bit_cast<uint32_t>(of_halves[1]), 0x80000000u);
  EXPECT_EQ(of_halves[2], 65504.0f);
  EXPECT_EQ(of_halves[3], 0x1p-24f);
  EXPECT_EQ(of_halves[4], 0.333251953125f);
  EXPECT_FALSE(std::isfinite(of_halves[5]));
  EXPECT_EQ(of_brains[0], 1.0f);
  EXPECT_EQ(std::bit_cast<uint32_t>(of_brains[1]), 0x80000000u);
  EXPECT_EQ(of_brains[2], 0x1.fep127f);
  EXPECT_EQ(of_brains[3], 0x1p-133f);
  EXPECT_EQ(of_brains[4], 0.333984375f);
  EXPECT_FALSE(std::isfinite(of_brains[5]));
  SafeTensors file;
  file.add("t", {1}, reinterpret_cast<const Half*>(halves), 1);
  EXPECT_EQ(thrown([&] { file.get<double>("t"); }), "65 tensor 't': found type F16, expected F64");
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
  // A parser that goes through all members at the end of each takes minutes for these.
  std::string members = "{";
  for (int i = 0; i < 400'000; ++i) members += concat("\"", i, "\":{},");
  EXPECT_EQ(tensors_refused(safetensors(members + "\"a\":{}}", 0)),
            no_safetensors + ": more than 1048576 values and names)");
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
  EXPECT_EQ(tensor_refused(R"("dtype":"BF15","shape":[4],"data_offsets":[0,8])"),
            start + "type '\"BF15\"', this build reads BF16, F16, F32, F64, I32, I64, U8 and U64");
  EXPECT_EQ(tensor_refused(R"("dtype":4,"shape":[4],"data_offsets":[0,8])"),
            start + "type '4', this build reads BF16, F16, F32, F64, I32, I64, U8 and U64");
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

TEST(SafeTensors, TensorsLieOneAfterTheOther) {
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

TEST(SafeTensors, ThatNobodyCouldReadAreNotWritten) {
  SafeTensors wordy;
  wordy.metadata["x"] = std::string(100'000'000, 'x');
  EXPECT_EQ(thrown([&] { format_safetensors(wordy); }),
            "65 a header of 100000032 bytes, readers of the format take 100000000");
  wordy.metadata["x"].resize(100'000'000 - 26);
  EXPECT_EQ(tensors_of(format_safetensors(wordy)).metadata, wordy.metadata);
  SafeTensors many;
  for (int i = 0; i < 120000; ++i) many.tensors[std::to_string(i)].shape = {0};
  EXPECT_EQ(thrown([&] { format_safetensors(many); }), "65 more than 1048576 values and names");
}

TEST(SafeTensors, NumbersWithoutASignAreBitsOfI64) {
  const std::vector<uint64_t> numbers = {0, 7, uint64_t(INT64_MAX) + 1, UINT64_MAX};
  SafeTensors file;
  file.add_bits("n", numbers);
  EXPECT_EQ(file.get<int64_t>("n"), (std::vector<int64_t>{0, 7, INT64_MIN, -1}));
  EXPECT_EQ(file.get_bits("n"), numbers);
  file.add("n", {4}, numbers.data(), 4);
  EXPECT_EQ(file.tensors.at("n").type, TensorType::kU64);
  EXPECT_EQ(file.get_bits("n"), numbers);
  const float floats[1] = {1};
  file.add("n", {1}, floats, 1);
  EXPECT_EQ(thrown([&] { file.get_bits("n"); }), "65 tensor 'n': found type F32, expected I64");
  EXPECT_EQ(thrown([&] { file.get_bits("m"); }), "65 no tensor 'm'");
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

}  // namespace
}  // namespace synpo
