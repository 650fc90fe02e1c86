// Episodes for another program, over two streams of bytes (synpo-play(5)): it says where they start and what is done,
// and gets observations and rewards. The agent may be anyone's, in any language.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/files/io.h"
#include "play/episode_batch.h"
#include "world/world.h"

namespace synpo {

class EpisodeServer {
 public:
  // Episodes of any pair may be asked for; these are named in the greeting.
  EpisodeServer(const World& world, std::vector<EnvTask> pairs, int window);

  // One line of JSON with its newline: all that a client must know of the world.
  std::string greeting() const;
  // Sends the greeting, then answers requests until the input ends. Throws kData for a request that cannot be answered,
  // and what Input and Output throw.
  void serve(Input& input, Output& output);

 private:
  void reset(Input& input, Output& output);
  void step(Input& input, Output& output);
  void expert(Input& input, Output& output);
  std::vector<int> read_running(Input& input);
  void check_running(const Input& input, uint32_t place) const;
  void write_observations(const std::vector<int>& places, Output& output);

  const World& world_;
  std::vector<EnvTask> pairs_;
  int window_;
  EpisodeBatch episodes_;
  std::vector<bool> running_;  // of each place
};

}  // namespace synpo
