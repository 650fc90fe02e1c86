#include "learn/recipe.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <variant>

#include "base/error.h"
#include "base/text.h"
#include "play/model.h"
#include "policy/method/registry.h"

namespace synpo {
namespace {

using O = ImitationOptions;

struct Hyper {
  const char* name;
  std::variant<double O::*, bool O::*> value;
  double low, high;
  bool whole;
  const char* help;
  const char* heading = nullptr;
  std::vector<std::string> choices = {};  // names of 0, 1, ...
  bool late = false;                      // checkpoints made before this option have its default
  std::set<std::string> methods = {};     // that have such a thing; none: all
};

constexpr double kMany = 1e9;
constexpr int kTemporalFeature = 256;  // d of Table 3

const Hyper kHypers[] = {
    {"trajectories", &O::trajectories, 1, 1e5, true, "whole trajectories an update, where --batch-states is 0",
     "What an update learns from"},
    {"batch-states", &O::batch_states, 0, 1e6, true, "single steps an update, from episodes that run side by side"},
    {"memory", &O::memory, 1, 1e7, true, "trajectories kept in the replay memory"},
    {"read", &O::read, 0, 1e6, true, "trajectories read from the stream before each update"},
    {"fill", &O::fill, 1, 1e7, true, "trajectories read before the first update"},
    {"running", &O::running, 1, 1e7, true, "episodes that run side by side"},
    {"balance", &O::balance, 0.001, 1, false, "probability of taking a step that is not on a treasure"},
    {"balance-final", &O::balance_final, 0, 1, false, "what --balance moves to by the run's end; 0: it stays"},
    {"roll-in", &O::roll_in, 0, 1, false, "probability of the learner's own greedy move behind a taken step"},
    {"roll-noise", &O::roll_noise, 0, 1, false, "probability of a random move otherwise"},
    {"fresh-starts", &O::fresh_starts, 0, 1, true, "running episodes start anywhere; the stream gives the pairs alone"},
    {"roll-limit", &O::roll_limit, 1, kStepLimit, true, "steps after which a running episode is given up"},
    {"lr", &O::learning_rate, 0, 1, false, "learning rate of Adam", "The optimiser"},
    {"cosine", &O::cosine, 0, 1, true,
     "the learning rate falls by half a cosine to the run's end; else it is constant"},
    {"lr-final", &O::final_rate, 0, 1, false, "learning rate at the cosine's end"},
    {"warm-up", &O::warm_up, 0, kMany, true, "updates over which the learning rate rises from 0"},
    {"beta1", &O::beta1, 0, 0.9999999, false, "decay of Adam's first moment"},
    {"beta2", &O::beta2, 0, 0.9999999, false, "decay of Adam's second moment"},
    {"epsilon", &O::epsilon, 1e-30, 1, false, "Adam's epsilon"},
    {"weight-decay", &O::weight_decay, 0, 1, false, "L2 term added to the gradient"},
    {"averaging", &O::averaging, 0, 0.9999999, false,
     "decay of the averaged weights that are evaluated and saved; 0: none"},
    {"reward-loss", &O::reward_loss, 0, 1e6, false, "weight of reward prediction (lambda 1)", "The losses"},
    {"env-loss", &O::env_loss, 0, 1e6, false, "weight of environment disentanglement (lambda 2)"},
    {"task-loss", &O::task_loss, 0, 1e6, false, "weight of task disentanglement (lambda 3)"},
    {"embedding-sd", &O::embedding_sd, 0, 1e3, false, "embeddings start as N(0, SD^2); 0: Xavier uniform",
     "The network"},
    {"normalise-input", &O::normalise_input, 0, 1, true, "batch normalisation of the pictures; else fixed scaling"},
    {"normalise-embeddings", &O::normalise_embeddings, 0, 1, true, "embeddings are scaled to one length"},
    {"feature", &O::feature, 1, 4096, true, "size d of the state feature; kitchens: 256"},
    {"basis", &O::basis, 1, 4096, true, "number K of basis policies"},
    {"embedding", &O::embedding, 1, 4096, true, "size of the embeddings"},
    {"hidden", &O::hidden, 1, 16384, true, "hidden units of alpha, beta, f_env and f_task"},
    {"action-embedding",
     &O::action_embedding,
     0,
     4096,
     true,
     "synpo, mtl: size of learned phi(a); 0: phi(a) is one-hot",
     nullptr,
     {},
     true,
     {"synpo", "mtl"}},
    {"head-hidden",
     &O::head_hidden,
     1,
     16384,
     true,
     "mlp, modulenet, sf: hidden units of their own parts",
     "Single methods",
     {},
     true,
     {"mlp", "modulenet", "sf"}},
    {"seam",
     &O::seam,
     1,
     4096,
     true,
     "modulenet: size of what a task's module hands on",
     nullptr,
     {},
     true,
     {"modulenet"}},
    {"dropout",
     &O::dropout,
     0,
     0.99,
     false,
     "modulenet: probability that a value of that is left out",
     nullptr,
     {},
     true,
     {"modulenet"}},
    {"sf-loss",
     &O::sf_loss,
     0,
     2,
     true,
     "sf: temporal differences (td), the planner's Q (q) or cross-entropy (ce)",
     nullptr,
     {"td", "q", "ce"},
     true,
     {"sf"}},
    {"discount", &O::discount, 0, 0.9999, false, "sf: gamma of td", nullptr, {}, true, {"sf"}},
};

// What differs from method to method.
struct MethodDefault {
  const char *method, *name;
  double value;
};
// In every recipe: what the method is.
constexpr MethodDefault kMethodDefaults[] = {
    {"mlp", "feature", 256}, {"modulenet", "head-hidden", 128}, {"sf", "head-hidden", 512}, {"sf", "reward-loss", 1}};
// In "fast": what scripts/reproduce grid has chosen, but for MTL's embeddings (lab/book.md).
constexpr MethodDefault kFastDefaults[] = {{"mlp", "embedding-sd", 0.3},
                                           {"mlp", "weight-decay", 1e-5},
                                           {"modulenet", "dropout", 0},
                                           {"modulenet", "weight-decay", 0},
                                           {"sf", "sf-loss", double(SfLoss::kCrossEntropy)},
                                           {"sf", "embedding-sd", 0.1},
                                           {"sf", "reward-loss", 0.01},
                                           {"sf", "weight-decay", 1e-4}};

const Hyper& find(const std::string& name) {
  return *std::find_if(std::begin(kHypers), std::end(kHypers), [&](const Hyper& hyper) { return hyper.name == name; });
}

bool is_toggle(const Hyper& hyper) { return std::holds_alternative<bool O::*>(hyper.value); }
double get(const Hyper& hyper, const O& options) {
  return std::visit([&](auto member) { return double(options.*member); }, hyper.value);
}
void set(const Hyper& hyper, O& options, double value) {
  if (is_toggle(hyper))
    options.*std::get<bool O::*>(hyper.value) = value != 0;
  else
    options.*std::get<double O::*>(hyper.value) = value;
}

template <size_t N>
void give(const MethodDefault (&defaults)[N], const std::string& method, O& options) {
  for (const MethodDefault& given : defaults)
    if (method == given.method) set(find(given.name), options, given.value);
}

std::string show(const Hyper& hyper, double value) {
  return hyper.choices.empty() ? shortest(value) : hyper.choices[size_t(value)];
}

bool parse(const std::string& text, const Hyper& hyper, double& value) {
  if (!hyper.choices.empty()) {
    value = double(std::find(hyper.choices.begin(), hyper.choices.end(), text) - hyper.choices.begin());
    return value < double(hyper.choices.size());
  }
  return parse_whole(text, value) && value >= hyper.low && value <= hyper.high &&
         (!hyper.whole || value == std::floor(value));
}

std::string expectation(const Hyper& hyper) {
  if (!hyper.choices.empty()) return "expected " + alternatives(hyper.choices);
  return concat("expected ", hyper.whole ? "a whole number" : "a number", " from ", hyper.low, " to ", hyper.high);
}

}  // namespace

double O::done(int64_t update, int64_t total) const {
  return std::clamp((update - warm_up) / std::max(1.0, double(total) - warm_up), 0.0, 1.0);
}

RunningOptions O::running_options(int64_t update, int64_t total) const {
  const double now = balance_final == 0 ? balance : balance + (balance_final - balance) * done(update, total);
  return {int(running), now, roll_in, roll_noise, fresh_starts, int(roll_limit)};
}

PolicyShape O::shape(const World& world) const {
  PolicyShape shape;
  shape.observation = world.observation_spec();
  shape.envs = world.envs();
  shape.tasks = world.task_count();
  shape.actions = world.actions();
  shape.feature = int(feature);
  shape.basis = int(basis);
  shape.embedding = int(embedding);
  shape.hidden = int(hidden);
  shape.action_embedding = int(action_embedding);
  shape.head_hidden = int(head_hidden);
  shape.seam = int(seam);
  shape.sf_loss = SfLoss(int(sf_loss));
  shape.normalise_input = normalise_input;
  shape.normalise_embeddings = normalise_embeddings;
  return shape;
}

double O::rate(int64_t update, int64_t total) const {
  if (update < warm_up) return learning_rate * (update + 1) / warm_up;
  if (!cosine) return learning_rate;
  return final_rate + (learning_rate - final_rate) * 0.5 * (1 + std::cos(M_PI * done(update, total)));
}

ImitationOptions recipe(const std::string& name, const std::string& method, Sight sight) {
  ImitationOptions options;
  if (sight == Sight::kFeatures) options.feature = kTemporalFeature;
  give(kMethodDefaults, method, options);
  if (name == "paper") {
    options.normalise_input = true;
    return options;
  }
  if (name != "fast") fail(Exit::kUsage, "unknown recipe ", quoted(name), ", expected fast or paper");
  options.batch_states = 512;
  options.fill = 2000;
  options.balance = 0.1;
  options.balance_final = 0.3;
  options.roll_in = 0.5;
  options.roll_noise = 0.1;
  options.fresh_starts = true;
  options.roll_limit = 120;
  options.learning_rate = 0.002;
  options.cosine = true;
  options.warm_up = 200;
  options.task_loss = 1;
  options.embedding_sd = 1;
  give(kFastDefaults, method, options);
  return options;
}

namespace {

// A recipe's value of a hyper-parameter, and in parentheses the methods that have another: "0.001 (mlp 1e-05, modulenet
// 0)".
std::string default_of(const Hyper& hyper, const std::string& name) {
  std::string common, others;
  for (const std::string& method : method_names()) {
    if (!hyper.methods.empty() && !hyper.methods.count(method)) continue;
    const double own = get(hyper, recipe(name, method));
    const std::string value = is_toggle(hyper) ? (own != 0 ? "on" : "off") : show(hyper, own);
    if (common.empty())
      common = value;
    else if (value != common)
      others += (others.empty() ? "" : ", ") + method + " " + value;
  }
  return others.empty() ? common : common + " (" + others + ")";
}

}  // namespace

void RecipeOptions::add_to(Options& options) {
  options.call(0, "recipe", "NAME", "preset: fast, or paper (the supplement to the letter) [fast]",
               [this](const std::string& name) {
                 try {
                   recipe(name);
                 } catch (const Error&) {
                   throw std::invalid_argument("expected fast or paper");
                 }
                 recipe_ = name;
                 recipe_given_ = true;
               });
  for (const Hyper& hyper : kHypers) {
    if (hyper.heading) options.section(hyper.heading);
    const std::string a = default_of(hyper, "fast"), b = default_of(hyper, "paper");
    const std::string shown =
        std::string(hyper.help) + (a == b ? " [" + a + "]" : " [fast " + a + ", paper " + b + "]");
    if (is_toggle(hyper)) {
      options.toggle(hyper.name, shown.c_str(), [this, &hyper](bool on) { changes_[hyper.name] = on; });
      continue;
    }
    options.call(0, hyper.name, "X", shown.c_str(), [this, &hyper](const std::string& text) {
      double value = 0;
      if (!parse(text, hyper, value)) throw std::invalid_argument(expectation(hyper));
      changes_[hyper.name] = value;
    });
  }
  options.section("Ablations")
      .flag(0, "no-reward-loss", "the same as --reward-loss 0", no_reward_loss_)
      .flag(0, "no-env-loss", "the same as --env-loss 0", no_env_loss_)
      .flag(0, "no-task-loss", "the same as --task-loss 0", no_task_loss_);
}

ImitationOptions RecipeOptions::result(const std::string& method, Sight sight) const {
  ImitationOptions options = recipe(recipe_, method, sight);
  for (const Hyper& hyper : kHypers)
    if (const auto change = changes_.find(hyper.name); change != changes_.end()) {
      if (!hyper.methods.empty() && !hyper.methods.count(method))
        fail(Exit::kUsage, "-m ", method, " has no --", hyper.name);
      set(hyper, options, change->second);
    }
  if (no_reward_loss_) options.reward_loss = 0;
  if (no_env_loss_) options.env_loss = 0;
  if (no_task_loss_) options.task_loss = 0;
  if (options.batch_states == 0)
    for (const char* name :
         {"balance", "balance-final", "roll-in", "roll-noise", "fresh-starts", "roll-limit", "running"})
      if (changes_.count(name)) fail(Exit::kUsage, "--", name, " needs --batch-states");
  return options;
}

std::map<std::string, std::string> describe_options(const ImitationOptions& options) {
  std::map<std::string, std::string> values;
  for (const Hyper& hyper : kHypers) values[hyper.name] = show(hyper, get(hyper, options));
  return values;
}

ImitationOptions parse_options(const std::map<std::string, std::string>& values) {
  ImitationOptions options;
  for (const Hyper& hyper : kHypers) {
    const auto found = values.find(hyper.name);
    if (found == values.end() && hyper.late) continue;
    if (found == values.end()) fail(Exit::kData, "the checkpoint has no option '", hyper.name, "'");
    double value = 0;
    if (!parse(found->second, hyper, value))
      fail(Exit::kData, "option '", hyper.name, "': found ", quoted(found->second), ", ", expectation(hyper));
    set(hyper, options, value);
  }
  return options;
}

}  // namespace synpo
