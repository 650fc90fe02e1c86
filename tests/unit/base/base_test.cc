#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/folder.h"
#include "base/files/io.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/text.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

// Philox 4x32 as the paper has it, from the definition.
std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  auto [a, b, c, d] = counter;
  for (int round = 0; round < 10; ++round) {
    const uint64_t left = 0xD2511F53ull * a, right = 0xCD9E8D57ull * c;
    a = uint32_t(right >> 32) ^ b ^ key[0];
    b = uint32_t(right);
    c = uint32_t(left >> 32) ^ d ^ key[1];
    d = uint32_t(left);
    key = {key[0] + 0x9E3779B9, key[1] + 0xBB67AE85};
  }
  return {a, b, c, d};
}

TEST(Random, IsPhilox) {
  // Known answers of the Random123 distribution.
  using Block = std::array<uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}), (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));

  Random zero(0, Purpose{0});
  for (const uint32_t word : {0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}) EXPECT_EQ(zero.next(), word);
  Random random(0x123456789abcdef0, Purpose::kNoise, 17, 4711);
  for (uint32_t block = 0; block < 50; ++block)
    for (const uint32_t word : philox({block, 17, 4711, uint32_t(Purpose::kNoise)},
                                      {0x9abcdef0, 0x12345678 ^ uint32_t(Purpose::kNoise) << 24}))
      ASSERT_EQ(random.next(), word);
}

TEST(Random, StreamsDifferByEverythingThatNamesThem) {
  std::set<std::pair<uint32_t, uint32_t>> firsts;
  size_t streams = 0;
  for (const uint64_t seed : {0ull, 1ull, 1ull << 32, ~0ull})
    for (const Purpose purpose : {Purpose::kPairOrder, Purpose::kEpisodeStart, Purpose::kNoise, Purpose::kSplit})
      for (const uint64_t a : {0, 1, 399})
        for (const uint64_t b : {0ull, 1ull, 1ull << 31, 1ull << 32, (1ull << 32) + 1, 1ull << 62}) {
          Random random(seed, purpose, a, b);
          const uint32_t first = random.next();
          firsts.insert({first, random.next()});
          ++streams;
        }
  EXPECT_EQ(firsts.size(), streams);
}

TEST(Random, BelowIsUnbiased) {
  Random random(1, Purpose::kBatch);
  constexpr int kDraws = 70000;
  int count[7] = {};
  for (int i = 0; i < kDraws; ++i) ++count[random.below(7)];
  for (const int c : count) EXPECT_NEAR(c, kDraws / 7, 5 * std::sqrt(kDraws / 7.0));
  EXPECT_EQ(random.below(1), 0u);
  // Without rejection a product with 3/4 of 2^32 would make every third number twice as likely as the others.
  int thirds[3] = {};
  for (int i = 0; i < 30000; ++i) ++thirds[random.below(3u << 30) % 3];
  for (const int c : thirds) EXPECT_NEAR(c, 10000, 500);
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  Random random(2, Purpose::kInit);
  constexpr int kDraws = 100000;
  double sum = 0, squares = 0, normal_sum = 0, normal_squares = 0, normal_fourth = 0, neighbours = 0, before = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u;
    squares += u * u;
  }
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    normal_sum += z;
    normal_squares += z * z;
    normal_fourth += z * z * z * z;
    neighbours += z * before;
    before = z;
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.005);
  EXPECT_NEAR(squares / kDraws, 1 / 3.0, 0.005);
  EXPECT_NEAR(normal_sum / kDraws, 0, 0.016);
  EXPECT_NEAR(normal_squares / kDraws, 1, 0.025);
  EXPECT_NEAR(normal_fourth / kDraws, 3, 0.16);
  EXPECT_NEAR(neighbours / kDraws, 0, 0.016);
}

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

TEST(Quoted, ShowsForeignInputSafely) {
  EXPECT_EQ(quoted("map1"), "'map1'");
  EXPECT_EQ(quoted(""), "''");
  EXPECT_EQ(quoted("a\tb\n\x1b[31m\x7f"), "'a\\x09b\\x0a\\x1b[31m\\x7f'");
  EXPECT_EQ(quoted("\xc3\xa9\xff\xc3"), "'\xc3\xa9\\xff\\xc3'");
  EXPECT_EQ(quoted("\xc2\x9b"), "'\\xc2\\x9b'");         // a C1 control character
  EXPECT_EQ(quoted("a\u202eb"), "'a\\xe2\\x80\\xaeb'");  // turns the direction
  EXPECT_EQ(quoted(std::string("\0x", 2)), "'\\x00x'");
  const std::string cut = quoted(std::string(1000, 'a'));
  EXPECT_LT(cut.size(), 70u);
  EXPECT_TRUE(cut.ends_with("a...'"));
}

