#include "learn/ppo/tuning.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "format/run_log.h"
#include "learn/recipe.h"
#include "nn/buffer.h"
#include "play/episode.h"
#include "play/evaluate.h"
#include "play/model.h"
#include "play/world_factory.h"

namespace synpo {
namespace {

constexpr int kStatisticsBatches = 40;

Model random_model(const TuningSettings& s, const World& world) {
  const ImitationOptions network = recipe(kDefaultRecipe, s.method, world.observation_spec().sight);
  return fresh_model(s.method, network.shape(world), {s.seed, network.embedding_sd});
}

std::set<uint64_t> numbers_of(const World& world, const std::vector<EnvTask>& pairs) {
  std::set<uint64_t> numbers;
  for (const EnvTask& pair : pairs) numbers.insert(world.pair_number(pair));
  return numbers;
}

}  // namespace

Tuning::Tuning(const TuningSettings& s, const Options& given, Parallel& parallel)
    : parallel_(parallel), steps_(s.steps) {
  const bool resumes = !s.resume.empty(), fresh = s.random && !resumes;
  const Checkpoint from = fresh ? Checkpoint() : load_checkpoint(resumes ? s.resume : s.checkpoint);
  if (resumes && given.given("method") && s.method != from.method)
    fail(Exit::kData, "the run in the checkpoint has method ", from.method, ", not ", s.method);
  if (const std::string kind = s.world.substr(0, s.world.find(':')); resumes && !kind.empty() && kind != from.world)
    fail(Exit::kData, "the run in the checkpoint has world ", from.world, ", not ", kind);
  PpoOptions ppo = s.ppo;
  ppo.take_losses(from, given);
  if (fresh)
    world_ = open_world(s.world);
  else  // a run from random weights may hold its world, whatever it was drawn in
    world_ = world_of(from, s.random && !lies_in_files(from) ? "" : s.world);
  Model model = fresh ? random_model(s, *world_) : load_model(from, *world_);
  if (!s.pairs.empty()) {
    std::vector<EnvTask> pairs = read_seen_pairs(*world_, s.pairs);
    // A resumed run keeps the checkpoint's order, from which its episodes are drawn.
    if (!resumes)
      model.seen = std::move(pairs);
    else if (numbers_of(*world_, pairs) != numbers_of(*world_, model.seen))
      fail(Exit::kData, s.pairs, ": found other pairs than those that the run in the checkpoint learns on");
  }
  if (model.seen.empty()) fail(Exit::kData, kNoPairs, "no pair to learn on");
  compute_on(s.device, parallel, model);
  run_.emplace(*world_, parallel, std::move(model), ppo, s.seed);
  if (resumes) {
    run_->resume(from);
    // The last rollout may have gone beyond the steps that were asked for.
    if (steps_ <= run_->steps() - int64_t(ppo.lanes) * ppo.rollout)
      fail(Exit::kUsage, "found ", steps_, " steps in all, expected at least the ", run_->steps(),
           " that the checkpoint has");
  } else if (fresh) {
    run_->measure_statistics(kStatisticsBatches);
  }
  reported_steps_ = run_->steps();
}

const std::vector<std::string>& Tuning::columns() const {
  static const std::vector<std::string> names = {"update",       "states",      "seconds",
                                                 "states_per_s", "episodes",    "success",
                                                 "wrong",        "reward",      "length",
                                                 "policy",       "value",       "entropy",
                                                 "kl",           "clip",        "explained_variance",
                                                 "seen_success", "seen_reward", "unseen_success",
                                                 "unseen_reward"};
  return names;
}

std::string Tuning::report(const Report& report) {
  const PpoReport r = run_->take_report();
  const double n = double(r.finished.episodes);  // 0 / 0: nothing ended
  const double rate = double(r.steps - reported_steps_) / report.interval_s;
  reported_steps_ = r.steps;
  RunLogRow::Evaluation e{NAN, NAN, NAN, NAN};
  const Model& model = run_->model();
  if (report.evaluate_episodes > 0)
    e = evaluate_sample(parallel_, *world_, model, model.parameters.data(), model.statistics.data(),
                        report.evaluate_episodes);
  report.log.write({double(r.updates), double(r.steps), report.seconds, rate, n, r.finished.successes / n,
                    r.finished.wrong / n, r.finished.reward_cents / 100.0 / n, r.finished.length / n, r.policy, r.value,
                    r.entropy, r.kl, r.clip_fraction, r.explained_variance, e.seen_success, e.seen_reward,
                    e.unseen_success, e.unseen_reward});
  const std::string speed = short_count(rate) + " steps/s";
  return n > 0 ? concat("success ", percent_text(r.finished.successes / n), ", ", speed) : speed;
}

}  // namespace synpo
