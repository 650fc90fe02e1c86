#include "play/kitchen_scenes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/files/io.h"
#include "base/half.h"
#include "base/hash.h"
#include "base/random.h"
#include "base/text.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/rules.h"
#include "world/kitchen/view/features.h"

namespace synpo {
namespace {

static_assert(kSceneObjects == kKitchenObjects && kSceneReceptacles == kKitchenReceptacles &&
              kSceneDoors == kDoorStates && kSceneMoves == kKitchenMoves);
static_assert(kSceneFeatures == kViewFeatures && kSceneLimit == kMaxKitchenPoses);

// The things in sight, from distances [poses, things].
KitchenSeenLists seen_lists(const int32_t* distances, size_t poses, size_t things) {
  KitchenSeenLists lists;
  lists.begin.reserve(poses + 1);
  for (size_t pose = 0; pose < poses; ++pose, distances += things) {
    const size_t first = lists.items.size();
    for (size_t i = 0; i < things; ++i)
      if (distances[i] >= 0) lists.items.push_back({uint16_t(distances[i]), uint8_t(i)});
    std::stable_sort(lists.items.begin() + std::ptrdiff_t(first), lists.items.end(),
                     [](const KitchenSeen& a, const KitchenSeen& b) { return a.distance < b.distance; });
    lists.begin.push_back(uint32_t(lists.items.size()));
  }
  return lists;
}

// The inverse: distances [poses, things]; `thing(index)` is the column of a slot or receptacle, or -1.
template <class Thing>
void write_distances(const KitchenSeenLists& lists, size_t poses, size_t things, Thing thing,
                     std::vector<int32_t>& out) {
  for (size_t pose = 0; pose < poses; ++pose) {
    const size_t first = out.size();
    out.resize(first + things, -1);
    for (const KitchenSeen& seen : lists.at(int(pose)))
      if (const int column = thing(seen.index); column >= 0) out[first + size_t(column)] = seen.distance;
  }
}

void write_tables(const KitchenTables& tables, Scene& scene) {
  for (const KitchenPose& pose : tables.poses)
    scene.poses.insert(scene.poses.end(), {pose.row, pose.column, pose.heading, pose.horizon});
  scene.starts.assign(tables.start_poses.begin(), tables.start_poses.end());
  scene.next.assign(tables.next.begin(), tables.next.end());
}

void write_layout(const KitchenTables& tables, const ObjectSlots& slots, Scene& scene) {
  for (const uint8_t slot : slots)
    scene.objects.insert(scene.objects.end(), {tables.slots[slot].row, tables.slots[slot].column});
  for (const auto& sight : tables.sight) {
    const auto object_on = [&](int slot) {
      const auto found = std::find(slots.begin(), slots.end(), slot);
      return found == slots.end() ? -1 : int(found - slots.begin());
    };
    write_distances(sight->slots, tables.poses.size(), kKitchenObjects, object_on, scene.object_distance);
    write_distances(
        sight->receptacles, tables.poses.size(), kKitchenReceptacles, [](int i) { return i; },
        scene.receptacle_distance);
  }
}

// Pictures waiting for their features, and the rows of those that have theirs.
class Rows {
 public:
  Rows(const PictureFeatures& features, Scene& scene) : features_(features), scene_(scene) {}
  int32_t of(const uint8_t* picture) {
    const uint64_t hash = Hash().add(picture, features_.picture_bytes).value();
    const auto [found, fresh] = known_.emplace(hash, int32_t(known_.size()));
    if (fresh) {
      waiting_.insert(waiting_.end(), picture, picture + features_.picture_bytes);
      if (waiting_.size() >= kBatch * features_.picture_bytes) flush();
    }
    return found->second;
  }
  void flush() {
    const size_t count = waiting_.size() / features_.picture_bytes;
    if (count == 0) return;
    values_.resize(count * kViewFeatures);
    features_.extract(waiting_.data(), int(count), values_.data());
    for (const float value : values_) {
      if (!(std::fabs(value) <= kHalfMax))
        fail(Exit::kData, "found the feature ", value, ", expected at most ", kHalfMax);
      const Half half = to_half(value);
      scene_.features.append(reinterpret_cast<const char*>(&half), sizeof half);
    }
    waiting_.clear();
  }

