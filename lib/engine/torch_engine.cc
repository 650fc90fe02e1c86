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
  static TorchLayout describe(const Layout& layout, std::vector<TorchTensor>& tensors) {
    for (const TensorInfo& tensor : layout.tensors())
      tensors.push_back(
          {tensor.name.c_str(), tensor.shape.data(), int(tensor.shape.size()), tensor.offset, tensor.size});
    return {tensors.data(), int(tensors.size()), layout.total()};
  }
  std::vector<uint8_t> palette_;
  std::vector<TorchTensor> parameters_, statistics_;
};

double apply_objective(void* context, int n, const float* psi, const float* logits, float* dlogits, float* dpsi) {
  const auto& [parallel, objective] = *static_cast<std::pair<Parallel*, Objective<float>*>*>(context);
  return objective->apply(*parallel, n, psi, logits, dlogits, dpsi);
}

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

  Losses step(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options, const float* parameters,
              float* statistics, float* gradient, float* logits) override {
    std::vector<float> keep;
    const TorchBatch given = describe(batch, options, keep);
    const TorchStepOptions torch_options = describe(options);
    std::pair<Parallel*, Objective<float>*> context = {&parallel, batch.objective};
    const TorchObjective objective = {apply_objective, &context};
    TorchLosses losses;
    check(api_.step(engine_, &given, &torch_options, batch.objective ? &objective : nullptr, parameters, statistics,
                    gradient, logits, &losses));
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
  Losses update(Parallel&, const StepBatch<float>& batch, const StepOptions& options, const AdamUpdate& adam,
                float* logits) override {
    std::vector<float> keep;
    const TorchBatch given = describe(batch, options, keep);
    const TorchStepOptions torch_options = describe(options);
    const AdamOptions& a = adam.options;
    const TorchAdam torch_adam = {a.learning_rate, a.beta1, a.beta2, a.epsilon, a.weight_decay, adam.step, adam.keep};
    TorchLosses losses;
    check(api_.update(engine_, &given, &torch_options, &torch_adam, logits, &losses));
    moved_ = true;
    return result(losses, options);
  }
  void give_back() override {
    if (!moved_) return;
    check(api_.give_back(engine_, &arrays_));
    moved_ = false;
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
  TorchArrays arrays_ = {};
  bool moved_ = false;  // since the arrays were taken or given back
};

}  // namespace

std::unique_ptr<Engine> make_torch_engine(const TorchSettings& settings, const std::string& method,
                                          const PolicyShape& shape, Policy<float>& policy) {
  return std::make_unique<TorchEngine>(settings, method, shape, policy);
}

}  // namespace synpo
