#include "play/serve/episode_server.h"

#include <gtest/gtest.h>

#include <cstring>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>

#include "helpers/episodes.h"
#include "helpers/kitchens.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "play/episode.h"

namespace synpo {
namespace {

// Numbers as they are sent.
struct Bytes {
  template <class T>
  Bytes& add(T number) {
    text.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
  std::string text;
};

std::string reset_request(uint32_t place, EnvTask pair, uint64_t seed, uint64_t episode, uint8_t use) {
  return Bytes{"r"}.add(place).add(uint32_t(pair.env)).add(uint32_t(pair.task)).add(seed).add(episode).add(use).text;
}

std::string step_request(uint32_t place, uint8_t action) {
  return Bytes{"s"}.add(uint32_t{1}).add(place).add(action).text;
}

std::string expert_request(uint32_t place) { return Bytes{"x"}.add(uint32_t{1}).add(place).text; }

// All answers to these requests, the greeting first.
std::string answers(const World& world, const std::string& requests, int window = 1) {
  return read_text(requests, [&](Input& input) {
    const TemporaryFolder folder;
    Output output(folder.file("out"), Output::Kind::kStream);
    EpisodeServer(world, {{0, 1}, {2, 3}}, window).serve(input, output);
    output.finish();
    return contents(folder.file("out"));
  });
}

std::string refused(const std::string& requests) {
  return thrown([&] { answers(builtin_world(), requests); });
}

TEST(EpisodeServer, GreetsWithWhatItPlays) {
  const std::string line = answers(builtin_world(), "", 2);
  ASSERT_EQ(line.find('\n'), line.size() - 1);
  const nlohmann::json greeting = nlohmann::json::parse(line);
  EXPECT_EQ(greeting["format"], "synpo-play");
  EXPECT_EQ(greeting["window"], 2);
  EXPECT_EQ(greeting["step_limit"], 300);
  EXPECT_EQ(greeting["envs"].size(), 20u);
  EXPECT_EQ(greeting["envs"][2]["name"], "map3");
  EXPECT_EQ(greeting["actions"].size(), 5u);
  EXPECT_EQ(greeting["pairs"], (nlohmann::json{{0, 1}, {2, 3}}));
  EXPECT_EQ(greeting["observation"]["bytes"], 16 * 16 * 4);
  EXPECT_EQ(greeting["observation"]["palette"][0], (nlohmann::json{0, 0, 0}));
}

// Of both worlds, in a place beyond the first, after another episode has gone on there.
TEST(EpisodeServer, PlaysAnEpisodeAsTheExpertPlayedIt) {
  for (const World* world : std::initializer_list<const World*>{&builtin_world(), &all_kitchens()}) {
    const EnvTask pair = {3, 7};
    const int window = 2;
    const Trajectory played = expert_episode(*world, pair, 5, 9, 0.3, window);
    const std::vector<uint8_t>& labels = played.labels.empty() ? played.actions : played.labels;
    std::string requests = reset_request(3, {0, 0}, 1, 0, 1) + step_request(3, 0) + reset_request(3, pair, 5, 9, 0);
    for (const uint8_t action : played.actions) requests += expert_request(3) + step_request(3, action);
    const std::string all = answers(*world, requests, window);

    const size_t size = world->observation_size();
    const char* at = all.data() + all.find('\n') + 1 + size + 5 + size;
    RunningEpisode episode;
    episode.start(pair, episode_start(*world, pair, 5, Purpose::kEpisodeStart, 9));
    std::vector<uint8_t> observation(size);
    const auto observes = [&] {
      episode.observe(*world, window, observation.data());
      ASSERT_EQ(std::memcmp(at, observation.data(), size), 0);
      at += size;
    };
    observes();
    for (size_t i = 0; i < played.actions.size(); ++i) {
      ASSERT_EQ(uint8_t(*at++), labels[i]);
      int32_t reward;
      std::memcpy(&reward, at, sizeof reward);
      ASSERT_EQ(reward, played.reward_cents[i]);
      at += sizeof reward;
      const bool last = i + 1 == played.actions.size();
      ASSERT_EQ(int(*at++), last ? played.success + 2 * played.terminated + 4 * played.truncated : 0) << i;
      episode.step(*world, played.actions[i]);
      observes();
    }
    EXPECT_EQ(at, all.data() + all.size());
  }
}

TEST(EpisodeServer, AnswersForSeveralPlacesAtOnce) {
  const std::string begin = reset_request(0, {0, 1}, 1, 0, 0) + reset_request(1, {2, 3}, 1, 0, 0);
  const std::string both =
      Bytes{"s"}.add(uint32_t{2}).add(uint32_t{1}).add(uint32_t{0}).add(uint8_t{2}).add(uint8_t{3}).text;
  const std::string together = answers(builtin_world(), begin + both),
                    apart = answers(builtin_world(), begin + step_request(1, 2) + step_request(0, 3));
  ASSERT_EQ(together.size(), apart.size());
  const size_t size = builtin_world().observation_size(), from = together.size() - 2 * (5 + size);
  EXPECT_EQ(together.substr(from, 4), apart.substr(from, 4));
  EXPECT_EQ(together.substr(from + 4, 4), apart.substr(from + 5 + size, 4));
  EXPECT_EQ(together.substr(from + 10, size), apart.substr(from + 5, size));
  EXPECT_EQ(together.substr(from + 10 + size), apart.substr(from + 10 + size));
}

TEST(EpisodeServer, StartsAreThoseOfTheirUse) {
  std::set<std::string> starts;
  const size_t size = builtin_world().observation_size();
  for (const uint8_t use : {0, 1, 2}) {
    const std::string all = answers(builtin_world(), reset_request(0, {4, 4}, 2, 3, use));
    const Purpose purpose[] = {Purpose::kEpisodeStart, Purpose::kEvaluation, Purpose::kTrainingStart};
    RunningEpisode episode;
    episode.start({4, 4}, episode_start(builtin_world(), {4, 4}, 2, purpose[use], 3));
    std::string expected(size, '\0');
    episode.observe(builtin_world(), 1, reinterpret_cast<uint8_t*>(expected.data()));
    EXPECT_EQ(all.substr(all.size() - size), expected) << int(use);
    starts.insert(expected);
  }
  EXPECT_EQ(starts.size(), 3u);
}

TEST(EpisodeServer, RefusesWhatItCannotAnswer) {
  const std::string begun = reset_request(0, {0, 1}, 1, 0, 0);
  EXPECT_EQ(refused("q"), "65 IN: byte 1: found the request 113, expected r, s or x");
  for (size_t size = 1; size < begun.size(); ++size)
    EXPECT_EQ(refused(begun.substr(0, size)), concat("65 IN: it ends at byte ", size, ", in the middle of a request"));
  EXPECT_EQ(refused(reset_request(65536, {0, 0}, 1, 0, 0)),
            "65 IN: byte 30: the place: found 65536, expected a whole number from 0 to 65535");
  EXPECT_EQ(refused(reset_request(0, {20, 0}, 1, 0, 0)),
            "65 IN: byte 30: the environment: found 20, expected a whole number from 0 to 19");
  EXPECT_EQ(refused(reset_request(0, {0, 20}, 1, 0, 0)),
            "65 IN: byte 30: the task: found 20, expected a whole number from 0 to 19");
  EXPECT_EQ(refused(reset_request(0, {0, 0}, 1, uint64_t(1) << 63, 0)),
            "65 IN: byte 30: the episode: found 9223372036854775808, expected a whole number from 0 to "
            "9223372036854775807");
  EXPECT_EQ(refused(reset_request(0, {0, 0}, 1, 0, 3)),
            "65 IN: byte 30: the use: found 3, expected a whole number from 0 to 2");
  EXPECT_EQ(refused(begun + step_request(0, 5)),
            "65 IN: byte 40: an action: found 5, expected a whole number from 0 to 4");
  EXPECT_EQ(refused(begun + expert_request(1)), "65 IN: byte 39: no episode goes on in the place 1");
  EXPECT_EQ(refused(begun + Bytes{"x"}.add(UINT32_MAX).text),
            "65 IN: byte 35: the number of places: found 4294967295, expected a whole number from 0 to 1");
  // The 300th step ends the episode.
  std::string cut = begun;
  for (int i = 0; i < 300; ++i) cut += step_request(0, 0);
  const std::string all = answers(builtin_world(), cut);
  EXPECT_EQ(all[all.size() - builtin_world().observation_size() - 1], 4);
  EXPECT_EQ(refused(cut + step_request(0, 0)), "65 IN: byte 3039: no episode goes on in the place 0");
}

}  // namespace
}  // namespace synpo
