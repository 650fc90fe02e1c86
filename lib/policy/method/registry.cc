#include "policy/method/registry.h"

#include <algorithm>
#include <ranges>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "nn/layers/perceptron.h"
#include "policy/head/embedding_table.h"
#include "policy/method/mlp.h"
#include "policy/method/modulenet.h"
#include "policy/method/mtl.h"
#include "policy/method/sf.h"
#include "policy/method/synpo.h"

namespace synpo {
namespace {

template <class Made, class Base>
std::unique_ptr<Base> make(const PolicyShape& shape) {
  return std::make_unique<Made>(shape);
}

template <template <class> class Kind>
Method method(const std::string& name, std::vector<std::string> options, std::vector<MethodDefault> defaults,
              std::vector<MethodDefault> fast) {
  return {name,
          make<Kind<float>, Policy<float>>,
          make<Kind<double>, Policy<double>>,
          std::move(options),
          std::move(defaults),
          std::move(fast)};
}

}  // namespace

const std::vector<Method>& methods() {
  // `fast` is what scripts/reproduce grid has chosen, but for MTL's embeddings (lab/book.md).
  static const std::vector<Method> all = {
      method<SynPo>("synpo", {"action-embedding"}, {}, {}),
      method<Mlp>("mlp", {"head-hidden"}, {{"feature", 256}}, {{"embedding-sd", 0.3}, {"weight-decay", 1e-5}}),
      method<Mtl>("mtl", {"action-embedding"}, {}, {}),
      method<ModuleNet>("modulenet", {"head-hidden", "seam", "dropout"}, {{"head-hidden", 128}},
                        {{"dropout", 0}, {"weight-decay", 0}}),
      method<Sf>("sf", {"head-hidden", "sf-loss", "discount"}, {{"head-hidden", 512}, {"reward-loss", 1}},
                 {{"sf-loss", double(SfLoss::kCrossEntropy)},
                  {"embedding-sd", 0.1},
                  {"reward-loss", 0.01},
                  {"weight-decay", 1e-4}}),
  };
  return all;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.push_back(method.name);
  return names;
}

const Method& find_method(const std::string& name) {
  const auto found = std::ranges::find(methods(), name, &Method::name);
  if (found == methods().end())
    fail(Exit::kData, "unknown method ", quoted(name), ", expected ", alternatives(method_names()));
  return *found;
}

template <class T>
std::unique_ptr<Policy<T>> make_policy(const std::string& method, const PolicyShape& shape) {
  if constexpr (std::is_same_v<T, float>)
    return find_method(method).make(shape);
  else
    return find_method(method).make_double(shape);
}
template std::unique_ptr<Policy<float>> make_policy(const std::string&, const PolicyShape&);
template std::unique_ptr<Policy<double>> make_policy(const std::string&, const PolicyShape&);

}  // namespace synpo
