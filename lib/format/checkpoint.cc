#include "format/checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/cli/version.h"
#include "base/error.h"
#include "base/half.h"
#include "base/hash.h"
#include "base/text.h"
#include "format/json_text.h"

namespace synpo {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr char kFormat[] = "synpo-checkpoint";
constexpr char kTrainPrefix[] = "train/";
constexpr char kPairsOfNames[] = "an array of pairs of names";
constexpr int64_t kMostCount = int64_t(1) << 53;  // so that no run comes to the end of the type

int64_t whole(const SafeTensors& file, const std::string& key) {
  const std::string& text = file.meta(key);
  int64_t value = 0;
  if (!parse_whole(text, value) || value < 0)
    fail(Exit::kData, "metadata '", key, "': found ", quoted(text), ", expected a whole number from 0 to ", INT64_MAX);
  return value;
}

template <class T>
T structure(const SafeTensors& file, const std::string& key, const char* expected) {
  const std::string& text = file.meta(key);
  try {
    return parse_json(text).get<T>();
  } catch (const Json::exception&) {
    fail(Exit::kData, "metadata '", key, "': expected ", expected);
  } catch (const Error& error) {
    fail(error.code(), "metadata '", key, "': ", error.what());
  }
}

// A name, fit to be written again.
std::string checked_name(const std::string& key, std::string name) {
  if (const std::string fault = fault_of_name(name); !fault.empty()) fail(Exit::kData, "metadata '", key, "': ", fault);
  return name;
}

OrderedJson to_json(const Checkpoint& c) {
  OrderedJson out;
  out["format"] = kFormat;
  out["version"] = kCheckpointVersion;
  if (!c.written_by.empty()) out["written_by"] = c.written_by;
  out["method"] = c.method;
  out["world"] = c.world;
  out["rules"] = c.rules;
  if (!c.extractor.empty()) out["extractor"] = c.extractor;
  out["window"] = c.window;
  out["updates"] = c.updates;
  out["states"] = c.states;
  out["seed"] = c.seed;
  out["shape"] = c.shape;
  out["options"] = c.options;
  out["tasks"] = c.tasks;
  out["seen"] = c.seen;
  out["envs"] = OrderedJson::array();
  for (const Checkpoint::Env& env : c.envs)
    out["envs"].push_back({{"name", env.name}, {"hash", hex(env.hash)}, {"content", env.content}});
  return out;
}

// Valid JSON text with the characters escaped that JSON allows raw and that no terminal should get.
std::string fit_for_terminal(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const auto [length, code] = character_at(text, i);
    if (printable_length(text, i) > 0 || code == '\n') {
      out.append(text, i, length);
    } else {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", unsigned(code));
      out += escape;
    }
    i += length;
  }
  return out;
}

}  // namespace

uint64_t Checkpoint::weights_hash() const {
  Hash hash;
  for (const auto& [name, tensor] : file.tensors)
    if (!name.starts_with(kTrainPrefix)) hash.add(name).add(tensor.bytes);
  return hash.value();
}

void Checkpoint::strip() {
  std::erase_if(file.tensors, [](const auto& entry) { return entry.first.starts_with(kTrainPrefix); });
}

void Checkpoint::halve() {
  for (auto& [name, tensor] : file.tensors) {
    // Biases, statistics and the like take little room, and their small values count.
    if (tensor.type != TensorType::kF32 || tensor.shape.size() < 2) continue;
    const std::vector<float> values = file.get<float>(name);
    // What is not finite stays too, for the reader to refuse.
    if (!std::all_of(values.begin(), values.end(), [](float value) { return std::fabs(value) <= kHalfMax; })) continue;
    std::vector<Half> halves(values.size());
    std::transform(values.begin(), values.end(), halves.begin(), to_half);
    file.add(name, std::vector<int64_t>(tensor.shape), halves.data(), halves.size());
  }
}

std::string Checkpoint::describe() const {
  OrderedJson out = to_json(*this);
  out["weights_hash"] = hex(weights_hash());
  OrderedJson& tensors = out["tensors"] = OrderedJson::object();
  for (const auto& [name, tensor] : file.tensors) tensors[name] = tensor.shape;
  return fit_for_terminal(out.dump(2));
}

Checkpoint read_checkpoint(Input& input) {
  Checkpoint c;
  c.source = input.name();
  c.file = read_safetensors(input);
  try {
    const SafeTensors& file = c.file;
    if (file.metadata.count("format") == 0 || file.meta("format") != kFormat)
      fail(Exit::kData, "not a synpo checkpoint");
    const int64_t version = whole(file, "version");
    if (version < 1 || version > kCheckpointVersion)
      fail(Exit::kData, "version ", version, ", this build reads 1 to ", kCheckpointVersion);
    if (file.metadata.count("written_by")) c.written_by = file.meta("written_by");
    c.method = checked_name("method", file.meta("method"));
    c.world = checked_name("world", file.meta("world"));
    c.rules = int(std::min<int64_t>(whole(file, "rules"), INT32_MAX));
    if (file.metadata.count("extractor")) c.extractor = file.meta("extractor");
    c.window = int(std::min<int64_t>(whole(file, "window"), 1000));
    c.updates = whole(file, "updates");
    c.states = whole(file, "states");
    if (std::max(c.updates, c.states) > kMostCount)
      fail(Exit::kData, "metadata 'updates', 'states': expected at most 2^53");
    c.seed = uint64_t(whole(file, "seed"));
    c.tasks = structure<std::vector<std::string>>(file, "tasks", "an array of names");
    for (const auto& pair : structure<std::vector<std::vector<std::string>>>(file, "seen", kPairsOfNames)) {
      if (pair.size() != 2) fail(Exit::kData, "metadata 'seen': expected ", kPairsOfNames);
      c.seen.emplace_back(pair[0], pair[1]);
    }
    for (const std::string& task : c.tasks) checked_name("tasks", task);
    for (const auto& [env, task] : c.seen)
      for (const std::string& name : {env, task}) checked_name("seen", name);
    for (const auto& [name, size] : structure<std::map<std::string, Json>>(file, "shape", "an object of numbers")) {
      if (!size.is_number_integer()) fail(Exit::kData, "metadata 'shape': ", quoted(name), " is no whole number");
      c.shape[name] = size.get<int64_t>();
    }
    c.options = structure<std::map<std::string, std::string>>(file, "options", "an object of strings");
    for (const auto& env : structure<std::vector<std::map<std::string, std::string>>>(
             file, "envs", "an array of objects with name, hash and content")) {
      for (const char* field : {"name", "hash", "content"})
        if (!env.contains(field)) fail(Exit::kData, "metadata 'envs': an object has no '", field, "'");
      c.envs.push_back({checked_name("envs", env.at("name")), parse_hex(env.at("hash")), env.at("content")});
    }
  } catch (const Error& error) {
    fail(error.code(), "cannot read ", input.name(), ": ", error.what());
  }
  return c;
}

Checkpoint load_checkpoint(const std::string& path) {
  Input input(path);
  return read_checkpoint(input);
}

std::string format_checkpoint(const Checkpoint& checkpoint) {
  SafeTensors file = checkpoint.file;
  file.metadata.clear();
  OrderedJson metadata = to_json(checkpoint);
  metadata["written_by"] = "synpo " + version_text();
  for (const auto& [key, value] : metadata.items())
    file.metadata[key] = value.is_string() ? value.get<std::string>() : value.dump();
  return format_safetensors(file);
}

}  // namespace synpo
