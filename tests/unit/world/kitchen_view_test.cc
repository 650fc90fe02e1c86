#include "world/kitchen/view/view.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <thread>

#include "base/hash.h"
#include "helpers/kitchens.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/view/features.h"

namespace synpo {
namespace {

using Picture = std::vector<uint8_t>;

Picture picture(const KitchenSolids& solids, const KitchenFrame& frame, int side) {
  Picture rgb(size_t(side * side * 3), 77);
  render(solids, frame, side, side, rgb.data());
  return rgb;
}

Picture small_picture(const KitchenSolids& solids, const KitchenFrame& frame) {
  Picture rgb(size_t(kSmallView * kSmallView * 3), 99);
  render_small(solids, frame, rgb.data());
  return rgb;
}

// A state in the middle of something: any pose, any doors, sometimes with an object in the hand.
KitchenState any_state(int env, uint64_t number) {
  Random random(11, Purpose::kEpisodeStart, uint64_t(env), number);
  KitchenState state = unpack(all_kitchens().reset(env, random));
  state.pose = uint16_t(random.below(uint32_t(all_kitchens().tables(env).poses.size())));
  state.doors = uint8_t(random.below(kDoorStates));
  if (random.below(2)) {
    state.hand = uint8_t(random.below(kKitchenObjects));
    state.slots[state.hand] = kNoSlot;
  }
  return state;
}

KitchenFrame any_frame(int env, uint64_t number) { return all_kitchens().frame(env, pack(any_state(env, number))); }

TEST(KitchenView, AgreesWithWhatIsVisible) {
  constexpr int kSide = 128;
  std::array<int, kKitchenObjects> objects = {};
  std::array<int, kKitchenReceptacles> receptacles = {};
  static constexpr Material materials[] = {Material::kFridge, Material::kMicrowave, Material::kSink};
  for (int i = 0; i < 250; ++i) {
    const int env = i % all_kitchens().envs();
    const KitchenTables& tables = all_kitchens().tables(env);
    Random random(12, Purpose::kNoise, 0, uint64_t(i));
    const int pose = int(random.below(uint32_t(tables.pose_count())));
    KitchenFrame frame;
    frame.eye = tables.poses[size_t(pose)];
    const Picture empty = picture(all_kitchens().solids(env), frame, kSide);
    const auto slots = tables.sight[0]->slots.at(pose);
    if (!slots.empty()) {
      const size_t object = random.below(kKitchenObjects);
      const KitchenCell& slot = tables.slots[slots[random.below(uint32_t(slots.size()))].index];
      frame.objects[object] = int16_t(ray_cell(slot.row, slot.column));
      ASSERT_NE(picture(all_kitchens().solids(env), frame, kSide), empty) << i;
      ++objects[object];
    }
    for (const KitchenSeen& seen : tables.sight[0]->receptacles.at(pose)) {
      const Camera camera(frame.eye.heading / 90, frame.eye.horizon);
      const SolidsView view = {&all_kitchens().solids(env), float(frame.eye.column) + 0.5f, float(frame.eye.row) + 0.5f,
                               all_kitchens().solids(env).reach.data(), nullptr};
      int pixels = 0;
      for (int at = 0; at < kSide * kSide; ++at) {
        const float u = kViewSlope * (float(at % kSide * 2 + 1) / kSide - 1),
                    v = kViewSlope * (float(at / kSide * 2 + 1) / kSide - 1);
        const Vec3 d = {camera.forward.x + u * camera.right.x + v * camera.up.x,
                        camera.forward.y + u * camera.right.y + v * camera.up.y,
                        camera.forward.z + u * camera.right.z + v * camera.up.z};
        pixels += trace(view, ray_cell(frame.eye.row, frame.eye.column), d).material == materials[seen.index];
      }
      ASSERT_GT(pixels, 0);
      ++receptacles[seen.index];
    }
  }
  for (const int count : objects) EXPECT_GT(count, 0);
  for (const int count : receptacles) EXPECT_GT(count, 0);
}

TEST(KitchenView, ShowsWhetherAVisibleDoorIsOpen) {
  int doors = 0;
  for (int env = 0; env < all_kitchens().envs(); ++env) {
    const KitchenTables& tables = all_kitchens().tables(env);
    for (int pose = env % 5; pose < tables.pose_count(); pose += 5)
      for (const KitchenSeen& seen : tables.sight[0]->receptacles.at(pose)) {
        if (seen.index >= kKitchenDoors) continue;
        KitchenFrame frame;
        frame.eye = tables.poses[size_t(pose)];
        const Picture closed = small_picture(all_kitchens().solids(env), frame);
        frame.doors = uint8_t(1 << seen.index);
        ASSERT_NE(small_picture(all_kitchens().solids(env), frame), closed) << env << " pose " << pose;
        ++doors;
      }
  }
  EXPECT_GT(doors, 100);
}

TEST(KitchenView, ShowsNothingFromBehindNorFromTheHand) {
  const KitchenSolids solids(small_kitchen());
  KitchenFrame frame;
  frame.eye = {4, 4, 180, 0};
  const Picture empty = picture(solids, frame, 64);
  frame.objects[3] = int16_t(ray_cell(1, 1));
  EXPECT_EQ(picture(solids, frame, 64), empty);
  KitchenState state = any_state(0, 1);
  state.hand = 3;
  state.slots[3] = kNoSlot;
  EXPECT_EQ(all_kitchens().frame(0, pack(state)).objects[3], -1);
  const KitchenCell& mug = all_kitchens().tables(0).slots[state.slots[2]];
  EXPECT_EQ(all_kitchens().frame(0, pack(state)).objects[2], ray_cell(mug.row, mug.column));
}

TEST(KitchenView, AnObjectIsDrawnInItsColourWhereItLies) {
  const KitchenSolids solids(small_kitchen());
  KitchenFrame frame;
  frame.eye = {4, 1, 0, 0};  // before the counter cell (2, 1), half a metre away
  frame.eye.horizon = 30;
  for (size_t object = 0; object < kKitchenObjects; ++object) {
    frame.objects.fill(-1);
    frame.objects[object] = int16_t(ray_cell(2, 1));
    const Picture rgb = picture(solids, frame, 101);
    // Its middle in the camera's axes: ahead 2 cells, 2.2 down.
    const float depth = 2 * 0.8660254f + 2.2f * 0.5f, up = 2 * 0.5f - 2.2f * 0.8660254f;
    const int row = int(50.5f - 50.5f * up / depth / kViewSlope);
    int found = 0;
    for (int at = row - 6; at <= row + 6; ++at)
      for (const Colour& colour : kObjectColours[object]) {
        const uint8_t* pixel = rgb.data() + (at * 101 + 50) * 3;
        const float scale = std::max({colour.r, colour.g, colour.b}) / float(std::max({pixel[0], pixel[1], pixel[2]}));
        found += std::abs(pixel[0] * scale - colour.r) < 4 && std::abs(pixel[1] * scale - colour.g) < 4 &&
                 std::abs(pixel[2] * scale - colour.b) < 4;
      }
    EXPECT_GT(found, 5) << kKitchenObjectNames[object];
  }
}

TEST(KitchenView, AnObjectStandsOutAboveItsCounter) {
  const KitchenSolids solids(small_kitchen());
  KitchenFrame frame;
  frame.eye = {7, 1, 0, 0};
  frame.objects[1] = int16_t(ray_cell(2, 1));
  // The Lettuce from five cells away: its front, 4.76 cells ahead, up to 1.72 below the eye, where the ray passes its
  // cell above the counter.
  const Picture rgb = picture(solids, frame, 101);
  const uint8_t* pixel = rgb.data() + (int(50.5f + 50.5f * (1.8f / 4.76f) / kViewSlope) * 101 + 50) * 3;
  EXPECT_GT(pixel[1], 3 * pixel[0]);
  EXPECT_GT(pixel[1], 3 * pixel[2]);
}

TEST(KitchenView, AnOpenDoorShowsADarkInside) {
  const KitchenSolids solids(small_kitchen());
  for (const int receptacle : {kFridge, kMicrowave}) {
    KitchenFrame frame;
    frame.eye = receptacle == kFridge ? KitchenPose{7, 2, 0, 0} : KitchenPose{4, 4, 180, 0};
    const auto dark_pixels = [&] {
      const Picture rgb = picture(solids, frame, 101);
      int dark = 0;
      for (size_t at = 0; at < rgb.size(); at += 3) dark += rgb[at] < 24 && rgb[at + 1] < 24 && rgb[at + 2] < 24;
      return dark;
    };
    EXPECT_EQ(dark_pixels(), 0);
    frame.doors = uint8_t(1 << receptacle);
    EXPECT_GT(dark_pixels(), receptacle == kFridge ? 600 : 150);
    frame.doors = uint8_t(3 - frame.doors);
    EXPECT_EQ(dark_pixels(), 0);
  }
}

TEST(KitchenView, ColoursDiffer) {
  std::vector<Colour> strong(kReceptacleColours.begin(), kReceptacleColours.end());
  for (const auto& object : kObjectColours) strong.push_back(object[0]);
  for (size_t i = 0; i < strong.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Colour &a = strong[i], &b = strong[j];
      EXPECT_GT(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 80) << i << " and " << j;
    }
}

TEST(KitchenView, StoredRaysDrawTheSamePicture) {
  for (uint64_t i = 0; i < 400; ++i) {
    const int env = int(i) % all_kitchens().envs();
    const KitchenFrame frame = any_frame(env, i);
    ASSERT_EQ(small_picture(all_kitchens().solids(env), frame), picture(all_kitchens().solids(env), frame, kSmallView))
        << i;
  }
}

std::vector<float> features_of(const Picture& rgb) {
  std::vector<float> features(kViewFeatures);
  extract_features(rgb.data(), features.data());
  return features;
}

TEST(KitchenFeatures, AreOfTheExtractorThatFilesName) { EXPECT_EQ(hex(extractor_hash()), "097a5f6eeea27681"); }

// Holds a cell's 64 features to those of the bins named, and zero.
void expect_bins(const std::vector<float>& features, int cell, const std::map<int, float>& want) {
  for (int bin = 0; bin < 64; ++bin) {
    const auto found = want.find(bin);
    EXPECT_NEAR(features[size_t(cell * 64 + bin)], found == want.end() ? 0 : found->second, 1e-5)
        << "cell " << cell << ", bin " << bin;
  }
}

TEST(KitchenFeatures, AreSoftHistogramsOfCells) {
  Picture rgb(kSmallView * kSmallView * 3, 0);
  for (int cell = 0; cell < 32; ++cell) expect_bins(features_of(rgb), cell, {{0, 8.0f}});
  // Rows 8 to 11 and columns 16 to 23 are cell (2, 2): a quarter of it white, another quarter between two levels of red
  // and at a level of blue.
  const auto paint = [&](int y, Colour colour) {
    for (int x = 16; x < 24; ++x) {
      uint8_t* pixel = rgb.data() + (y * kSmallView + x) * 3;
      pixel[0] = uint8_t(colour.r);
      pixel[1] = uint8_t(colour.g);
      pixel[2] = uint8_t(colour.b);
    }
  };
  paint(8, {255, 255, 255});
  paint(9, {102, 0, 170});  // a fifth of the way from the second to the third level
  const std::vector<float> features = features_of(rgb);
  const std::map<int, float> painted = {{0, 8 * std::sqrt(0.5f)},
                                        {16 + 2, 8 * std::sqrt(0.8f / 4)},
                                        {32 + 2, 8 * std::sqrt(0.2f / 4)},
                                        {63, 8 * std::sqrt(0.25f)}};
  for (int cell = 0; cell < 32; ++cell)
    expect_bins(features, cell, cell == 2 * 4 + 2 ? painted : std::map<int, float>{{0, 8.0f}});
}

TEST(KitchenFeatures, TellVisibleThingsApart) {
  int same = 0, objects = 0;
  for (int i = 0; i < 3000; ++i) {
    const int env = i % all_kitchens().envs();
    const KitchenTables& tables = all_kitchens().tables(env);
    Random random(13, Purpose::kNoise, 0, uint64_t(i));
    const int pose = int(random.below(uint32_t(tables.pose_count())));
    const auto slots = tables.sight[0]->slots.at(pose);
    if (slots.empty()) continue;
    KitchenFrame frame;
    frame.eye = tables.poses[size_t(pose)];
    const KitchenCell& slot = tables.slots[slots[random.below(uint32_t(slots.size()))].index];
    const size_t one = random.below(kKitchenObjects),
                 other = (one + 1 + random.below(kKitchenObjects - 1)) % kKitchenObjects;
    frame.objects[one] = int16_t(ray_cell(slot.row, slot.column));
    const std::vector<float> with_one = features_of(small_picture(all_kitchens().solids(env), frame));
    std::swap(frame.objects[one], frame.objects[other]);
    same += with_one == features_of(small_picture(all_kitchens().solids(env), frame));
    ++objects;
  }
  EXPECT_GT(objects, 500);
  EXPECT_LE(same, objects / 200);  // a plate's edge may fall between the rays
}

TEST(KitchenFeatures, DoNotDependOnWhatIsKeptNorOnThreads) {
  constexpr int kViews = 1500;  // more than are kept
  std::vector<std::vector<float>> expected;
  for (uint64_t i = 0; i < kViews; ++i) {
    const int env = int(i % 3);
    expected.push_back(features_of(small_picture(all_kitchens().solids(env), any_frame(env, i / 2))));
  }
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (size_t thread = 0; thread < wrong.size(); ++thread)
    threads.emplace_back([&, thread] {
      for (int n = 0; n < 2 * kViews; ++n) {
        const uint64_t i = uint64_t(n / 2) * (thread * 6 + 1) % kViews;  // every view twice
        const int env = int(i % 3);
        wrong[thread] += std::memcmp(view_features(all_kitchens().solids(env), any_frame(env, i / 2)),
                                     expected[i].data(), kViewFeatures * sizeof(float)) != 0;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

// Frames that are alike in many kitchens.
TEST(KitchenFeatures, AreOfTheirOwnKitchen) {
  int views = 0;
  for (int16_t row = 4; row < 8; ++row)
    for (int16_t heading = 0; heading < 360; heading += 90)
      for (uint8_t doors = 0; doors < kDoorStates; ++doors)
        for (int env = 0; env < all_kitchens().envs(); ++env) {
          if (pose_at(all_kitchens().tables(env), row, 5, heading, 0) < 0) continue;
          KitchenFrame frame;
          frame.eye = {row, 5, heading, 0};
          frame.doors = doors;
          const float* features = view_features(all_kitchens().solids(env), frame);
          ASSERT_TRUE(std::equal(features, features + kViewFeatures,
                                 features_of(small_picture(all_kitchens().solids(env), frame)).begin()));
          ++views;
        }
  EXPECT_GT(views, 500);
}

TEST(KitchenSet, ObservesTheLastFourViewsAndTheHand) {
  ASSERT_EQ(all_kitchens().observation_size(), (4 * 2048 + 16) * 4u);
  const int env = 3;
  StateHistory history;
  std::vector<WorldState> states;
  for (uint64_t step = 0; step < 7; ++step) {
    states.push_back(pack(any_state(env, step)));
    history.push(states.back());
    std::vector<uint8_t> bytes(all_kitchens().observation_size() + 1, 0x5a);
    all_kitchens().observe(env, history, 1, bytes.data() + 1);  // nobody promises that it is aligned
    std::vector<float> observation(all_kitchens().observation_size() / sizeof(float));
    std::memcpy(observation.data(), bytes.data() + 1, all_kitchens().observation_size());
    for (int view = 0; view < 4; ++view) {
      const int of = int(step) - 3 + view;
      const std::vector<float> expected =
          of < 0
              ? std::vector<float>(kViewFeatures, 0)
              : features_of(small_picture(all_kitchens().solids(env), all_kitchens().frame(env, states[size_t(of)])));
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), observation.begin() + view * kViewFeatures))
          << step << " " << view;
    }
    ASSERT_EQ(observation[4 * kViewFeatures], float(unpack(states.back()).hand));
    for (int i = 1; i < ObservationSpec::kObjectFloats; ++i) ASSERT_EQ(observation[size_t(4 * kViewFeatures + i)], 0);
  }
}

}  // namespace
}  // namespace synpo
