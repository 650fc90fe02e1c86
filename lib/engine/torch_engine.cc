#include "engine/torch_engine.h"

#include <dlfcn.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "engine/torch_api.h"

namespace synpo {
namespace {

std::string folder_of_program() {
  char path[PATH_MAX];
  const ssize_t size = readlink("/proc/self/exe", path, sizeof path);
  return size > 0 ? std::filesystem::path(std::string(path, size_t(size))).parent_path().string() : ".";
}

std::vector<std::string> plugin_places() {
  if (const char* given = std::getenv("SYNPO_TORCH"); given && *given) return {given};
  const std::string folder = folder_of_program();
  return {folder + "/" + kTorchPluginFile, folder + "/../lib/synpo/" + kTorchPluginFile};
}

// Loaded once, and kept until the program ends: LibTorch cannot be unloaded.
const TorchApi& plugin() {
  static const TorchApi* const api = [] {
    std::string reason;
    for (const std::string& place : plugin_places()) {
      if (access(place.c_str(), F_OK) != 0) continue;
      void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (!library) fail(Exit::kUnavailable, "cannot load ", place, ": ", dlerror());
      const auto function = reinterpret_cast<TorchApiFunction>(dlsym(library, kTorchApiSymbol));
      const TorchApi* found = function ? function() : nullptr;
      if (!found || found->version != kTorchApiVersion)
        fail(Exit::kUnavailable, place, " is not of this version of synpo");
      return found;
    }
    fail(Exit::kUnavailable, kNoPlugin, "no plug-in of LibTorch at ", plugin_places()[0]);
  }();
  return *api;
}

TorchLayout describe(const Layout& layout, std::vector<TorchTensor>& tensors) {
  for (const TensorInfo& tensor : layout.tensors())
    tensors.push_back({tensor.name.c_str(), tensor.shape.data(), int(tensor.shape.size()), tensor.offset, tensor.size});
  return {tensors.data(), int(tensors.size()), layout.total()};
}

// The layouts and numbers of a configuration; lives as long as what is made from it.
class Description {
 public:
  Description(const TorchSettings& settings, const std::string& method, const PolicyShape& shape,
              const Policy<float>& policy) {
    const ObservationSpec& seen = shape.observation;
    for (const Rgb& colour : seen.palette) palette_.insert(palette_.end(), {colour.r, colour.g, colour.b});
    config = {};
    config.method = method.c_str();
    config.device = settings.device.c_str();
    config.precision = settings.precision == "bf16"   ? TorchPrecision::kBf16
                       : settings.precision == "tf32" ? TorchPrecision::kTf32
                                                      : TorchPrecision::kFloat32;
    config.graphs = settings.graphs;
    config.threads = settings.threads;
    config.features = seen.sight == Sight::kFeatures;
    config.side = seen.side;
    config.history = kHistory;
    config.colours = int(seen.palette.size());
    config.palette = palette_.data();
    config.view = seen.view;
    config.objects = seen.objects;
    config.object_floats = ObservationSpec::kObjectFloats;
    config.envs = shape.envs;
    config.tasks = shape.tasks;
    config.actions = shape.actions;
    config.feature = shape.feature;
    config.basis = shape.basis;
    config.embedding = shape.embedding;
    config.action_embedding = shape.action_embedding;
    config.seam = shape.seam;
    config.sf_loss = int(shape.sf_loss);
    config.normalise_input = shape.normalise_input;
    config.normalise_embeddings = shape.normalise_embeddings;
    config.parameters = describe(policy.parameters(), parameters_);
    config.statistics = describe(policy.statistics(), statistics_);
  }
  TorchConfig config;

 private:
  std::vector<uint8_t> palette_;
  std::vector<TorchTensor> parameters_, statistics_;
};

class TorchEngine : public Engine {
 public:
  TorchEngine(const TorchSettings& settings, const std::string& method, const PolicyShape& shape, Policy<float>& policy)
      : api_(plugin()), policy_(policy), unit_(settings.device == "cpu" ? 64 : 512) {
    const Description description(settings, method, shape, policy);
    if (api_.create(&description.config, &engine_) != 0)
      fail(Exit::kUnavailable, "LibTorch cannot compute on ", settings.device, ": ", api_.last_error());
  }
  ~TorchEngine() override { api_.destroy(engine_); }
  TorchEngine(const TorchEngine&) = delete;
  TorchEngine& operator=(const TorchEngine&) = delete;

  Losses step(Parallel&, const StepBatch<float>& batch, const StepOptions& options, const float* parameters,
              float* statistics, float* gradient, float* logits) override {
    if (batch.objective) fail(Exit::kInternal, "LibTorch cannot take the gradient of an objective");
    std::vector<float> keep;
    const TorchBatch given = describe(batch, options, keep);
    const TorchStepOptions torch_options = describe(options);
    TorchLosses losses;
    check(api_.step(engine_, &given, &torch_options, parameters, statistics, gradient, logits, &losses));
    return result(losses, options);
  }

