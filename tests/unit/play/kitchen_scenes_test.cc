#include "play/kitchen_scenes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "base/half.h"
#include "base/hash.h"
#include "base/text.h"
#include "helpers/kitchens.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "play/model.h"
#include "play/world_factory.h"
#include "world/grid/view.h"
#include "world/kitchen/view/features.h"

namespace synpo {
namespace {

const KitchenSet& small_world() {
  static const KitchenSet world({small_kitchen()});
  return world;
}

// Pictures of five bytes, in which everything that can change shows, and many are alike.
constexpr int kPicture = 5;

PictureFeatures frames_as_features() {
  PictureFeatures features;
  features.name = "frames";
  features.hash = 0xabc;
  features.picture_bytes = kPicture;
  features.draw = [](const KitchenSolids&, const KitchenFrame& frame, uint8_t* picture) {
    int there = 0;
    for (int i = 0; i < kKitchenObjects; ++i) there += (i + 1) * (frame.objects[size_t(i)] + 1);
    const int numbers[kPicture] = {frame.eye.heading / 90, frame.eye.horizon / 30 + 1, frame.doors,
                                   (frame.eye.row + frame.eye.column) % 3, there % 11};
    std::copy(numbers, numbers + kPicture, picture);
  };
  features.extract = [](const uint8_t* pictures, int count, float* out) {
    for (int n = 0; n < count; ++n, pictures += kPicture)
      for (int i = 0; i < kViewFeatures; ++i) *out++ = i < kPicture ? pictures[i] : i;
  };
  return features;
}

Scene small_scene(int layouts = 2) {
  Parallel parallel(2);
  return make_scene(parallel, small_world(), 0, random_layouts(small_world(), 0, layouts, 1), frames_as_features(),
                    [](size_t, size_t) {});
}

RecordedKitchens world_of_scene(Scene scene) {
  std::vector<RecordedKitchen> kitchens;
  kitchens.push_back(to_kitchen(std::move(scene)));
  return RecordedKitchens(std::move(kitchens));
}

Scene scene_of(const std::string& bytes) {
  return read_text(bytes, [](Input& input) { return read_scene(input); });
}

TEST(Scene, ComesBack) {
  const Scene scene = small_scene();
  const std::string bytes = format_scene(scene);
  const Scene got = scene_of(bytes);
  EXPECT_EQ(got.env, "small");
  EXPECT_EQ(got.rules, kKitchenRules);
  EXPECT_EQ(got.extractor, "frames");
  EXPECT_EQ(got.extractor_hash, 0xabcu);
  EXPECT_EQ(got.poses, scene.poses);
  EXPECT_EQ(got.starts, scene.starts);
  EXPECT_EQ(got.next, scene.next);
  EXPECT_EQ(got.objects, scene.objects);
  EXPECT_EQ(got.object_distance, scene.object_distance);
  EXPECT_EQ(got.receptacle_distance, scene.receptacle_distance);
  EXPECT_EQ(got.view, scene.view);
  EXPECT_EQ(got.features, scene.features);
  EXPECT_EQ(format_scene(got), bytes);
  EXPECT_EQ(got.hash(), scene.hash());
}

TEST(Scene, TheHashIsOfEverything) {
  const Scene scene = small_scene();
  const auto changed = [&](auto&& change) {
    Scene other = scene;
    change(other);
    return other.hash() != scene.hash();
  };
  EXPECT_TRUE(changed([](Scene& s) { s.env += "x"; }));
  EXPECT_TRUE(changed([](Scene& s) { s.extractor += "x"; }));
  EXPECT_TRUE(changed([](Scene& s) { ++s.extractor_hash; }));
  EXPECT_TRUE(changed([](Scene& s) { ++s.rules; }));
  EXPECT_TRUE(changed([](Scene& s) { s.features.back() = char(s.features.back() + 1); }));
  for (const auto member : {&Scene::poses, &Scene::starts, &Scene::next, &Scene::objects, &Scene::object_distance,
                            &Scene::receptacle_distance, &Scene::view})
    EXPECT_TRUE(changed([&](Scene& s) { ++(s.*member).back(); }));
}

TEST(Scene, DoesNotDependOnThreads) {
  Parallel one(1);
  const Scene scene = make_scene(one, small_world(), 0, random_layouts(small_world(), 0, 2, 1), frames_as_features(),
                                 [](size_t, size_t) {});
  EXPECT_EQ(scene.hash(), small_scene().hash());
}

TEST(Scene, RefusesHostileFiles) {
  const SafeTensors good =
      read_text(format_scene(small_scene(1)), [](Input& input) { return read_safetensors(input); });
  const auto refused = [&](auto&& change) {
    SafeTensors file = good;
    change(file);
    return thrown([&] { scene_of(format_safetensors(file)); });
  };
  const std::string start = "65 cannot read IN: ";
  EXPECT_EQ(refused([](SafeTensors&) {}), "nothing thrown");
  for (const char* key : {"version", "env", "rules", "extractor", "extractor_hash"})
    EXPECT_EQ(refused([&](SafeTensors& f) { f.metadata.erase(key); }), start + "no metadata '" + key + "'");
  EXPECT_EQ(refused([](SafeTensors& f) { f.metadata.erase("format"); }), start + "not a synpo scene");
  EXPECT_EQ(refused([](SafeTensors& f) { f.metadata["version"] = "2"; }), start + "version 2, this build reads 1 to 1");
  EXPECT_EQ(refused([](SafeTensors& f) { f.metadata["version"] = "0"; }), start + "version 0, this build reads 1 to 1");
  for (const char* value : {"", "-1", "1.0", "9999999999"})
    EXPECT_EQ(refused([&](SafeTensors& f) { f.metadata["rules"] = value; }),
              concat(start, "metadata 'rules': found '", value, "', expected a whole number from 0 to 999999999"));
  for (const char* value : {"", "a\tb", "a\nb", "\x7f"})
    EXPECT_EQ(refused([&](SafeTensors& f) { f.metadata["env"] = value; }),
              start + "metadata 'env': " + fault_of_name(value));
  EXPECT_EQ(refused([](SafeTensors& f) { f.metadata["env"] = std::string(256, 'x'); }),
            start + "metadata 'env': found a name of 256 bytes, expected at most 255");
  EXPECT_NE(refused([](SafeTensors& f) { f.metadata["extractor_hash"] = "abc"; }), "nothing thrown");
  const int64_t poses = good.tensors.at("poses").shape[0], rows = good.tensors.at("features").shape[0];
  const auto tensor_start = [&](const std::string& name) { return start + "tensor '" + name + "': "; };
  for (const auto& [name, tensor] : good.tensors) {
    EXPECT_EQ(refused([&, n = name](SafeTensors& f) { f.tensors.erase(n); }), start + "no tensor '" + name + "'");
    // A number more than there is, and of another type.
    EXPECT_TRUE(refused([&, n = name](SafeTensors& f) {
                  const size_t count = f.tensors.at(n).count();
                  f.tensors.at(n).shape = {int64_t(count), 1, 1};
                }).starts_with(tensor_start(name) + "found shape ["));
    if (name != "features") {
      EXPECT_EQ(refused([&, n = name](SafeTensors& f) {
                  Tensor& t = f.tensors.at(n);
                  t.type = TensorType::kF32;
                }),
                tensor_start(name) + "found type F32, expected I32");
    }
  }
  const auto with = [&](const char* name, size_t at, int32_t value) {
    return refused([&](SafeTensors& f) { std::memcpy(&f.tensors.at(name).bytes[at * 4], &value, 4); });
  };
  EXPECT_EQ(with("next", 16, int32_t(poses)),
            concat(tensor_start("next"), "found ", poses, " at [3, 1], expected a whole number from 0 to ", poses - 1));
  EXPECT_EQ(with("next", 0, -1),
            concat(tensor_start("next"), "found -1 at [0, 0], expected a whole number from 0 to ", poses - 1));
  EXPECT_EQ(with("starts", 0, INT32_MAX),
            concat(tensor_start("starts"), "found 2147483647 at [0], expected a whole number from 0 to ", poses - 1));
  EXPECT_EQ(with("starts", 1, 0),
            tensor_start("starts") + "found numbers that do not rise, expected each once, ascending");
  EXPECT_EQ(with("poses", 5, 40000),
            tensor_start("poses") + "found 40000 at [1, 1], expected a whole number from -32768 to 32767");
  EXPECT_EQ(with("objects", 3, -40000),
            tensor_start("objects") + "found -40000 at [0, 1, 1], expected a whole number from -32768 to 32767");
  EXPECT_EQ(with("object_distance", 7, 65536),
            tensor_start("object_distance") + "found 65536 at [0, 0, 1, 0], expected a whole number from -1 to 65535");
  EXPECT_EQ(with("receptacle_distance", 3, -2),
            tensor_start("receptacle_distance") + "found -2 at [0, 0, 1, 0], expected a whole number from -1 to 65535");
  EXPECT_EQ(with("view", 9, int32_t(rows)), concat(tensor_start("view"), "found ", rows,
                                                   " at [0, 0, 1, 1], expected a whole number from -1 to ", rows - 1));
  EXPECT_EQ(refused([](SafeTensors& f) {
              Tensor& t = f.tensors.at("features");
              t.bytes[2 * 2048 + 11] = 0x7c;
            }),
            tensor_start("features") + "row 1 holds a value that is not finite");
  EXPECT_EQ(refused([](SafeTensors& f) {
              Tensor& t = f.tensors.at("features");
              t.type = TensorType::kI64;
              t.shape[0] = 2;
              t.bytes.resize(size_t(2) * 2048 * 8);
            }),
            tensor_start("features") + "found type I64, expected F16 or F32");
  EXPECT_EQ(refused([](SafeTensors& f) {
              f.tensors["features"] = {TensorType::kF16, {0, 2048}, ""};
            }),
            tensor_start("features") + "found shape [0, 2048], expected [N, 2048] with N from 1 to 2147483647");
  EXPECT_EQ(refused([](SafeTensors& f) {
              f.tensors["poses"] = {TensorType::kI32, {65536, 4}, std::string(65536 * 16, '\0')};
            }),
            tensor_start("poses") + "found shape [65536, 4], expected [P, 4] with P from 1 to 65535");
}

// The same episodes in the kitchen that has a plan and in its scene, by actions of all kinds.
TEST(RecordedKitchens, PlayAsTheKitchenOfThePlan) {
  const auto layouts = random_layouts(small_world(), 0, 3, 1);
  const RecordedKitchens scenes = world_of_scene(small_scene(3));
  const PictureFeatures features = frames_as_features();
  ASSERT_EQ(scenes.task_names(), small_world().task_names());
  ASSERT_EQ(scenes.action_names(), small_world().action_names());
  ASSERT_EQ(scenes.observation_size(), small_world().observation_size());
  std::vector<uint8_t> observation(scenes.observation_size());
  std::vector<float> views(observation.size() / sizeof(float));
  std::set<int> layouts_seen;
  int picked = 0, wrong = 0, successes = 0;
  for (int episode = 0; episode < 300; ++episode) {
    const EnvTask pair = {0, episode % kKitchenTasks};
    Random random(5, Purpose::kEpisodeStart, 0, uint64_t(episode));
    WorldState scene = scenes.reset(0, random);
    KitchenState planned = unpack(scene);
    layouts_seen.insert(planned.layout);
    planned.slots = layouts[planned.layout];
    planned.layout = 0;
    WorldState plan = pack(planned);
    EXPECT_EQ(scenes.start_places(0, scene), small_world().start_places(0, plan));
    EXPECT_EQ(scenes.start_state(0, scenes.start_places(0, scene)), scene);
    StateHistory history;
    history.push(scene);
    for (WorldStep step = {}; !step.ended();) {
      ASSERT_TRUE(scenes.valid(pair, scene));
      ASSERT_TRUE(small_world().valid(pair, plan));
      const int label = scenes.expert(pair, scene);
      ASSERT_EQ(label, small_world().expert(pair, plan));
      ASSERT_EQ(scenes.at_choice(pair, scene), small_world().at_choice(pair, plan));
      int values[kKitchenActions], plan_values[kKitchenActions];
      scenes.action_values(pair, scene, values);
      small_world().action_values(pair, plan, plan_values);
      for (int i = 0; i < kKitchenActions; ++i) ASSERT_EQ(values[i], plan_values[i]);
      if (unpack(scene).steps % 7 == 0) {
        scenes.observe(0, history, 1, observation.data());
        std::memcpy(views.data(), observation.data(), observation.size());
        uint8_t picture[kPicture];
        std::vector<float> expected(kViewFeatures);
        features.draw(small_world().solids(0), small_world().frame(0, plan), picture);
        features.extract(picture, 1, expected.data());
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), views.begin() + 3 * kViewFeatures));
        ASSERT_EQ(views[4 * kViewFeatures], unpack(scene).hand);
      }
      const int action = random.below(3) ? label : int(random.below(kKitchenActions));
      const WorldStep want = small_world().step(pair, plan, action);
      step = scenes.step(pair, scene, action);
      history.push(scene);
      ASSERT_EQ(step.reward_cents, want.reward_cents);
      ASSERT_EQ(step.terminated, want.terminated);
      ASSERT_EQ(step.truncated, want.truncated);
      ASSERT_EQ(step.success, want.success);
      ASSERT_EQ(step.wrong, want.wrong);
      const KitchenState a = unpack(scene), b = unpack(plan);
      ASSERT_EQ(a.pose, b.pose);
      ASSERT_EQ(a.doors, b.doors);
      ASSERT_EQ(a.hand, b.hand);
      picked += step.reward_cents == kStepCents + kPickedCents;
      wrong += step.wrong;
      successes += step.success;
    }
  }
  EXPECT_EQ(layouts_seen.size(), 3u);
  EXPECT_GT(picked, 50);
  EXPECT_GT(wrong, 10);
  EXPECT_GT(successes, 50);
}

