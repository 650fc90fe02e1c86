#include "learn/ppo/ppo_options.h"

#include <climits>
#include <cstdint>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/text.h"

namespace synpo {
namespace {

struct Row {
  const char* name;
  std::variant<int*, double*> value;
  double low, high;
  const char* help;  // null: no option
};

std::vector<Row> rows_of(PpoOptions& o) {
  return {
      {"lanes", &o.lanes, 1, 4096, "worlds side by side"},
      {"rollout", &o.rollout, 1, 100000, "steps of each before an update"},
      {"epochs", &o.epochs, 1, 1000, "passes over a rollout"},
      {"minibatches", &o.minibatches, 1, 100000, "of a pass"},
      {"value-warm-up", &o.value_warm_up, 0, INT_MAX, "first rollouts, from which the value alone learns"},
      {"value-hidden", &o.value_hidden, 1, INT_MAX, nullptr},
      {"clip", &o.clipping.clip, 0, 1, "how far the ratio may go from 1"},
      {"entropy", &o.clipping.entropy, 0, 100, "weight of the entropy"},
      {"gradient-norm", &o.gradient_norm, 0, 1e9, "length to which gradients are clipped"},
      {"discount", &o.gae.discount, 0, 1, "gamma"},
      {"lambda", &o.gae.lambda, 0, 1, "lambda of generalised advantage estimation"},
      {"lr", &o.optimiser.learning_rate, 0, 1, "learning rate of RMSProp"},
      {"smoothing", &o.optimiser.smoothing, 0, 1, "decay of its mean square"},
      {"epsilon", &o.optimiser.epsilon, 0, 1, "RMSProp's epsilon"},
      {"weight-decay", &o.optimiser.weight_decay, 0, 1, "L2 term added to the gradient"},
      {"value-loss", &o.value_loss, 0, 1e6, "weight of the value's loss"},
      {"reward-loss", &o.losses.reward, 0, 1e6, "weight of reward prediction; the checkpoint's, or with --init"},
      {"env-loss", &o.losses.env, 0, 1e6, "weight of environment disentanglement; the checkpoint's, or with --init"},
      {"task-loss", &o.losses.task, 0, 1e6, "weight of task disentanglement; the checkpoint's, or with --init"},
  };
}

struct Text {
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return shortest(*value); }
};

}  // namespace

void PpoOptions::add_to(Options& options) {
  options.section("PPO");
  for (const Row& row : rows_of(*this)) {
    if (!row.help) continue;
    if (int* const* whole = std::get_if<int*>(&row.value))
      options.integer(0, row.name, "N", row.help, **whole, int64_t(row.low), int64_t(row.high));
    else
      options.real(0, row.name, "X", row.help, *std::get<double*>(row.value), row.low, row.high);
  }
}

std::map<std::string, std::string> PpoOptions::describe() const {
  PpoOptions copy = *this;
  std::map<std::string, std::string> values;
  for (const Row& row : rows_of(copy)) values[std::string("ppo.") + row.name] = std::visit(Text(), row.value);
  return values;
}

void PpoOptions::check_same(const Checkpoint& checkpoint) const {
  for (const auto& [name, value] : describe()) {
    const auto found = checkpoint.options.find(name);
    const std::string had = found == checkpoint.options.end() ? "none" : found->second;
    // Older checkpoints write the same number otherwise.
    double a, b;
    if (had != value && !(parse_whole(had, a) && parse_whole(value, b) && a == b))
      fail(Exit::kData, "the run in the checkpoint has another --", name.substr(4), ": ", had, ", not ", value);
  }
}

void PpoOptions::take_losses(const Checkpoint& from, const Options& given) {
  for (const Row& row : rows_of(*this)) {
    const std::string name = row.name;
    if (name != "reward-loss" && name != "env-loss" && name != "task-loss") continue;
    for (const std::string& key : {name, "ppo." + name}) {
      const auto found = from.options.find(key);
      if (found == from.options.end()) continue;
      const std::string& text = found->second;
      double weight = 0;
      if (!parse_whole(text, weight) || !(weight >= row.low && weight <= row.high))
        fail(Exit::kData, "option '", key, "': found ", quoted(text), ", expected a number from 0 to 1e6");
      if (!given.given(row.name)) *std::get<double*>(row.value) = weight;
    }
  }
}

}  // namespace synpo
