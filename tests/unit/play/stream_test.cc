#include "play/stream.h"

#include <gtest/gtest.h>

#include "helpers/episodes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "learn/recipe.h"

namespace synpo {
namespace {

// Reads a stream to its end; the number of trajectories.
int read_stream(const std::string& text, const std::vector<EnvTask>& seen, int window = -1) {
  return read_text(text, [&](Input& input) {
    TrajectoryStream stream(input, builtin_world(), seen, window);
    int count = 0;
    while (stream.next()) ++count;
    EXPECT_TRUE(stream.ended());
    EXPECT_EQ(stream.lines(), uint64_t(count));
    EXPECT_EQ(stream.hash(), Hash().add(text.substr(0, input.offset())).value());
    return count;
  });
}

std::string stream_refused(const std::string& text, const std::vector<EnvTask>& seen, int window = -1) {
  return thrown([&] { read_stream(text, seen, window); });
}

TEST(Stream, ReadsHashesAndCounts) {
  EXPECT_EQ(read_stream(expert_lines({{0, 0}, {3, 4}}, 6), {}), 6);
  EXPECT_EQ(read_stream(expert_lines({{0, 0}, {3, 4}}, 6), {{0, 0}, {3, 4}, {5, 5}}), 6);
  EXPECT_EQ(read_stream("", {}), 0);
}

TEST(Stream, ErrorsNameTheLine) {
  const std::string two = expert_lines({{0, 0}}, 2);
  EXPECT_EQ(stream_refused(two + expert_lines({{0, 1}}, 1), {{0, 0}}),
            "65 IN: line 3: pair map1, B-G is not in the seen set");
  EXPECT_EQ(stream_refused(two + expert_lines({{0, 0}}, 1, 0, 2), {}),
            "65 IN: line 3: window 2, expected 1 as in the trajectories before");
  EXPECT_EQ(stream_refused(two, {}, 3), "65 IN: line 1: window 1, expected 3 as in the trajectories before");
  EXPECT_EQ(
      stream_refused(two + "{\"format\":", {}),
      "65 IN: line 3: found no JSON (byte 11: while parsing value - unexpected end of input; expected '[', '{', or a "
      "literal), expected a JSON object");
  EXPECT_EQ(stream_refused(two + "\n" + two, {}), "65 IN: line 3: found an empty line, expected a JSON object");
  std::string damaged = two;
  damaged.replace(damaged.rfind("10.99"), 5, "10.98");
  EXPECT_TRUE(stream_refused(damaged, {}).starts_with("65 IN: line 2: replay gives reward 10.99 at step "));
}

TEST(Stream, SkipsWhatWasRead) {
  const std::string text = expert_lines({{0, 0}, {3, 4}}, 6);
  uint64_t hash = 0;
  read_text(text, [&](Input& input) {
    TrajectoryStream stream(input, builtin_world(), {});
    for (int i = 0; i < 4; ++i) stream.next();
    hash = stream.hash();
    return 0;
  });
  read_text(text, [&](Input& input) {
    TrajectoryStream stream(input, builtin_world(), {});
    stream.skip(4, hash);
    EXPECT_EQ(stream.lines(), 4u);
    EXPECT_EQ(stream.next()->actions, expert({0, 0}, 4).actions);
    EXPECT_EQ(stream.next()->actions, expert({3, 4}, 5).actions);
    EXPECT_FALSE(stream.next());
    EXPECT_EQ(stream.hash(), Hash().add(text).value());
    return 0;
  });
  const auto skip_refused = [&](const std::string& other, uint64_t lines) {
    return read_text(other, [&](Input& input) {
      TrajectoryStream stream(input, builtin_world(), {});
      return thrown([&] { stream.skip(lines, hash); });
    });
  };
  EXPECT_EQ(skip_refused(expert_lines({{0, 0}, {3, 5}}, 6), 4),
            "65 IN: the first 4 lines are not those that the checkpoint was trained on");
  EXPECT_EQ(skip_refused(text, 3), "65 IN: the first 3 lines are not those that the checkpoint was trained on");
  EXPECT_EQ(skip_refused(expert_lines({{0, 0}, {3, 4}}, 3), 4),
            "65 IN: it ends at line 3, but the checkpoint has read 4 lines: another stream?");
}

}  // namespace
}  // namespace synpo