TEST(Hash, IsFnv1a) {
  EXPECT_EQ(Hash().value(), 0xcbf29ce484222325u);
  EXPECT_EQ(Hash().add("a").value(), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(Hash().add("foobar").value(), 0x85944171f73967e8u);
  EXPECT_EQ(Hash::resume(Hash().add("foo").value()).add("bar").value(), 0x85944171f73967e8u);
}

TEST(Hash, HexBothWays) {
  for (const uint64_t value : {0ull, 0x85944171f73967e8ull, ~0ull}) EXPECT_EQ(parse_hex(hex(value)), value);
  EXPECT_EQ(hex(0xab), "00000000000000ab");
  for (const char* bad : {"", "ab", "00000000000000AB", "00000000000000ag", "00000000000000abc"})
    EXPECT_EQ(thrown([&] { parse_hex(bad); }),
              concat("65 found '", bad, "', expected a hash of 16 hexadecimal digits"));
}

TEST(Input, GivesLines) {
  read_text("one\n\n" + std::string(200000, 'x') + "\nlast", [](Input& input) {
    std::string line;
    EXPECT_TRUE(input.line(line) && line == "one");
    EXPECT_EQ(input.line_number(), 1u);
    EXPECT_EQ(input.offset(), 4u);
    EXPECT_TRUE(input.line(line) && line.empty());
    EXPECT_TRUE(input.line(line) && line == std::string(200000, 'x'));
    EXPECT_TRUE(input.line(line) && line == "last");
    EXPECT_EQ(thrown([&] { input.bad_line("no good"); }), "65 IN: line 4: no good");
    EXPECT_FALSE(input.line(line));
    EXPECT_EQ(input.line_number(), 4u);
    return 0;
  });
}

TEST(Input, LimitsLines) {
  read_text("12345\n123456\n", [](Input& input) {
    std::string line;
    EXPECT_TRUE(input.line(line, 5));
    EXPECT_EQ(thrown([&] { input.line(line, 5); }), "65 IN: line 2: longer than 5 bytes");
    return 0;
  });
  read_text(std::string(100000, 'x'), [](Input& input) {
    std::string line;
    EXPECT_EQ(thrown([&] { input.line(line, 99999); }), "65 IN: line 1: longer than 99999 bytes");
    return 0;
  });
}

TEST(Input, GivesBytes) {
  const std::string text = "abc" + std::string(100000, 'y');
  read_text(text, [&](Input& input) {
    char three[3];
    EXPECT_EQ(input.read(three, 3), 3u);
    EXPECT_EQ(std::string(three, 3), "abc");
    EXPECT_EQ(input.rest(100000), std::string(100000, 'y'));
    EXPECT_EQ(input.offset(), text.size());
    EXPECT_EQ(input.read(three, 3), 0u);
    return 0;
  });
  read_text(text, [](Input& input) {
    EXPECT_EQ(thrown([&] { input.rest(100002); }), "65 IN: longer than 100002 bytes");
    return 0;
  });
}

TEST(Input, NamesWhatCannotBeOpened) {
  const TemporaryFolder folder;
  EXPECT_EQ(thrown([&] { Input input(folder.file("none")); }),
            "66 cannot open '" + folder.file("none") + "': No such file or directory");
  EXPECT_EQ(thrown([&] { Input input(folder.path()); }), "66 cannot open '" + folder.path() + "': it is a folder");
}

TEST(Output, TakesItsNameAtTheEnd) {
  const TemporaryFolder folder;
  const std::string path = folder.file("out", "old");
  Output output(path);
  output.write(std::string(100000, 'n'));
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(folder.files(), 2u);
  output.finish();
  EXPECT_EQ(contents(path), std::string(100000, 'n'));
  EXPECT_EQ(folder.files(), 1u);
}

TEST(Output, LeavesNothingBehindWhenUnfinished) {
  const TemporaryFolder folder;
  try {
    Output output(folder.file("out"));
    output.write(std::string(100000, 'n'));
    throw std::runtime_error("in between");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(folder.files(), 0u);
}

TEST(OutputFolder, IsWholeOrNotThere) {
  const TemporaryFolder folder;
  const std::string path = folder.file("pictures");
  { OutputFolder(path).write("1", "one"); }
  EXPECT_EQ(folder.files(), 0u);
  OutputFolder output(path + "/");
  output.write("1", "one");
  output.write("2", "two");
  EXPECT_FALSE(std::filesystem::exists(path));
  output.finish();
  EXPECT_EQ(contents(path + "/1") + contents(path + "/2"), "onetwo");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(OutputFolder, TakesTheNameOfAnEmptyFolderAndOfNothingElse) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("empty"));
  OutputFolder output(folder.file("empty"));
  output.write("1", "one");
  output.finish();
  folder.file("file", "text");
  for (const std::string& path : {folder.file("empty"), folder.file("file"), folder.file("missing/x"), std::string()}) {
    try {
      OutputFolder refused(path);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::kCantCreate) << path;
    }
  }
  EXPECT_EQ(folder.files(), 2u);
}

