#include "torch/parts.h"

#include <torch/csrc/autograd/custom_function.h>

#include <cmath>

namespace synpo {
namespace {

class TakeRows : public torch::autograd::Function<TakeRows> {
 public:
  static torch::Tensor forward(torch::autograd::AutogradContext* context, const torch::Tensor& table,
                               const torch::Tensor& numbers) {
    context->save_for_backward({numbers});
    context->saved_data["rows"] = table.size(0);
    return table.index_select(0, numbers);
  }
  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 const torch::autograd::variable_list& gradients) {
    const torch::Tensor numbers = context->get_saved_variables()[0];
    return {indicator(numbers, context->saved_data["rows"].toInt()).t().mm(gradients[0]), torch::Tensor()};
  }
};

}  // namespace

Views::Views(const TorchLayout& layout, const torch::Tensor& flat, bool learned) {
  for (int i = 0; i < layout.count; ++i) {
    const TorchTensor& tensor = layout.tensors[i];
    const std::vector<int64_t> shape(tensor.shape, tensor.shape + tensor.rank);
    torch::Tensor view = flat.narrow(0, int64_t(tensor.offset), int64_t(tensor.size)).view(shape).detach();
    if (learned) view.requires_grad_();
    by_name_.emplace(tensor.name, view);
    all_.push_back(view);
  }
}

torch::Tensor indicator(const torch::Tensor& numbers, int64_t classes) {
  return numbers.unsqueeze(1).eq(torch::arange(classes, numbers.options())).to(torch::kFloat32);
}

torch::Tensor take_rows(const torch::Tensor& table, const torch::Tensor& numbers) {
  return TakeRows::apply(table, numbers);
}

torch::Tensor product(const torch::Tensor& x, const torch::Tensor& w, torch::ScalarType type) {
  return x.to(type).mm(w.to(type)).to(torch::kFloat32);
}

torch::Tensor perceptron(const Views& w, const std::string& name, const torch::Tensor& x, torch::ScalarType type) {
  const torch::Tensor hidden = (product(x, w[name + ".hidden.weight"], type) + w[name + ".hidden.bias"]).relu();
  return product(hidden, w[name + ".out.weight"], type) + w[name + ".out.bias"];
}

torch::Tensor of_length(const torch::Tensor& rows, double length) {
  return rows * (length / (rows.square().sum(1, true) + 1e-12).sqrt());
}

torch::Tensor cross_entropy(const torch::Tensor& scores, const torch::Tensor& label) {
  return -(scores.log_softmax(1) * indicator(label, scores.size(1))).sum() / scores.size(0);
}

}  // namespace synpo
