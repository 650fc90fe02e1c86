#include <stdexcept>

#include "torch/network.h"
#include "torch/parts.h"

namespace synpo {
namespace {

class EmbeddedHead : public Head {
 public:
  explicit EmbeddedHead(const NetworkSizes& sizes) : sizes_(sizes) {}

 protected:
  torch::Tensor table(const Views& w, const std::string& side) const {
    const torch::Tensor& rows = w["embedding." + side];
    return sizes_.normalise_embeddings ? of_length(rows, std::sqrt(double(sizes_.embedding))) : rows;
  }
  // The loss of recognising an environment or a task: softmax of f(x) with the embeddings.
  torch::Tensor recognise(const Views& w, const std::string& side, const torch::Tensor& x,
                          const torch::Tensor& truth) const {
    return cross_entropy(product(perceptron(w, "f_" + side, x), table(w, side).t()), truth);
  }
  // Of values [n, actions], each state's at its action.
  torch::Tensor at(const torch::Tensor& values, const torch::Tensor& action) const {
    return (values * indicator(action, sizes_.actions)).sum(1);
  }
  torch::Tensor score_loss(const torch::Tensor& logits, const Inputs& in, bool imitates) const {
    return imitates ? cross_entropy(logits, in.label) : torch::Tensor();
  }

  const NetworkSizes& sizes_;
};

// Of each state's rows [n, rows, width] with its vector [n, width], the same whatever stands beside a state.
torch::Tensor dots(const torch::Tensor& rows, const torch::Tensor& vectors) {
  return rows.bmm(vectors.unsqueeze(2)).squeeze(2);
}

torch::Tensor mean_square(const torch::Tensor& error) { return error.square().sum() / error.size(0); }

// policy/method/synpo.h; MTL is the same without the environment.
class SynPoHead : public EmbeddedHead {
 public:
  SynPoHead(const NetworkSizes& sizes, bool with_env) : EmbeddedHead(sizes), with_env_(with_env) {}

  torch::Tensor scores(const Views& w, const torch::Tensor& psi, const Inputs& in) const override {
    return logits(w, dots(by_basis(w, psi), coefficients(w, "alpha", in)));
  }

  Outputs learn(const Views& w, const torch::Tensor& psi, const Inputs& in, double, bool imitates) const override {
    const torch::Tensor parts = by_basis(w, psi);
    Outputs out;
    out.logits = logits(w, weigh(parts, coefficients(w, "alpha", in)));
    out.losses[kPolicyLoss] = score_loss(out.logits, in, imitates);
    const torch::Tensor taken = indicator(in.taken, sizes_.actions);
    const torch::Tensor reward =
        (weigh(parts, coefficients(w, "beta", in)) * columns(w, taken)).sum(1) + (taken * w["reward.bias"]).sum(1);
    out.losses[kRewardLoss] = mean_square(reward - in.reward);
    // x(s, a) at the expert's action.
    const torch::Tensor x = (parts * columns(w, indicator(in.label, sizes_.actions)).unsqueeze(2)).sum(1);
    if (with_env_) out.losses[kEnvLoss] = recognise(w, "env", x, in.env);
    out.losses[kTaskLoss] = recognise(w, "task", x, in.task);
    return out;
  }

  bool has_loss(LossKind kind) const override { return kind != kEnvLoss || with_env_; }

