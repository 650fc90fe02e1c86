#include "learn/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "helpers/episodes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

TEST(Memory, KeepsTheLast) {
  ReplayMemory memory(5);
  for (int i = 0; i < 12; ++i) {
    memory.add(expert({0, i}, 0));
    EXPECT_EQ(memory.size(), size_t(std::min(i + 1, 5)));
  }
  std::set<int> tasks;
  for (size_t i = 0; i < memory.size(); ++i) {
    tasks.insert(memory[i].pair.task);
    EXPECT_EQ(memory.serial(i), uint64_t(memory[i].pair.task));
  }
  EXPECT_EQ(tasks, (std::set<int>{7, 8, 9, 10, 11}));
}

SafeTensors saved(const ReplayMemory& memory) {
  SafeTensors file;
  memory.save(file, "m/", builtin_world());
  return file;
}

TEST(Memory, ComesBack) {
  for (const int added : {0, 3, 5, 13}) {
    ReplayMemory memory(5), loaded(5);
    for (int i = 0; i < added; ++i) memory.add(expert({i % 20, i % 20}, i, 0.3));
    loaded.load(saved(memory), "m/", builtin_world());
    for (int more = 0; more < 3; ++more) {
      ASSERT_EQ(loaded.size(), memory.size());
      for (size_t i = 0; i < memory.size(); ++i) {
        EXPECT_EQ(loaded[i].pair, memory[i].pair);
        EXPECT_EQ(loaded[i].start, memory[i].start);
        EXPECT_EQ(loaded[i].actions, memory[i].actions);
        EXPECT_EQ(loaded[i].labels, memory[i].labels);
        EXPECT_EQ(loaded.serial(i), memory.serial(i));
      }
      loaded.add(expert({19, 19}, more));
      memory.add(expert({19, 19}, more));
    }
  }
}

TEST(Memory, RefusesWhatNoMemoryWrote) {
  ReplayMemory memory(5);
  for (int i = 0; i < 3; ++i) memory.add(expert({i, i}, i));
  const SafeTensors good = saved(memory);
  const auto refused = [&](const std::function<void(SafeTensors&)>& change) {
    SafeTensors file = good;
    change(file);
    ReplayMemory other(5);
    return thrown([&] { other.load(file, "m/", builtin_world()); });
  };
  const std::string malformed = "65 tensor 'm/episodes' is malformed";
  const std::vector<uint8_t> bytes = good.get<uint8_t>("m/episodes");
  for (size_t size = 1; size < bytes.size(); ++size)
    ASSERT_EQ(refused([&](SafeTensors& file) { file.add("m/episodes", {int64_t(size)}, bytes.data(), size); }),
              malformed)
        << size;
  for (const auto& [at, value] : {std::pair{0, 20}, {1, 1}, {2, 20}, {3, 0}, {4, 255}, {10, 2}, {11, 5}}) {
    std::vector<uint8_t> damaged = bytes;
    damaged[at] = uint8_t(value);
    EXPECT_EQ(refused([&](SafeTensors& file) {
                file.add("m/episodes", {int64_t(bytes.size())}, damaged.data(), bytes.size());
              }),
              malformed)
        << at;
  }
  ReplayMemory after_its_end(5);
  Episode longer = expert({0, 0}, 0);
  for (std::vector<uint8_t>* actions : {&longer.actions, &longer.labels}) actions->push_back(0);
  after_its_end.add(longer);
  EXPECT_EQ(refused([&](SafeTensors& file) { file = saved(after_its_end); }), malformed);
  const uint64_t serials[4] = {0, 1, 2, 3};
  EXPECT_EQ(refused([&](SafeTensors& file) { file.add("m/serials", {4}, serials, 4); }), malformed);
  for (const uint64_t added : {0, 2, 4, 100})
    EXPECT_EQ(refused([&](SafeTensors& file) { file.add("m/added", {1}, &added, 1); }), malformed) << added;
  EXPECT_EQ(refused([](SafeTensors& file) { file.tensors.erase("m/added"); }), "65 no tensor 'm/added'");
  ReplayMemory small(2);
  EXPECT_EQ(thrown([&] { small.load(good, "m/", builtin_world()); }), malformed);
}

}  // namespace
}  // namespace synpo
