#include "format/scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/half.h"
#include "base/hash.h"
#include "base/text.h"
#include "format/safetensors.h"

namespace synpo {
namespace {

constexpr char kFormat[] = "synpo-scene";

struct IntTensor {
  const char* name;
  std::vector<int32_t> Scene::*member;
};
constexpr IntTensor kIntTensors[] = {
    {"next", &Scene::next},   {"object_distance", &Scene::object_distance},         {"objects", &Scene::objects},
    {"poses", &Scene::poses}, {"receptacle_distance", &Scene::receptacle_distance}, {"starts", &Scene::starts},
    {"view", &Scene::view}};
constexpr char kFeatures[] = "features";

std::string text_of(const std::vector<int64_t>& numbers) {
  std::string text = "[";
  for (const int64_t number : numbers) text += (text.size() > 1 ? ", " : "") + std::to_string(number);
  return text + "]";
}

const Tensor& tensor_of(const SafeTensors& file, const std::string& name) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) fail(Exit::kData, "no tensor '", name, "'");
  return found->second;
}

[[noreturn]] void bad_shape(const std::string& name, const Tensor& tensor, const std::string& expected) {
  fail(Exit::kData, "tensor '", name, "': found shape ", text_of(tensor.shape), ", expected ", expected);
}

// The first extent of a tensor that is [N, rest...] with N from 1 to `limit`.
int64_t rows_of(const SafeTensors& file, const std::string& name, const char* letter, const std::vector<int64_t>& rest,
                int64_t limit) {
  const Tensor& tensor = tensor_of(file, name);
  const bool fits =
      tensor.shape.size() == rest.size() + 1 && std::equal(rest.begin(), rest.end(), tensor.shape.begin() + 1);
  if (!fits || tensor.shape[0] < 1 || tensor.shape[0] > limit) {
    std::string expected = std::string("[") + letter;
    for (const int64_t extent : rest) expected += ", " + std::to_string(extent);
    bad_shape(name, tensor, concat(expected, "] with ", letter, " from 1 to ", limit));
  }
  return tensor.shape[0];
}

// A tensor of I32 within [low, high].
std::vector<int32_t> integers(const SafeTensors& file, const std::string& name, const std::vector<int64_t>& shape,
                              int32_t low, int32_t high) {
  const Tensor& tensor = tensor_of(file, name);
  if (tensor.shape != shape) bad_shape(name, tensor, text_of(shape));
  std::vector<int32_t> values = file.get<int32_t>(name);
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= low && values[i] <= high) continue;
    std::vector<int64_t> at(shape.size());
    size_t rest = i;
    for (size_t axis = shape.size(); axis-- > 0; rest /= size_t(shape[axis]))
      at[axis] = int64_t(rest % size_t(shape[axis]));
    fail(Exit::kData, "tensor '", name, "': found ", values[i], " at ", text_of(at), ", expected a whole number from ",
         low, " to ", high);
  }
  return values;
}

std::string name_in(const SafeTensors& file, const std::string& key) {
  const std::string& text = file.meta(key);
  if (const std::string fault = fault_of_name(text); !fault.empty()) fail(Exit::kData, "metadata '", key, "': ", fault);
  return text;
}

int whole(const SafeTensors& file, const std::string& key) {
  const std::string& text = file.meta(key);
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos)
    fail(Exit::kData, "metadata '", key, "': found ", quoted(text), ", expected a whole number from 0 to 999999999");
  return std::stoi(text);
}

// Takes the features out of the file.
void take_features(SafeTensors& file, Scene& scene) {
  const int64_t rows = rows_of(file, kFeatures, "N", {kSceneFeatures}, INT32_MAX);
  Tensor& tensor = file.tensors[kFeatures];
  if (tensor.type != TensorType::kF16 && tensor.type != TensorType::kF32)
    fail(Exit::kData, "tensor '", kFeatures, "': found type ", type_text(tensor.type), ", expected F16 or F32");
  scene.halves = tensor.type == TensorType::kF16;
  scene.features = std::move(tensor.bytes);
  const auto finite = [&](size_t i) {
    float single;
    Half half;
    if (scene.halves) {
      std::memcpy(&half, scene.features.data() + i * sizeof half, sizeof half);
      return is_finite(half);
    }
    std::memcpy(&single, scene.features.data() + i * sizeof single, sizeof single);
    return std::isfinite(single);
  };
  for (size_t i = 0; i < size_t(rows) * kSceneFeatures; ++i)
    if (!finite(i))
      fail(Exit::kData, "tensor '", kFeatures, "': row ", i / kSceneFeatures, " holds a value that is not finite");
  scene.view = integers(file, "view",
                        {int64_t(scene.layout_count()), kSceneDoors, int64_t(scene.pose_count()), kSceneObjects + 1},
                        -1, int32_t(rows - 1));
}