 private:
  // psi(s)^T Theta_k, [n, columns, K].
  torch::Tensor by_basis(const Views& w, const torch::Tensor& psi) const {
    const torch::Tensor& theta = w["theta"];  // [columns, feature, K]
    return product(psi, theta.permute({1, 0, 2}).flatten(1)).view({psi.size(0), theta.size(0), theta.size(2)});
  }
  // What each column counts for an action given one-hot: itself, or phi(a).
  torch::Tensor columns(const Views& w, const torch::Tensor& action) const {
    return sizes_.action_embedding > 0 ? product(action, w["phi"]) : action;
  }
  static torch::Tensor weigh(const torch::Tensor& parts, const torch::Tensor& coefficients) {
    return (parts * coefficients.unsqueeze(1)).sum(2);
  }
  torch::Tensor logits(const Views& w, const torch::Tensor& q) const {
    return (sizes_.action_embedding > 0 ? product(q, w["phi"].t()) : q) + w["policy.bias"];
  }
  // alpha or beta of every state's pair, [n, K]: made once for all pairs where those are fewer.
  torch::Tensor coefficients(const Views& w, const std::string& name, const Inputs& in) const {
    const int64_t envs = with_env_ ? sizes_.envs : 1, tasks = sizes_.tasks;
    const torch::Tensor task = table(w, "task");
    if (envs * tasks > in.task.size(0)) {
      torch::Tensor z = take_rows(task, in.task);
      if (with_env_) z = torch::cat({take_rows(table(w, "env"), in.env), z}, 1);
      return perceptron(w, name, z);
    }
    torch::Tensor z = task;
    if (with_env_)
      z = torch::cat({table(w, "env").unsqueeze(1).expand({envs, tasks, -1}), task.unsqueeze(0).expand({envs, -1, -1})},
                     2)
              .flatten(0, 1);
    return take_rows(perceptron(w, name, z), with_env_ ? in.env * tasks + in.task : in.task);
  }

  bool with_env_;
};

// policy/method/mlp.h.
class MlpHead : public EmbeddedHead {
 public:
  using EmbeddedHead::EmbeddedHead;

  torch::Tensor scores(const Views& w, const torch::Tensor& psi, const Inputs& in) const override {
    return perceptron(w, "policy", input(w, of_length(psi, 1), in));
  }

  Outputs learn(const Views& w, const torch::Tensor& psi, const Inputs& in, double, bool imitates) const override {
    const torch::Tensor unit = of_length(psi, 1), x = input(w, unit, in);
    Outputs out;
    out.logits = perceptron(w, "policy", x);
    out.losses[kPolicyLoss] = score_loss(out.logits, in, imitates);
    out.losses[kRewardLoss] = mean_square(at(perceptron(w, "reward", x), in.taken) - in.reward);
    out.losses[kEnvLoss] = recognise(w, "env", unit, in.env);
    out.losses[kTaskLoss] = recognise(w, "task", unit, in.task);
    return out;
  }

  bool has_loss(LossKind) const override { return true; }

 private:
  torch::Tensor input(const Views& w, const torch::Tensor& unit, const Inputs& in) const {
    return torch::cat({unit, take_rows(table(w, "env"), in.env), take_rows(table(w, "task"), in.task)}, 1);
  }
};

// policy/method/modulenet.h. Every state passes through all modules, of which its own one is kept.
class ModuleNetHead : public Head {
 public:
  explicit ModuleNetHead(const NetworkSizes& sizes) : sizes_(sizes) {}

  torch::Tensor scores(const Views& w, const torch::Tensor& psi, const Inputs& in) const override {
    return through(w, "env", sizes_.envs, through(w, "task", sizes_.tasks, psi, in.task), in.env);
  }

  Outputs learn(const Views& w, const torch::Tensor& psi, const Inputs& in, double, bool imitates) const override {
    Outputs out;
    const torch::Tensor seam = through(w, "task", sizes_.tasks, psi, in.task) * in.keep;
    out.logits = through(w, "env", sizes_.envs, seam, in.env);
    if (imitates) out.losses[kPolicyLoss] = cross_entropy(out.logits, in.label);
    return out;
  }

  bool has_loss(LossKind kind) const override { return kind == kPolicyLoss; }

 private:
  static torch::Tensor stacked(const Views& w, const std::string& side, int count, const char* part) {
    std::vector<torch::Tensor> each;
    for (int i = 0; i < count; ++i) each.push_back(w["module." + side + std::to_string(i) + part]);
    return torch::stack(each);
  }
  static torch::Tensor through(const Views& w, const std::string& side, int count, const torch::Tensor& x,
                               const torch::Tensor& own) {
    const torch::Tensor hidden =
        torch::baddbmm(stacked(w, side, count, ".hidden.bias").unsqueeze(1), x.unsqueeze(0).expand({count, -1, -1}),
                       stacked(w, side, count, ".hidden.weight"))
            .relu();
    const torch::Tensor out = torch::baddbmm(stacked(w, side, count, ".out.bias").unsqueeze(1), hidden,
                                             stacked(w, side, count, ".out.weight"));
    return (out * indicator(own, count).t().unsqueeze(2)).sum(0);
  }

