#include "policy/policy.h"

#include <algorithm>

namespace synpo {

template <class T>
const TensorInfo* Policy<T>::embeddings(PairSide side) const {
  return parameters_.find(side == PairSide::kEnv ? "embedding.env" : "embedding.task");
}

template <class T>
std::vector<const TensorInfo*> Policy<T>::group(ParameterGroup group) const {
  std::vector<OwnGroup> groups = own_groups();
  groups.push_back({ParameterGroup::kEncoder, {"encoder."}});
  groups.push_back({ParameterGroup::kEmbeddings, {"embedding."}});
  std::vector<const TensorInfo*> tensors;
  for (const TensorInfo& tensor : parameters_.tensors())
    for (const OwnGroup& own : groups)
      if (own.group == group && std::ranges::any_of(own.beginnings, [&](const std::string& beginning) {
            return tensor.name.starts_with(beginning);
          }))
        tensors.push_back(&tensor);
  return tensors;
}

template <class T>
std::unique_ptr<EmbeddingLoss> Policy<T>::embedding_loss(const T*, const std::vector<bool>&, const std::vector<bool>&,
                                                         bool) const {
  return nullptr;
}

template class Policy<float>;
template class Policy<double>;

}  // namespace synpo