Scene scene_in(SafeTensors& file) {
  if (file.metadata.count("format") == 0 || file.meta("format") != kFormat) fail(Exit::kData, "not a synpo scene");
  const int version = whole(file, "version");
  if (version < 1 || version > kSceneVersion)
    fail(Exit::kData, "version ", version, ", this build reads 1 to ", kSceneVersion);
  Scene scene;
  scene.env = name_in(file, "env");
  scene.rules = whole(file, "rules");
  scene.extractor = name_in(file, "extractor");
  scene.extractor_hash = parse_hex(file.meta("extractor_hash"));
  const int64_t poses = rows_of(file, "poses", "P", {4}, kSceneLimit), starts = rows_of(file, "starts", "S", {}, poses);
  const int64_t layouts = rows_of(file, "objects", "L", {kSceneObjects, 2}, kSceneLimit);
  scene.poses = integers(file, "poses", {poses, 4}, INT16_MIN, INT16_MAX);
  scene.starts = integers(file, "starts", {starts}, 0, int32_t(poses - 1));
  if (std::adjacent_find(scene.starts.begin(), scene.starts.end(), std::greater_equal<>()) != scene.starts.end())
    fail(Exit::kData, "tensor 'starts': found numbers that do not rise, expected each once, ascending");
  scene.next = integers(file, "next", {poses, kSceneMoves}, 0, int32_t(poses - 1));
  scene.objects = integers(file, "objects", {layouts, kSceneObjects, 2}, INT16_MIN, INT16_MAX);
  scene.object_distance =
      integers(file, "object_distance", {layouts, kSceneDoors, poses, kSceneObjects}, -1, UINT16_MAX);
  scene.receptacle_distance =
      integers(file, "receptacle_distance", {layouts, kSceneDoors, poses, kSceneReceptacles}, -1, UINT16_MAX);
  take_features(file, scene);
  return scene;
}

}  // namespace

uint64_t Scene::hash() const {
  const auto add = [](Hash& hash, const std::string& name, const void* data, size_t size) {
    hash.add(name).add(data, size);
  };
  Hash hash;
  hash.add("env")
      .add(env)
      .add("extractor")
      .add(extractor)
      .add("extractor_hash")
      .add(hex(extractor_hash))
      .add("rules")
      .add(std::to_string(rules));
  add(hash, kFeatures, features.data(), features.size());
  for (const IntTensor& tensor : kIntTensors)
    add(hash, tensor.name, (this->*tensor.member).data(), (this->*tensor.member).size() * sizeof(int32_t));
  return hash.value();
}

Scene read_scene(Input& input) {
  SafeTensors file = read_safetensors(input);
  try {
    return scene_in(file);
  } catch (const Error& error) {
    fail(error.code(), "cannot read ", input.name(), ": ", error.what());
  }
}

std::string format_scene(const Scene& scene) {
  SafeTensors file;
  file.metadata = {{"format", kFormat},
                   {"version", std::to_string(kSceneVersion)},
                   {"env", scene.env},
                   {"rules", std::to_string(scene.rules)},
                   {"extractor", scene.extractor},
                   {"extractor_hash", hex(scene.extractor_hash)}};
  const int64_t poses = int64_t(scene.pose_count()), layouts = int64_t(scene.layout_count());
  const auto add = [&](const char* name, const std::vector<int64_t>& shape, const std::vector<int32_t>& values) {
    file.add(name, shape, values.data(), values.size());
  };
  add("poses", {poses, 4}, scene.poses);
  add("starts", {int64_t(scene.starts.size())}, scene.starts);
  add("next", {poses, kSceneMoves}, scene.next);
  add("objects", {layouts, kSceneObjects, 2}, scene.objects);
  add("object_distance", {layouts, kSceneDoors, poses, kSceneObjects}, scene.object_distance);
  add("receptacle_distance", {layouts, kSceneDoors, poses, kSceneReceptacles}, scene.receptacle_distance);
  add("view", {layouts, kSceneDoors, poses, kSceneObjects + 1}, scene.view);
  const int64_t row = kSceneFeatures * int64_t(scene.halves ? sizeof(Half) : sizeof(float));
  file.tensors[kFeatures] = {scene.halves ? TensorType::kF16 : TensorType::kF32,
                             {int64_t(scene.features.size()) / row, kSceneFeatures},
                             scene.features};
  return format_safetensors(file);
}

}  // namespace synpo
