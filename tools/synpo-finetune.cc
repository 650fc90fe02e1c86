// synpo-finetune: a trained policy goes on learning, for new environments and tasks or by reward.
#include "finetune/finetune.h"

#include "advice.h"
#include "base/cli/options.h"
#include "learn/adapt.h"
#include "learn/ppo/tuning.h"

using namespace synpo;

namespace {

int body(int argc, char** argv) {
  return run_commands(
      "synpo-finetune", "Takes a trained policy further.",
      {{"adapt",
        "embeddings of new environments and tasks from a few demonstrations",
        adapt,
        {kSeeWorld,
         kWriteEnd,
         kNameFolder,
         kNameOtherFolder,
         kSmallerRate,
         kBuildPlugin,
         {kNeedsMore, "{} (sf: synpo-train --sf-loss ce makes policies that can be adapted)"}}},
       {"ppo",
        "reinforcement learning on the seen pairs",
        ppo,
        {kNameFolder, kNameOtherFolder, kLeaveWorld, kSmallerRate, kBuildPlugin, {kNoPairs, "{}: give them with -p"}}},
       {"strip", "leaves out what only training needs", strip}},
      argc, argv);
}

}  // namespace

int main(int argc, char** argv) { return run_tool("synpo-finetune", argc, argv, body); }
