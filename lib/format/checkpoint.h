// Checkpoints: a safetensors file whose metadata tells all that is needed to use the weights (synpo-checkpoint(5)).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files/io.h"
#include "format/safetensors.h"

namespace synpo {

constexpr int kCheckpointVersion = 1;

struct Checkpoint {
  struct Env {
    std::string name;
    uint64_t hash;
    std::string content;  // canonical; empty where it lies in a file of its own
  };
  std::string source;      // where it was read, for messages; not in the file
  std::string written_by;  // "synpo VERSION" that wrote the file it was read from; what is written says this build's
  std::string method = "synpo";
  std::string world = "gridworld";
  int rules = 1;
  std::string extractor;  // of the features, "name@hash"; empty where observations are pictures
  int window = 1;
  std::vector<Env> envs;
  std::vector<std::string> tasks;
  std::vector<std::pair<std::string, std::string>> seen;  // (env, task)
  std::map<std::string, int64_t> shape;                   // sizes of the network
  std::map<std::string, std::string> options;             // hyper-parameters of the training, as text
  int64_t updates = 0, states = 0;
  uint64_t seed = 0;
  SafeTensors file;  // the tensors; its metadata is made from the above

  // Names what is computed: hash of the tensors that evaluation needs (all but those under train/).
  uint64_t weights_hash() const;
  // Drops everything under train/.
  void strip();
  // Makes F16 of the float32 tensors of two axes or more that it can hold: the nearest values, which load as float32.
  void halve();
  // The metadata as one JSON object, for people.
  std::string describe() const;
};

// What `body` finds wrong with the checkpoint's data is said of its file.
template <class Body>
auto naming_file(const Checkpoint& checkpoint, Body&& body) {
  try {
    return body();
  } catch (const Error& error) {
    if (error.code() != Exit::kData || checkpoint.source.empty()) throw;
    fail(Exit::kData, "cannot read ", checkpoint.source, ": ", error.what());
  }
}

Checkpoint read_checkpoint(Input& input);
Checkpoint load_checkpoint(const std::string& path);  // "-": standard input
std::string format_checkpoint(const Checkpoint& checkpoint);

}  // namespace synpo
