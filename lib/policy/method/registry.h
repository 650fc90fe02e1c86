// The methods: what makes each, what can be chosen of it, and what it is trained with where nothing else is said. A new
// method is one header, one source and one row of methods().
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

// A hyper-parameter by the name of its option.
struct MethodDefault {
  std::string option;
  double value;
};

struct Method {
  std::string name;
  std::unique_ptr<Policy<float>> (*make)(const PolicyShape& shape);
  std::unique_ptr<Policy<double>> (*make_double)(const PolicyShape& shape);
  std::vector<std::string> options;     // that not every method has
  std::vector<MethodDefault> defaults;  // in every recipe: what the method is
  std::vector<MethodDefault> fast;      // in the recipe "fast"
};

const std::vector<Method>& methods();
std::vector<std::string> method_names();
// Throws kData for a name that is not there.
const Method& find_method(const std::string& name);

// There is one for float and one for double. Throws kData as find_method().
template <class T = float>
std::unique_ptr<Policy<T>> make_policy(const std::string& method, const PolicyShape& shape);

}  // namespace synpo
