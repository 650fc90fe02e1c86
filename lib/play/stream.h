// The stream of trajectories that a trainer reads: parsed, replayed, compared with the seen set, hashed.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/files/io.h"
#include "base/hash.h"
#include "format/trajectory.h"
#include "play/episode.h"
#include "world/world.h"

namespace synpo {

// A line of a stream that begins where an episode of synpo-eval begins: what learns from it is not to be tested there.
struct TestedStart {
  std::string file;  // as messages name it
  uint64_t line, seed;
  int64_t episode;
};

class TrajectoryStream {
 public:
  // Trajectories of pairs outside `seen` are refused (an empty list takes all). The window of the first is that of all;
  // -1 lets the first decide.
  TrajectoryStream(Input& input, const World& world, std::vector<EnvTask> seen, int window = -1);

  // The next trajectory; nothing at the end. Errors are kData with the line; also at the end, where the stream says
  // that it has more trajectories, or fewer (TrajectoryLines).
  std::optional<Episode> next();
  // Reads on without parsing until `lines` trajectories have come in all or the stream ends; how many have come by
  // then.
  uint64_t length_up_to(uint64_t lines);
  // Passes over `lines` trajectories without parsing and checks that they are those that `hash` was made of (kData).
  void skip(uint64_t lines, uint64_t hash);

  uint64_t lines() const { return lines_; }
  uint64_t hash() const { return hash_.value(); }
  int window() const { return window_; }
  bool ended() const { return ended_; }
  // Reads on to the end and throws kData (kNoEnd) where the stream does not say it.
  void check_end();
  // The first line read so far that begins on a start of success matrices.
  const std::optional<TestedStart>& tested_start() const { return tested_start_; }

 private:
  bool take_line();
  Input& input_;
  TrajectoryLines from_;
  const World& world_;
  std::vector<EnvTask> seen_;
  std::vector<bool> allowed_;  // by pair number
  int window_;
  bool ended_ = false;
  std::optional<TestedStart> tested_start_;
  uint64_t lines_ = 0;
  Hash hash_;
  std::string line_;
};

}  // namespace synpo
