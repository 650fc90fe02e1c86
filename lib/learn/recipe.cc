#include "learn/recipe.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>
#include <stdexcept>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "policy/method/registry.h"

namespace synpo {
namespace {

using O = ImitationOptions;

struct Hyper {
  std::string name;
  std::variant<double O::*, bool O::*, int PolicyShape::*, bool PolicyShape::*, SfLoss PolicyShape::*> value;
  double low, high;
  bool whole;
  std::string help;
  const char* heading = nullptr;
  std::vector<std::string> choices = {};  // names of 0, 1, ...
  bool late = false;                      // checkpoints made before this option have its default
  std::vector<std::string> methods = {};  // that have such a thing; none: all
};

constexpr double kMany = 1e9;
constexpr int kTemporalFeature = 256;  // d of Table 3

// The methods that name this option as one of their own.
std::vector<std::string> owners(const std::string& option) {
  std::vector<std::string> names;
  for (const Method& method : methods())
    if (std::ranges::find(method.options, option) != method.options.end()) names.push_back(method.name);
  return names;
}

Hyper size_option(const PolicySize& size) {
  std::string name = size.name;
  std::ranges::replace(name, '_', '-');
  return {name, size.member, double(size.low), double(size.high), true, size.help, nullptr, {}, size.late};
}

std::vector<Hyper> all_hypers() {
  std::vector<Hyper> all = {
      {"trajectories", &O::trajectories, 1, 1e5, true, "whole trajectories an update, where --batch-states is 0",
       "What an update learns from"},
      {"batch-states", &O::batch_states, 0, 1e6, true, "single steps an update, from episodes that run side by side"},
      {"memory", &O::memory, 1, 1e7, true, "trajectories kept in the replay memory"},
      {"read", &O::read, 0, 1e6, true, "trajectories read from the stream before each update"},
      {"fill", &O::fill, 1, 1e7, true, "trajectories read before the first update"},
      {"running", &O::running, 1, 1e7, true, "episodes that run side by side"},
      {"balance", &O::balance, 0.001, 1, false, "probability of taking a step that is not on a treasure"},
      {"balance-final", &O::balance_final, 0, 1, false, "what --balance moves to by the run's end; 0: it stays"},
      {"roll-in", &O::roll_in, 0, 1, false, "probability of the learner's own greedy move after a taken step"},
      {"roll-noise", &O::roll_noise, 0, 1, false, "probability of a random move otherwise"},
      {"fresh-starts", &O::fresh_starts, 0, 1, true,
       "running episodes start anywhere; the stream gives the pairs alone"},
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
      {"normalise-input", &PolicyShape::normalise_input, 0, 1, true,
       "batch normalisation of the pictures; else fixed scaling"},
      {"normalise-embeddings", &PolicyShape::normalise_embeddings, 0, 1, true, "embeddings are scaled to one length"},
  };
  std::vector<Hyper> single;  // those that SynPo has not
  for (const PolicySize& size : policy_sizes()) {
    const Hyper option = size_option(size);
    const std::vector<std::string> of = owners(option.name);
    (of.empty() || std::ranges::find(of, "synpo") != of.end() ? all : single).push_back(option);
  }
  single.insert(
      single.end(),
      {{"dropout", &O::dropout, 0, 0.99, false, "probability that a value of that is left out", nullptr, {}, true},
       {"sf-loss",
        &PolicyShape::sf_loss,
        0,
        2,
        true,
        "temporal differences (td), the planner's Q (q) or cross-entropy (ce)",
        nullptr,
        {"td", "q", "ce"},
        true},
       {"discount", &O::discount, 0, 0.9999, false, "gamma of td", nullptr, {}, true}});
  single.front().heading = "Single methods";
  all.insert(all.end(), single.begin(), single.end());
  for (Hyper& hyper : all) {
    hyper.methods = owners(hyper.name);
    std::string names;
    for (const std::string& name : hyper.methods) names += (names.empty() ? "" : ", ") + name;
    if (!names.empty()) hyper.help = names + ": " + hyper.help;
  }
  return all;
}

const std::vector<Hyper>& hypers() {
  static const std::vector<Hyper> all = all_hypers();
  return all;
}

const Hyper& find(const std::string& name) { return *std::ranges::find(hypers(), name, &Hyper::name); }

bool has(const Hyper& hyper, const std::string& method) {
  return hyper.methods.empty() || std::ranges::find(hyper.methods, method) != hyper.methods.end();
}

bool is_toggle(const Hyper& hyper) {
  return std::holds_alternative<bool O::*>(hyper.value) || std::holds_alternative<bool PolicyShape::*>(hyper.value);
}

// The value that a member of the options, or of their network, refers to.
template <class Value>
auto& place(Value O::*member, auto& options) {
  return options.*member;
}
template <class Value>
auto& place(Value PolicyShape::*member, auto& options) {
  return options.network.*member;
}

double get(const Hyper& hyper, const O& options) {
  return std::visit([&](auto member) { return double(place(member, options)); }, hyper.value);
}

void set(const Hyper& hyper, O& options, double value) {
  std::visit(
      [&](auto member) {
        auto& to = place(member, options);
        using Value = std::decay_t<decltype(to)>;
        if constexpr (std::is_same_v<Value, bool>)
          to = value != 0;
        else if constexpr (std::is_same_v<Value, SfLoss>)
          to = SfLoss(int(value));
        else
          to = Value(value);
      },
      hyper.value);
}

void give(const std::vector<MethodDefault>& defaults, O& options) {
  for (const MethodDefault& given : defaults) set(find(given.option), options, given.value);
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
  return concat("expected ", hyper.whole ? "a whole number" : "a number", " from ", shortest(hyper.low), " to ",
                shortest(hyper.high));
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
  PolicyShape shape = network;
  shape.observation = world.observation_spec();
  shape.envs = world.envs();
  shape.tasks = world.task_count();
  shape.actions = world.actions();
  return shape;
}

double O::rate(int64_t update, int64_t total) const {
  if (update < warm_up) return learning_rate * (update + 1) / warm_up;
  if (!cosine) return learning_rate;
  return final_rate + (learning_rate - final_rate) * 0.5 * (1 + std::cos(M_PI * done(update, total)));
}

ImitationOptions recipe(const std::string& name, const std::string& method, Sight sight) {
  ImitationOptions options;
  if (sight == Sight::kFeatures) options.network.feature = kTemporalFeature;
  const Method& row = find_method(method);
  give(row.defaults, options);
  if (name == "paper") {
    options.network.normalise_input = true;
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
  give(row.fast, options);
  return options;
}

namespace {

// A recipe's value of a hyper-parameter, and in parentheses the methods that have another: "0.001 (mlp 1e-05, modulenet
// 0)".
std::string default_of(const Hyper& hyper, const std::string& name) {
  std::string common, others;
  for (const std::string& method : method_names()) {
    if (!has(hyper, method)) continue;
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
  options
      .call(0, "recipe", "NAME", "preset: fast, or paper (the supplement to the letter) [fast]",
            [this](const std::string& name) {
              try {
                recipe(name);
              } catch (const Error&) {
                throw std::invalid_argument("expected fast or paper");
              }
              recipe_ = name;
              recipe_given_ = true;
            })
      .suggest({"fast", "paper"});
  for (const Hyper& hyper : hypers()) {
    if (hyper.heading) options.section(hyper.heading);
    const std::string a = default_of(hyper, "fast"), b = default_of(hyper, "paper");
    const std::string shown = hyper.help + (a == b ? " [" + a + "]" : " [fast " + a + ", paper " + b + "]");
    if (is_toggle(hyper)) {
      options.toggle(hyper.name.c_str(), shown, [this, &hyper](bool on) { changes_[hyper.name] = on; });
      continue;
    }
    options.call(0, hyper.name.c_str(), "X", shown, [this, &hyper](const std::string& text) {
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

std::vector<std::string> RecipeOptions::option_names() {
  std::vector<std::string> names = {"recipe", "no-reward-loss", "no-env-loss", "no-task-loss"};
  for (const Hyper& hyper : hypers()) names.push_back(hyper.name);
  return names;
}

ImitationOptions RecipeOptions::result(const std::string& method, Sight sight) const {
  ImitationOptions options = recipe(recipe_, method, sight);
  for (const Hyper& hyper : hypers())
    if (const auto change = changes_.find(hyper.name); change != changes_.end()) {
      if (!has(hyper, method)) fail(Exit::kUsage, "-m ", method, " has no --", hyper.name);
      set(hyper, options, change->second);
    }
  if (no_reward_loss_) options.reward_loss = 0;
  if (no_env_loss_) options.env_loss = 0;
  if (no_task_loss_) options.task_loss = 0;
  if (options.batch_states == 0)
    for (const char* name :
         {"balance", "balance-final", "roll-in", "roll-noise", "fresh-starts", "roll-limit", "running"})
      if (changes_.count(name)) fail(Exit::kUsage, "--", name, " needs --batch-states");
  if (options.batch_states > 0 && changes_.count("trajectories"))
    fail(Exit::kUsage, "--trajectories needs --batch-states 0");
  return options;
}

std::map<std::string, std::string> describe_options(const ImitationOptions& options) {
  std::map<std::string, std::string> values;
  for (const Hyper& hyper : hypers()) values[hyper.name] = show(hyper, get(hyper, options));
  return values;
}

ImitationOptions parse_options(const std::map<std::string, std::string>& values) {
  ImitationOptions options;
  for (const Hyper& hyper : hypers()) {
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
