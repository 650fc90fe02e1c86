#include "play/stream.h"

#include <cstddef>
#include <utility>

#include "base/error.h"
#include "format/trajectory.h"

namespace synpo {
namespace {

// A world may have so few starts that the expert, or a recording for training, comes upon a tested one by chance: these
// are told by their own numbers.
bool begins_as_tested(const World& world, const Trajectory& t, const Episode& episode) {
  const auto begins_for = [&](Purpose purpose) {
    return episode.start == episode_start(world, episode.pair, t.seed, purpose, t.episode);
  };
  return begins_for(Purpose::kEvaluation) && !begins_for(Purpose::kEpisodeStart) &&
         !begins_for(Purpose::kTrainingStart);
}

}  // namespace

TrajectoryStream::TrajectoryStream(Input& input, const World& world, std::vector<EnvTask> seen, int window)
    : input_(input), from_(input), world_(world), seen_(std::move(seen)),
      allowed_(size_t(world.envs()) * world.task_count(), seen_.empty()), window_(window) {
  for (const EnvTask& pair : seen_) allowed_[world.pair_number(pair)] = true;
}

bool TrajectoryStream::take_line() {
  ended_ = ended_ || !from_.next(line_);
  return !ended_;
}

std::optional<Episode> TrajectoryStream::next() {
  if (!take_line()) return std::nullopt;
  try {
    const Trajectory trajectory = parse_trajectory(line_, kStepLimit);
    Episode episode = replay(world_, trajectory);
    if (!allowed_[world_.pair_number(episode.pair)])
      fail(Exit::kData, "pair ", trajectory.env, ", ", trajectory.task, " is not in the seen set");
    if (window_ < 0) window_ = trajectory.window;
    if (trajectory.window != window_)
      fail(Exit::kData, "window ", trajectory.window, ", expected ", window_, " as in the trajectories before");
    ++lines_;
    hash_.add(line_).add("\n");
    if (!tested_start_ && begins_as_tested(world_, trajectory, episode))
      tested_start_ = {input_.name(), input_.line_number(), trajectory.seed, trajectory.episode};
    return episode;
  } catch (const Error& error) {
    input_.bad_line(error);
  }
}

uint64_t TrajectoryStream::length_up_to(uint64_t lines) {
  uint64_t read = lines_;
  while (read < lines && take_line()) ++read;
  return read;
}

void TrajectoryStream::check_end() {
  while (take_line()) {
  }
  from_.check_end();
}

void TrajectoryStream::skip(uint64_t lines, uint64_t hash) {
  for (; lines_ < lines; ++lines_) {
    if (!take_line())
      fail(Exit::kData, input_.whole_name(), ": it ends at line ", lines_, ", but the checkpoint has read ", lines,
           " lines: another stream?");
    hash_.add(line_).add("\n");
  }
  if (hash_.value() != hash)
    fail(Exit::kData, input_.whole_name(), ": the first ", lines,
         " lines are not those that the checkpoint was trained on");
}

}  // namespace synpo
