// What encoders and methods are put together from.
#pragma once
#include <string>

#include "torch/network.h"

namespace synpo {

// [n, classes]: 1 where the column is the row's number, else 0.
torch::Tensor indicator(const torch::Tensor& numbers, int64_t classes);
// table[numbers]; its gradient is a product, whose sums have one order on every device.
torch::Tensor take_rows(const torch::Tensor& table, const torch::Tensor& numbers);
// x w in float32, of factors that are rounded to `type` first.
torch::Tensor product(const torch::Tensor& x, const torch::Tensor& w, torch::ScalarType type = torch::kFloat32);
// A hidden ReLU layer and a linear one, whose tensors are NAME.hidden and NAME.out.
torch::Tensor perceptron(const Views& w, const std::string& name, const torch::Tensor& x,
                         torch::ScalarType type = torch::kFloat32);
// Rows scaled to this length.
torch::Tensor of_length(const torch::Tensor& rows, double length);
// Mean cross-entropy of softmax(scores) against labels.
torch::Tensor cross_entropy(const torch::Tensor& scores, const torch::Tensor& label);

}  // namespace synpo