TEST(RecordedKitchens, EqualPicturesShareARow) {
  const Scene scene = small_scene(2);
  const size_t used = size_t(std::count_if(scene.view.begin(), scene.view.end(), [](int32_t row) { return row >= 0; }));
  const size_t rows = scene.features.size() / (kSceneFeatures * sizeof(Half));
  EXPECT_EQ(size_t(*std::max_element(scene.view.begin(), scene.view.end())) + 1, rows);
  EXPECT_LT(rows, used / 4);
  Scene single = scene;  // F32 and F16 say the same
  single.halves = false;
  single.features.clear();
  for (size_t i = 0; i < scene.features.size(); i += sizeof(Half)) {
    Half half;
    std::memcpy(&half, &scene.features[i], sizeof half);
    const float value = to_float(half);
    single.features.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const RecordedKitchens a = world_of_scene(scene), b = world_of_scene(scene_of(format_scene(single)));
  StateHistory history;
  Random random(1, Purpose::kEpisodeStart);
  for (int i = 0; i < 3; ++i) history.push(a.reset(0, random));
  std::vector<uint8_t> x(a.observation_size()), y(b.observation_size());
  a.observe(0, history, 1, x.data());
  b.observe(0, history, 1, y.data());
  EXPECT_EQ(x, y);
  EXPECT_TRUE(std::all_of(x.begin(), x.begin() + kViewFeatures * 4, [](uint8_t byte) { return byte == 0; }));
}

TEST(RecordedKitchens, RefuseWhatCannotBePlayed) {
  const Scene good = small_scene(2);
  const auto refused = [&](auto&& change) {
    Scene scene = good;
    change(scene);
    return thrown([&] { world_of_scene(std::move(scene)); });
  };
  EXPECT_EQ(refused([](Scene&) {}), "nothing thrown");
  EXPECT_EQ(refused([](Scene& s) { s.rules = 2; }), "65 rules version 2, this build has 1");
  EXPECT_EQ(refused([](Scene& s) { std::copy_n(&s.poses[0], 4, &s.poses[4]); }),
            "65 small: two poses are alike: row 3, column 1, heading 0, horizon -30");
  EXPECT_EQ(refused([](Scene& s) { std::copy_n(&s.objects[0], 14, &s.objects[14]); }),
            "65 small: in layouts 0 and 1 the objects lie in the same cells, expected no two layouts alike");
  EXPECT_EQ(refused([](Scene& s) { s.view[(size_t(s.starts[0]) + 1) * 8 - 1] = -1; }),
            "65 small, layout 0: from row 3, column 1, heading 0, horizon 0, doors 0, object in the hand 7: found no "
            "features, expected some where an episode "
            "can come by");
  EXPECT_EQ(refused([](Scene& s) { std::fill(s.receptacle_distance.begin(), s.receptacle_distance.end(), -1); }),
            "65 small, layout 0: the Fridge cannot be used from row 3, column 1, heading 0, horizon -30");
  // In layout 1 alone the Mug is out of sight.
  EXPECT_EQ(refused([](Scene& s) {
              for (size_t i = s.object_distance.size() / 2 + 2; i < s.object_distance.size(); i += 7)
                s.object_distance[i] = -1;
            }),
            "65 small, layout 1: from row 3, column 1, heading 0, horizon -30, doors 0: the Mug cannot be picked up");
  const auto two = [&](const char* name, const char* extractor) {
    return thrown([&] {
      std::vector<RecordedKitchen> kitchens;
      kitchens.push_back(to_kitchen(good));
      kitchens.push_back(to_kitchen(good));
      kitchens[1].name = name;
      kitchens[1].extractor = extractor;
      RecordedKitchens{std::move(kitchens)};
    });
  };
  EXPECT_EQ(two("small", "frames@0000000000000abc"), "65 two environments are named 'small'");
  EXPECT_EQ(two("other", "frames@0000000000000abd"),
            "65 other: found features of 'frames@0000000000000abd', expected 'frames@0000000000000abc' as of small");
  EXPECT_EQ(two("other", "frames@0000000000000abc"), "nothing thrown");
}

TEST(RecordedKitchens, RefuseHostileStates) {
  const RecordedKitchens scenes = world_of_scene(small_scene(2));
  Random random(1, Purpose::kEpisodeStart);
  const KitchenState good = unpack(scenes.reset(0, random));
  EXPECT_TRUE(scenes.valid({0, 0}, pack(good)));
  KitchenState state = good;
  state.layout = 2;
  EXPECT_FALSE(scenes.valid({0, 0}, pack(state)));
  state = good;
  std::swap(state.slots[0], state.slots[1]);
  EXPECT_FALSE(scenes.valid({0, 0}, pack(state)));
  StartPlaces places = scenes.start_places(0, pack(good));
  places["Plate"].second += 1;
  EXPECT_EQ(thrown([&] { scenes.start_state(0, places); }),
            concat("65 'Plate': found row ", places["Plate"].first, ", column ", places["Plate"].second,
                   ", where it lies in no layout with the other objects"));
  state = KitchenState();  // of a kitchen that has a plan there is one layout
  state.slots = random_layouts(small_world(), 0, 1, 1)[0];
  EXPECT_TRUE(small_world().valid({0, 0}, pack(state)));
  state.layout = 1;
  EXPECT_FALSE(small_world().valid({0, 0}, pack(state)));
}

TEST(SceneFolder, IsAWorldInNaturalOrder) {
  const TemporaryFolder folder;
  Scene scene = small_scene(1);
  for (const char* name : {"k10", "k9", "k2"}) {
    scene.env = name;
    folder.file(std::string(name) + kSceneEnding, format_scene(scene));
  }
  folder.file("notes.txt", "no scene");
  const std::unique_ptr<World> world = open_world("kitchen:" + folder.path());
  ASSERT_EQ(world->envs(), 3);
  EXPECT_EQ(world->environments()[0].name, "k2");
  EXPECT_EQ(world->environments()[1].name, "k9");
  EXPECT_EQ(world->environments()[2].hash, [&] {
    scene.env = "k10";
    return scene.hash();
  }());
  EXPECT_EQ(world->environments()[2].content, "");
  EXPECT_EQ(world->name(), "kitchen");
  EXPECT_EQ(world->extractor(), "frames@0000000000000abc");

  const std::vector<Environment> chosen = {world->environments()[2], world->environments()[0]};
  const std::unique_ptr<World> some = restore_world("kitchen", chosen, world.get());
  ASSERT_EQ(some->envs(), 2);
  EXPECT_EQ(some->environments()[0].name, "k10");
  const std::string none = "64 the kitchens lie in files of their own";
  EXPECT_EQ(thrown([&] { restore_world("kitchen", chosen); }), none);
  EXPECT_TRUE(fails_for(kNoSource, [&] { restore_world("kitchen", chosen); }));
  EXPECT_EQ(thrown([&] { restore_world("kitchen", chosen, &small_world()); }), none + ": found the built-in 'kitchen'");
  EXPECT_TRUE(fails_for(kOtherSource, [&] { restore_world("kitchen", chosen, &small_world()); }));
  EXPECT_EQ(thrown([&] { restore_world("kitchen", chosen, some.get()); }), "nothing thrown");
  EXPECT_EQ(thrown([&] { restore_world("kitchen", world->environments(), some.get()); }),
            "65 env 'k9': no scene of that name in the folder");
  std::vector<Environment> other = chosen;
  ++other[1].hash;
  EXPECT_EQ(
      thrown([&] { restore_world("kitchen", other, world.get()); }),
      concat("65 env 'k2': found a scene with hash ", hex(chosen[1].hash), ", expected ", hex(chosen[1].hash + 1)));

  folder.file(std::string("k9") + kSceneEnding, "");
  EXPECT_EQ(thrown([&] { open_world("kitchen:" + folder.path()); }),
            "65 cannot read " + folder.file(std::string("k9") + kSceneEnding) + ": it is empty");
  for (const char* name : {"k10", "k9", "k2"}) std::filesystem::remove(folder.file(std::string(name) + kSceneEnding));
  EXPECT_EQ(thrown([&] { open_world("kitchen:" + folder.path()); }),
            "66 no *.scene.safetensors in the folder '" + folder.path() + "'");
  EXPECT_TRUE(thrown([&] { open_world("kitchen:" + folder.file("none")); }).starts_with("66 cannot read the folder '"));
}

TEST(SceneFolder, ACheckpointGoesWithItsFeaturesAlone) {
  const RecordedKitchens scenes = world_of_scene(small_scene(1));
  PolicyShape shape;
  shape.observation = scenes.observation_spec();
  shape.envs = 1;
  shape.tasks = scenes.task_count();
  shape.actions = scenes.actions();
  shape.feature = shape.basis = shape.embedding = shape.hidden = 4;
  shape.views.channels = shape.views.hidden = 4;
  const Model model = fresh_model("synpo", shape, {});
  Checkpoint checkpoint = describe_model(model, scenes);
  add_tensors(checkpoint.file, "", model.policy->parameters(), model.parameters.data());
  add_tensors(checkpoint.file, "", model.policy->statistics(), model.statistics.data());
  checkpoint = read_text(format_checkpoint(checkpoint), [](Input& input) { return read_checkpoint(input); });
  EXPECT_EQ(checkpoint.extractor, "frames@0000000000000abc");
  EXPECT_TRUE(lies_in_files(checkpoint));
  EXPECT_EQ(world_of(checkpoint, &scenes)->environments()[0].hash, scenes.environments()[0].hash);
  load_model(checkpoint, scenes);
  Scene other = small_scene(1);
  other.extractor_hash = 1;
  EXPECT_EQ(thrown([&] { load_model(checkpoint, world_of_scene(other)); }),
            "65 cannot read IN: the policy was trained on features of 'frames@0000000000000abc', found those of "
            "'frames@0000000000000001'");
  checkpoint.extractor.clear();  // as of files that don't tell
  load_model(checkpoint, world_of_scene(other));

  const Checkpoint planned = describe_model(model, small_world());
  EXPECT_FALSE(lies_in_files(planned));
  EXPECT_EQ(planned.extractor, small_world().extractor());
  EXPECT_EQ(thrown([&] { world_of(planned, "kitchen"); }),
            "64 the checkpoint holds its environments, and 'FloorPlan1' of 'kitchen' is none of them");
  EXPECT_TRUE(fails_for(kNeedsNoSource, [&] { world_of(planned, "kitchen"); }));
}

// Its encoder would read what the world does not write.
TEST(SceneFolder, ACheckpointGoesWithObservationsOfItsSizesAlone) {
  const auto loaded = [](auto&& change) {
    PolicyShape shape;
    shape.observation = small_world().observation_spec();
    change(shape.observation);
    shape.envs = 1;
    shape.tasks = small_world().task_count();
    shape.actions = small_world().actions();
    shape.feature = shape.basis = shape.embedding = shape.hidden = 4;
    shape.views.channels = shape.views.hidden = 4;
    const Model model = fresh_model("synpo", shape, {});
    Checkpoint checkpoint = describe_model(model, small_world());
    add_tensors(checkpoint.file, "", model.policy->parameters(), model.parameters.data());
    add_tensors(checkpoint.file, "", model.policy->statistics(), model.statistics.data());
    return thrown([&] { load_model(checkpoint, small_world()); });
  };
  const std::string refused = "65 the network's shape does not fit the world";
  EXPECT_EQ(loaded([](ObservationSpec&) {}), "nothing thrown");
  EXPECT_EQ(loaded([](ObservationSpec& spec) { ++spec.view; }), refused);
  EXPECT_EQ(loaded([](ObservationSpec& spec) { --spec.view; }), refused);
  EXPECT_EQ(loaded([](ObservationSpec& spec) { --spec.objects; }), refused);
  EXPECT_EQ(loaded([](ObservationSpec& spec) { spec = grid_observation_spec(); }), refused);
}

}  // namespace
}  // namespace synpo
