// Which pairs of environments and tasks training sees: transfer setting 1, and the quadrants of settings 2 and 3
// (supplement 5.4).
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace synpo {

constexpr double kSeenRatio = 0.36;  // 144 of 400
constexpr int64_t kSplitCover = 4;

// -1 stands for the default.
struct SplitPlan {
  std::vector<std::string> envs, tasks;  // in the order of the matrix, none twice
  uint64_t seed = 1;
  // How many pairs are seen: 36 % rounded; in settings 2 and 3 how many of P, all of it by default.
  int64_t seen = -1;
  double ratio = 0;  // the same as a share of all pairs (of P's pairs), where not 0 and `seen` is not given
  // At least so many seen pairs for every environment and every task; by default 4, or what the count allows.
  int64_t cover = -1;
  // Each the only seen pair of its environment and of its task. One of the names may be empty: then the other's one
  // seen pair is drawn, with a partner that is none of these. An environment and a task that are given so, each alone,
  // are the case of Figure 6: env_0 is seen only with (R,B), (O,R) only with env_2, and they are not seen together.
  // Cover does not apply to those that are named here.
  std::vector<std::pair<std::string, std::string>> singles;
  // 1: no parts. In settings 2 and 3 the first p_envs environments and p_tasks tasks (half by default, rounded up) make
  // P, on which everything is trained. Setting 2: Q is the upper right and the lower left quadrant, new environments
  // with tasks of P and environments of P with new tasks. Setting 3: Q is the lower right quadrant, both new. Other
  // pairs are "rest". Seen are the drawn pairs of P and all of Q, on which the new embeddings are trained.
  int setting = 1;
  int64_t p_envs = -1, p_tasks = -1;
};

struct SplitPair {
  std::string env, task;
  bool seen;
  std::string part;  // P, Q or rest; empty in setting 1
};

// All pairs, environment by environment. The same plan gives the same split. The seen pairs are the first of one order
// that depends on names' number, seed, cover and singles only, so a smaller count gives a subset of a larger one.
// Throws kUsage when the plan cannot be met; kSinglePair with the name of a single pair, environment or task that is in
// its way.
constexpr Cause kSinglePair{"a single pair"};
std::vector<SplitPair> split_pairs(const SplitPlan& plan);

// The parts between commas; "" is one empty name.
std::vector<std::string> split_names(const std::string& list);
// "ENV,TASK". Throws std::invalid_argument for another number of names.
std::pair<std::string, std::string> split_pair_name(const std::string& text);

// How many of the names are taken, where `chosen` is a count ("5", "2e1"); none where it is names.
std::optional<int64_t> count_of_names(const std::string& chosen);
// The names that the option `option` chooses among `names`: all of them (""), the first so many ("5"), or those listed
// ("map1,map7"), in the order of the list. Throws kUsage for a name that is not among them.
std::vector<std::string> choose_names(const std::string& option, const std::string& chosen,
                                      const std::vector<std::string>& names);

}  // namespace synpo