  const NetworkSizes& sizes_;
};

// policy/method/sf.h.
class SfHead : public EmbeddedHead {
 public:
  using EmbeddedHead::EmbeddedHead;

  torch::Tensor scores(const Views& w, const torch::Tensor& psi, const Inputs& in) const override {
    return dots(successor(w, psi, in), take_rows(table(w, "task"), in.task));
  }

  Outputs learn(const Views& w, const torch::Tensor& psi, const Inputs& in, double discount,
                bool imitates) const override {
    const torch::Tensor sigma = successor(w, psi, in), phi = by_action(perceptron(w, "phi", psi)),
                        task = take_rows(table(w, "task"), in.task);
    Outputs out;
    out.logits = values(sigma, task);
    if (imitates && sizes_.sf_loss == 0)
      out.losses[kPolicyLoss] = temporal_difference(sigma, phi, in, discount);
    else if (imitates && sizes_.sf_loss == 1)
      out.losses[kPolicyLoss] = (out.logits - in.planner_q).square().mean();
    else
      out.losses[kPolicyLoss] = score_loss(out.logits, in, imitates);
    out.losses[kRewardLoss] = mean_square((at_action(phi, in.taken) * task).sum(1) - in.reward);
    return out;
  }

  bool has_loss(LossKind kind) const override { return kind == kPolicyLoss || kind == kRewardLoss; }

 private:
  torch::Tensor by_action(const torch::Tensor& features) const {
    return features.view({features.size(0), sizes_.actions, sizes_.embedding});
  }
  torch::Tensor successor(const Views& w, const torch::Tensor& psi, const Inputs& in) const {
    const torch::Tensor x =
        torch::cat({psi, take_rows(table(w, "env"), in.env), take_rows(table(w, "task"), in.task)}, 1);
    return by_action(perceptron(w, "psi", x));
  }
  static torch::Tensor values(const torch::Tensor& features, const torch::Tensor& task) {
    return (features * task.unsqueeze(1)).sum(2);
  }
  torch::Tensor at_action(const torch::Tensor& features, const torch::Tensor& action) const {
    return (features * indicator(action, sizes_.actions).unsqueeze(2)).sum(1);
  }
  // Mean square over the steps whose next one is known. Targets are held fixed.
  torch::Tensor temporal_difference(const torch::Tensor& sigma, const torch::Tensor& phi, const Inputs& in,
                                    double discount) const {
    const torch::Tensor known = in.next.ne(kUnknown).to(torch::kFloat32), goes_on = in.next.ge(0).to(torch::kFloat32);
    const torch::Tensor after = at_action(sigma.detach(), in.label).index_select(0, in.next.clamp_min(0));
    const torch::Tensor target = at_action(phi.detach(), in.taken) + after * (goes_on * discount).unsqueeze(1);
    const torch::Tensor squares = (at_action(sigma, in.taken) - target).square().sum(1);
    return (squares * known).sum() / (known.sum().clamp_min(1) * sizes_.embedding);
  }
  static constexpr int kUnknown = -2;  // StepBatch::kUnknown
};

}  // namespace

std::unique_ptr<Head> make_head(const NetworkSizes& sizes) {
  if (sizes.method == "synpo") return std::make_unique<SynPoHead>(sizes, true);
  if (sizes.method == "mtl") return std::make_unique<SynPoHead>(sizes, false);
  if (sizes.method == "mlp") return std::make_unique<MlpHead>(sizes);
  if (sizes.method == "modulenet") return std::make_unique<ModuleNetHead>(sizes);
  if (sizes.method == "sf") return std::make_unique<SfHead>(sizes);
  throw std::invalid_argument("LibTorch's engine has no method '" + sizes.method + "'");
}

}  // namespace synpo