  void prepare_inference(Parallel&, const float* parameters, const float* statistics,
                         const std::vector<std::pair<int, int>>& pairs) override {
    pairs_ = pairs;
    check(api_.prepare_inference(engine_, parameters, statistics));
  }
  void infer(int, int size, const uint8_t* observations, const int* pair, float* logits, float* psi) override {
    std::vector<int> env, task;
    for (int i = 0; i < size; ++i) {
      env.push_back(pairs_[size_t(pair[i])].first);
      task.push_back(pairs_[size_t(pair[i])].second);
    }
    check(api_.infer(engine_, unit_, size, observations, env.data(), task.data(), logits, psi));
  }
  int inference_unit() const override { return unit_; }

  void take(const TrainingArrays& arrays) override {
    arrays_ = {arrays.parameters,    arrays.statistics, arrays.first_moment,
               arrays.second_moment, arrays.average,    arrays.average_statistics};
    check(api_.take(engine_, &arrays_));
  }
  void begin_update(Parallel&, const StepBatch<float>& batch, const StepOptions& options, const AdamUpdate& adam,
                    float* logits) override {
    std::vector<float> keep;
    const TorchBatch given = describe(batch, options, keep);
    const TorchStepOptions torch_options = describe(options);
    const AdamOptions& a = adam.options;
    const TorchAdam torch_adam = {a.learning_rate, a.beta1, a.beta2, a.epsilon, a.weight_decay, adam.step, adam.keep};
    check(api_.begin_update(engine_, &given, &torch_options, &torch_adam));
    begun_ = {options, logits};
    moved_ = true;
  }
  Losses end_update() override {
    TorchLosses losses;
    check(api_.end_update(engine_, begun_.logits, &losses));
    return result(losses, begun_.options);
  }
  void give_back() override {
    if (!moved_) return;
    if (value_)
      check(api_.give_back_ppo(engine_, &ppo_arrays_));
    else
      check(api_.give_back(engine_, &arrays_));
    moved_ = false;
  }

  void take_ppo(ValueFunction& value, const PpoArrays& a) override {
    value_ = &value;
    ppo_arrays_ = {a.parameters, a.statistics, a.mean_squares, a.value_parameters, a.value_mean_squares};
    std::vector<TorchTensor> tensors;
    const TorchLayout layout = synpo::describe(value.parameters(), tensors);
    check(api_.take_ppo(engine_, &layout, &ppo_arrays_));
  }
  PpoLosses update_ppo(Parallel&, const PpoBatch& batch, const PpoUpdate& update) override {
    std::vector<float> keep;
    const StepOptions auxiliary = {update.auxiliary};
    const TorchPpoBatch given = {describe(batch.steps, auxiliary, keep), batch.log_probability, batch.advantage,
                                 batch.target};
    const auto rmsprop = [](const RmsPropOptions& o) {
      return TorchRmsProp{o.learning_rate, o.smoothing, o.epsilon, o.weight_decay};
    };
    const TorchPpoOptions options = {describe(auxiliary),  update.clipping.clip, update.clipping.entropy,
                                     update.value_weight,  update.gradient_norm, rmsprop(update.policy),
                                     rmsprop(update.value)};
    TorchPpoLosses from;
    check(api_.update_ppo(engine_, &given, &options, &from));
    moved_ = true;
    PpoLosses losses;
    static_cast<ClippedLosses&>(losses) = {from.policy,        from.entropy,       from.kl,
                                           from.clip_fraction, from.largest_ratio, from.smallest_ratio};
    losses.value = from.value;
    losses.total = from.total;
    return losses;
  }

 private:
  void check(int code) const {
    if (code != 0) fail(Exit::kInternal, "LibTorch: ", api_.last_error());
  }
  TorchBatch describe(const StepBatch<float>& batch, const StepOptions& options, std::vector<float>& keep) const {
    keep = policy_.dropout_factors(batch, options);
    return {batch.size,   batch.psi ? nullptr : batch.observations,
            batch.psi,    batch.env,
            batch.task,   batch.label,
            batch.taken,  batch.next,
            batch.reward, batch.planner_q,
            keep.data(),  batch.frozen_statistics};
  }
  static TorchStepOptions describe(const StepOptions& options) {
    return {options.weights.reward, options.weights.env, options.weights.task, options.discount};
  }
  static Losses result(const TorchLosses& from, const StepOptions& options) {
    Losses losses;
    losses.policy = from.values[0];
    losses.reward = from.values[1];
    losses.env = from.values[2];
    losses.task = from.values[3];
    losses.add_up(options.weights);
    return losses;
  }

  const TorchApi& api_;
  Policy<float>& policy_;
  int unit_;
  void* engine_ = nullptr;
  std::vector<std::pair<int, int>> pairs_;
  struct Begun {
    StepOptions options;
    float* logits = nullptr;
  };
  Begun begun_;  // the last update
  TorchArrays arrays_ = {};
  ValueFunction* value_ = nullptr;  // of PPO, where that has taken arrays
  TorchPpoArrays ppo_arrays_ = {};
  bool moved_ = false;  // since the arrays were taken or given back
};

}  // namespace

std::unique_ptr<Engine> make_torch_engine(const TorchSettings& settings, const std::string& method,
                                          const PolicyShape& shape, Policy<float>& policy) {
  return std::make_unique<TorchEngine>(settings, method, shape, policy);
}

}  // namespace synpo