TEST(Output, AFullDiskIsAnError) {
  EXPECT_EQ(thrown([] { write_file("/dev/full", "x"); }), "74 cannot write '/dev/full': No space left on device");
  EXPECT_EQ(thrown([] {
              Output output("/dev/full");
              output.write(std::string(1 << 20, 'x'));
            }),
            "74 cannot write '/dev/full': No space left on device");
  write_file("/dev/null", "x");
}

TEST(Output, NamesWhatCannotBeMade) {
  const TemporaryFolder folder;
  const std::string path = folder.file("none/out");
  EXPECT_EQ(thrown([&] { Output output(path); }), "73 cannot create '" + path + "': No such file or directory");
  EXPECT_EQ(thrown([&] { Output output(folder.path()); }), "73 cannot create '" + folder.path() + "': Is a directory");
}

TEST(Parallel, RunsEveryShardOnce) {
  for (const int threads : {1, 2, 5}) {
    Parallel parallel(threads);
    ASSERT_EQ(parallel.threads(), threads);
    for (const int shards : {0, 1, 2, 16, 1000}) {
      std::vector<std::atomic<int>> runs(shards);
      std::atomic<bool> known = true;
      parallel.run(shards, [&](int shard, int thread) {
        ++runs[shard];
        if (thread < 0 || thread >= threads) known = false;
      });
      for (const auto& count : runs) ASSERT_EQ(count, 1);
      EXPECT_TRUE(known);
    }
  }
}

TEST(Parallel, ManyShortRounds) {
  Parallel parallel(2);
  for (int round = 0; round < 3000; ++round) {
    std::array<int, 7> done = {};
    parallel.run(7, [&](int shard, int) { done[shard] = round; });
    for (const int d : done) ASSERT_EQ(d, round);
  }
}

TEST(Parallel, PassesExceptionsOn) {
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    for (const int bad : {0, 15})
      EXPECT_EQ(thrown([&] {
                  parallel.run(16, [&](int shard, int) {
                    if (shard == bad) fail(Exit::kData, "shard ", shard);
                  });
                }),
                concat("65 shard ", bad));
    std::atomic<int> sum = 0;
    parallel.run(16, [&](int shard, int) { sum += shard; });
    EXPECT_EQ(sum, 120);
  }
}

TEST(Parallel, DenormalNumbersCountAsZeroInWork) {
  const volatile float tiny = 1e-40f;
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    std::array<float, 16> doubled;
    parallel.run(16, [&](int shard, int) { doubled[shard] = 2 * tiny; });
    for (const float value : doubled) EXPECT_EQ(value, 0);
    EXPECT_GT(2 * tiny, 0);
  }
}

TEST(Parallel, ShardsCoverTheRange) {
  for (const int n : {0, 1, 31, 32, 33, 100}) {
    int next = 0;
    for (int shard = 0; shard < shard_count(n, 32); ++shard) {
      const Range range = shard_range(n, 32, shard);
      EXPECT_EQ(range.begin, next);
      EXPECT_GT(range.size(), 0);
      next = range.end;
    }
    EXPECT_EQ(next, n);
  }
}

TEST(Progress, ShortNumbers) {
  EXPECT_EQ(clock_time(0), "0:00");
  EXPECT_EQ(clock_time(245), "4:05");
  EXPECT_EQ(clock_time(3723), "1:02:03");
  EXPECT_EQ(short_count(512), "512");
  EXPECT_EQ(short_count(0.5), "0.50");
  EXPECT_EQ(short_count(20000), "20.0 k");
  EXPECT_EQ(short_count(1.34e6), "1.3 M");
}

}  // namespace
}  // namespace synpo
