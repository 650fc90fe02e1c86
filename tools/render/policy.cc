// synpo-render policy: what a checkpoint would do in every cell of a maze, against the planner.
#include "base/error.h"
#include "draw/grid/policy_picture.h"
#include "play/cell_policy.h"
#include "play/model.h"
#include "render/render.h"

using namespace synpo;

namespace {

EnvTask find_pair(const GridSet& world, const std::string& env, const std::string& task) {
  const EnvTask pair = {env.empty() ? 0 : world.env_index(env), world.task_index(task)};
  if (pair.env < 0) fail(Exit::kUsage, "no maze ", quoted(env), " in the checkpoint's world");
  if (pair.task < 0) fail(Exit::kUsage, "no task ", quoted(task), ": expected two of R B G O P, such as R-B");
  return pair;
}

// The same treasures when the first one of the task has been picked.
GridState second_stage(const Task& task, GridState state) {
  state.now.treasures[task.first] = kPicked;
  state.picked = 1;
  return state;
}

// What the agent remembers in a cell.
std::string history_text(int pictures) {
  if (pictures == 1)
    return "the agent stands in each cell as at the first step of an episode, with no picture from before";
  return concat("the agent stands in each cell and did so in all of the last ", pictures, " pictures");
}

}  // namespace

int policy(int argc, char** argv) {
  PolicyPictureStyle style;
  PictureOptions picture;
  std::string env, task_name = "R-B";
  int64_t seed = 0, episode = 0, stage = 0, pictures = 0;
  Options options("synpo-render policy", "[OPTION]... [CHECKPOINT]",
                  "Draws a policy's best action in every free cell of a maze, and where the planner disagrees.");
  options.text('e', "env", "NAME", "maze; none: the first of the checkpoint's world", env)
      .text('t', "task", "NAME", "task", task_name)
      .integer('s', "seed", "N", "seed of the treasures", seed, 0, INT64_MAX)
      .integer(0, "episode", "N", "number of the episode under this seed", episode, 0, UINT32_MAX)
      .integer(0, "stage", "N", "1: on the way to the first treasure; 2: to the second; 0: both side by side", stage, 0,
               2)
      .integer(0, "pictures", "N", "pictures of the agent there that it remembers; 0: 1 in stage 1, 4 in stage 2",
               pictures, 0, kHistory)
      .call(0, "title", "TEXT", "title instead of maze and task", drawn(style.title));
  picture.add_to(options);
  const auto operands = options.parse(argc, argv, 0, 1);
  style.scale = picture.scale;

  Output output(picture.output, Output::Kind::kBinary, picture.force);
  const Checkpoint checkpoint = load_checkpoint(operands.empty() ? "-" : operands[0]);
  const std::unique_ptr<World> restored = world_of(checkpoint);
  const GridSet& world = as_gridworld(*restored, "a picture of a policy");
  Model model = load_model(checkpoint, world);
  const EnvTask pair = find_pair(world, env, task_name);
  const Maze& maze = world.maze(pair.env);
  const Task& task = world.tasks()[pair.task];

  Parallel parallel(1);
  model.policy->prepare_inference(parallel, model.parameters.data(), model.statistics.data(), {{pair.env, pair.task}});
  const GridState start = to_grid_state(episode_start(world, pair, uint64_t(seed), Purpose::kEpisodeStart, episode));
  std::vector<PolicyStage> stages;
  for (const int number : {1, 2})
    if (stage == 0 || stage == number) {
      const GridState state = number == 1 ? start : second_stage(task, start);
      // No episode begins in stage 2: a policy has never seen it with an empty history.
      const int remembered = pictures > 0 ? int(pictures) : number == 1 ? 1 : kHistory;
      stages.push_back(compare_to_planner(maze, world.planner(pair.env), task, state,
                                          probe_cells(*model.policy, world, pair, state, model.window, remembered)));
      style.caption += concat(style.caption.empty() ? "" : ". ", "Stage ", number, ": ", history_text(remembered));
    }
  if (style.title.empty())
    style.title = concat(maze.name, ", task ", task.name(), model.is_seen(pair) ? " (seen)" : " (unseen)");
  style.caption = concat(model.method, ", ", model.updates, " updates. ", style.caption);
  finish(output, draw_policy(maze, task, stages, style, Font(picture.font)));
  return 0;
}