 private:
  static constexpr size_t kBatch = 32;
  const PictureFeatures& features_;
  Scene& scene_;
  std::unordered_map<uint64_t, int32_t> known_;
  std::vector<uint8_t> waiting_;
  std::vector<float> values_;
};

}  // namespace

RecordedKitchen to_kitchen(Scene scene) {
  if (scene.rules != kKitchenRules)
    fail(Exit::kData, "rules version ", scene.rules, ", this build has ", kKitchenRules);
  RecordedKitchen kitchen;
  kitchen.name = scene.env;
  kitchen.hash = scene.hash();
  kitchen.extractor = scene.extractor + '@' + hex(scene.extractor_hash);
  KitchenTables tables;
  const size_t poses = scene.pose_count();
  for (size_t i = 0; i < poses; ++i) {
    const int32_t* pose = &scene.poses[4 * i];
    tables.poses.push_back({int16_t(pose[0]), int16_t(pose[1]), int16_t(pose[2]), int16_t(pose[3])});
  }
  tables.start_poses.assign(scene.starts.begin(), scene.starts.end());
  tables.next.assign(scene.next.begin(), scene.next.end());
  for (size_t layout = 0; layout < scene.layout_count(); ++layout) {
    tables.slots.clear();
    for (size_t i = 0; i < kKitchenObjects; ++i) {
      const int32_t* cell = &scene.objects[(layout * kKitchenObjects + i) * 2];
      tables.slots.push_back({int16_t(cell[0]), int16_t(cell[1])});
    }
    const auto part = [&](const std::vector<int32_t>& all, size_t things, size_t doors) {
      return &all[(layout * kDoorStates + doors) * poses * things];
    };
    for (size_t doors = 0; doors < kDoorStates; ++doors) {
      const auto as_closed = [&](const std::vector<int32_t>& all, size_t things) {
        return std::equal(part(all, things, doors), part(all, things, doors) + poses * things, part(all, things, 0));
      };
      const auto lists = [&](const std::vector<int32_t>& all, size_t things) {
        return seen_lists(part(all, things, doors), poses, things);
      };
      if (doors > 0 && as_closed(scene.object_distance, kKitchenObjects) &&
          as_closed(scene.receptacle_distance, kKitchenReceptacles)) {
        tables.sight[doors] = tables.sight[0];
        continue;
      }
      tables.sight[doors] = std::make_shared<KitchenSight>(KitchenSight{
          lists(scene.object_distance, kKitchenObjects), lists(scene.receptacle_distance, kKitchenReceptacles)});
    }
    kitchen.layouts.push_back(tables);
  }
  kitchen.view = std::move(scene.view);
  kitchen.halves = scene.halves;
  kitchen.features = std::move(scene.features);
  return kitchen;
}

std::vector<RecordedKitchen> read_kitchens(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (const std::string name = entry->path().filename().string(); name.ends_with(kSceneEnding)) names.push_back(name);
  if (error) fail(Exit::kNoInput, "cannot read the folder '", folder, "': ", error.message());
  if (names.empty()) fail(Exit::kNoInput, "no *", kSceneEnding, " in the folder '", folder, "'");
  std::sort(names.begin(), names.end(), natural_less);
  std::vector<RecordedKitchen> kitchens;
  for (const std::string& name : names) {
    const std::string path = (fs::path(folder) / name).string();
    Input input(path);
    Scene scene = read_scene(input);
    try {
      kitchens.push_back(to_kitchen(std::move(scene)));
      kitchens.back().source = input.name();
    } catch (const Error& wrong) {
      fail(wrong.code(), "cannot read ", input.name(), ": ", wrong.what());
    }
  }
  return kitchens;
}

std::vector<ObjectSlots> random_layouts(const KitchenSet& world, int env, int count, uint64_t seed) {
  std::vector<ObjectSlots> layouts;
  for (uint64_t i = 0; int(layouts.size()) < count; ++i) {
    Random random(seed, Purpose::kLayout, uint64_t(env), i);
    const ObjectSlots slots = kitchen_reset(world.tables(env), random).slots;
    if (std::find(layouts.begin(), layouts.end(), slots) == layouts.end()) layouts.push_back(slots);
  }
  return layouts;
}

Scene make_scene(Parallel& parallel, const KitchenSet& world, int env, const std::vector<ObjectSlots>& layouts,
                 const PictureFeatures& features, const std::function<void(size_t done, size_t total)>& done) {
  constexpr int kHands = kKitchenObjects + 1;
  const KitchenTables& tables = world.tables(env);
  const int poses = tables.pose_count();
  Scene scene;
  scene.env = world.environments()[size_t(env)].name;
  scene.rules = world.rules();
  scene.extractor = features.name;
  scene.extractor_hash = features.hash;
  write_tables(tables, scene);
  Rows rows(features, scene);
  std::vector<uint8_t> pictures(size_t(kHands) * size_t(parallel.threads()) * features.picture_bytes);
  for (size_t layout = 0; layout < layouts.size(); ++layout) {
    write_layout(tables, layouts[layout], scene);
    const std::vector<bool> reached = kitchen_reachable(tables, layouts[layout]);
    const size_t first = scene.view.size();
    scene.view.resize(first + reached.size(), -1);
    // As many states as there is room for are drawn at once; rows are given out in their order, whatever the threads.
    std::vector<size_t> drawn;
    const auto draw_all = [&] {
      parallel.run(int(drawn.size()), [&](int i, int) {
        KitchenState now;
        now.pose = uint16_t(drawn[size_t(i)] / kHands % size_t(poses));
        now.doors = uint8_t(drawn[size_t(i)] / kHands / size_t(poses));
        now.hand = uint8_t(drawn[size_t(i)] % kHands);
        now.slots = layouts[layout];
        if (now.hand != kEmptyHand) now.slots[now.hand] = kNoSlot;
        features.draw(world.solids(env), world.frame(env, pack(now)), &pictures[size_t(i) * features.picture_bytes]);
      });
      for (size_t i = 0; i < drawn.size(); ++i)
        scene.view[first + drawn[i]] = rows.of(&pictures[i * features.picture_bytes]);
      drawn.clear();
    };
    for (size_t at = 0; at < reached.size(); ++at) {
      if (reached[at]) drawn.push_back(at);
      if (drawn.size() * features.picture_bytes == pictures.size() || at + 1 == reached.size()) {
        draw_all();
        done(layout * reached.size() + at + 1, layouts.size() * reached.size());
      }
    }
  }
  rows.flush();
  return scene;
}

}  // namespace synpo
