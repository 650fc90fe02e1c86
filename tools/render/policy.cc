// synpo-render policy: what a checkpoint would do in every cell of a maze, against the planner.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/text.h"
#include "draw/canvas/font.h"
#include "draw/face/policy_stage.h"
#include "draw/face/world_face.h"
#include "draw/worlds/faces.h"
#include "format/checkpoint.h"
#include "nn/buffer.h"
#include "play/cell_policy.h"
#include "play/episode.h"
#include "play/model.h"
#include "policy/policy.h"
#include "render/render.h"
#include "world/observation.h"
#include "world/world.h"

using namespace synpo;

namespace {

// Says what the agent remembers in a cell.
std::string history_text(int pictures) {
  if (pictures == 1)
    return "the agent stands in each cell as at the first step of an episode, with no picture from before";
  return concat("the agent stands in each cell and did so in all of the last ", pictures, " pictures");
}

}  // namespace

int policy(int argc, char** argv) {
  PolicyPictureStyle style;
  PictureOptions picture;
  std::string env, task = "R-B";
  int64_t seed = 0, episode = 0, stage = 0, pictures = 0;
  Options options("synpo-render policy", "[OPTION]... [CHECKPOINT]",
                  "Draws a policy's best action in every free cell of a maze, and where the planner disagrees.");
  options.text('e', "env", "NAME", "maze; none: the first of the checkpoint's world", env)
      .text('t', "task", "NAME", "task", task)
      .integer('s', "seed", "N", "seed of the treasures", seed, 0, INT64_MAX)
      .integer(0, "episode", "N", "number of the episode under this seed", episode, 0, UINT32_MAX)
      .integer(0, "stage", "N", "1: on the way to the first treasure; 2: to the second; 0: both side by side", stage, 0,
               2)
      .integer(0, "pictures", "N", "pictures of the agent there that it remembers; 0: 1 in stage 1, 4 in stage 2",
               pictures, 0, kHistory)
      .call(0, "title", "TEXT", "title instead of maze and task", drawn(style.title));
  picture.add_to(options);
  const auto operands = options.parse(argc, argv, 0, 1);
  picture.settle(options);
  style.scale = picture.scale;

  Output output = picture.open();
  const Checkpoint checkpoint = load_checkpoint(operands.empty() ? "-" : operands[0]);
  const std::shared_ptr<const World> world = world_of(checkpoint);
  const std::unique_ptr<const WorldFace> face = face_of(world);
  if (!face->kind().has_policy_picture)
    fail(Exit::kUsage, "a picture of a policy needs ", worlds_with(&FaceKind::has_policy_picture), ", found world ",
         quoted(world->name()));
  Model model = load_model(checkpoint, *world);
  const EnvTask pair = {env.empty() ? 0 : find_env(*face, env, "the checkpoint's world"), find_task(*face, task)};

  Parallel parallel(1);
  model.policy->prepare_inference(parallel, model.parameters.data(), model.statistics.data(), {{pair.env, pair.task}});
  const WorldState start = episode_start(*world, pair, uint64_t(seed), Purpose::kEpisodeStart, episode);
  std::vector<PolicyStage> stages;
  int number = 0;
  for (PolicyStage& each : face->policy_stages(pair, start)) {
    if (++number != stage && stage != 0) continue;
    const int remembered = pictures > 0 ? int(pictures) : each.remembered;
    each.choices = compare_to_expert(*world, pair, each.states,
                                     probe_states(*model.policy, *world, pair, each.states, model.window, remembered));
    stages.push_back(each);
    style.caption += concat(style.caption.empty() ? "" : ". ", "Stage ", number, ": ", history_text(remembered));
  }
  if (style.title.empty())
    style.title = face->name(pair) + (model.is_seen(pair) ? " (seen)" : model.knows(pair) ? " (unseen)" : " (new)");
  style.caption = concat(model.method, ", ", counted(model.updates, "update"), ". ", style.caption);
  const Font font(picture.font);
  picture.finish(output, face->draw_policy(pair, stages, style, font));
  return 0;
}
