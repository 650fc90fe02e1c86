#include "stats/matrix/merge.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"

namespace synpo {
namespace {

// A row, and where it was read.
struct Placed {
  MatrixRow row;
  size_t source, line;
};

class Merger {
 public:
  explicit Merger(std::vector<MatrixSource>& sources) : sources_(sources) {
    for (size_t s = 0; s < sources_.size(); ++s) {
      const std::vector<size_t> column = unite_columns(sources_[s].matrix);
      for (size_t i = 0; i < sources_[s].matrix.rows.size(); ++i) {
        Placed placed{std::move(sources_[s].matrix.rows[i]), s, i + 2};
        std::vector<std::string> extra = std::move(placed.row.extra);
        placed.row.extra.assign(extra_.size(), "");
        for (size_t k = 0; k < extra.size(); ++k) placed.row.extra[column[k]] = std::move(extra[k]);
        add(std::move(placed));
      }
      has_part_ |= sources_[s].matrix.has_part;
    }
  }

  Matrix result() {
    Matrix matrix;
    matrix.has_part = has_part_;
    matrix.extra_columns = extra_;
    for (std::vector<Placed>& pair : pairs_) {
      complete(pair);
      std::stable_sort(pair.begin(), pair.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.row.eval_seed, a.row.first_episode) < std::tie(b.row.eval_seed, b.row.first_episode);
      });
      for (size_t i = 0; i < pair.size(); ++i) {
        MatrixRow& row = pair[i].row;
        row.extra.resize(extra_.size());
        if (i > 0) check_disjoint(pair[i - 1], pair[i]);
        if (i > 0 && follows(matrix.rows.back(), row))
          add_counts(matrix.rows.back(), row);
        else
          matrix.rows.push_back(row);
      }
    }
    return matrix;
  }

 private:
  // Where each unknown column of `matrix` stands among those of the result.
  std::vector<size_t> unite_columns(const Matrix& matrix) {
    std::vector<size_t> column;
    for (const std::string& name : matrix.extra_columns) {
      const auto it = std::find(extra_.begin(), extra_.end(), name);
      column.push_back(size_t(it - extra_.begin()));
      if (it == extra_.end()) extra_.push_back(name);
    }
    return column;
  }

  void add(Placed placed) {
    const std::string training = training_key(placed.row), pair = '\t' + placed.row.env + '\t' + placed.row.task;
    check_training(first_of_training_.try_emplace(training, placed).first->second, placed);
    if (!placed.row.env_hash.empty()) {
      const Placed& other = first_of_env_.try_emplace(training + '\t' + placed.row.env, placed).first->second;
      same(other, placed, "env_hash", other.row.env_hash, placed.row.env_hash);
    }
    if (placed.row.is_new) new_.insert(training + pair);
    const size_t at = pair_of_run_.try_emplace(run_key(placed.row) + pair, pairs_.size()).first->second;
    if (at == pairs_.size()) pairs_.emplace_back();
    const auto [first, fresh] = pair_of_training_.try_emplace(training + pair, at);
    if (!fresh) check_pair(pairs_[first->second].front(), placed);
    pairs_[at].push_back(std::move(placed));
  }

  // Copies what some sources say of the environment and of the pair into the rows of those that do not.
  void complete(std::vector<Placed>& pair) const {
    const MatrixRow& one = pair.front().row;
    const std::string training = training_key(one), env = training + '\t' + one.env;
    const auto hash = first_of_env_.find(env);
    const bool is_new = new_.contains(env + '\t' + one.task);
    for (Placed& placed : pair) {
      if (hash != first_of_env_.end()) placed.row.env_hash = hash->second.row.env_hash;
      placed.row.is_new = is_new;
    }
  }

  std::string place(const Placed& placed) const { return concat(sources_[placed.source].name, " line ", placed.line); }

  template <class Value>
  void same(const Placed& a, const Placed& b, const char* what, const Value& in_a, const Value& in_b) const {
    if (in_a == in_b) return;
    fail(Exit::kData, place(b), ": found ", what, " ", quoted(concat(in_b)), ", expected ", quoted(concat(in_a)),
         " as in ", place(a), ", a row of the same run");
  }

  void check_training(const Placed& a, const Placed& b) const {
    same(a, b, "world", a.row.world, b.row.world);
    same(a, b, "window", a.row.window, b.row.window);
    same(a, b, "method", a.row.method, b.row.method);
    same(a, b, "seed", a.row.seed, b.row.seed);
    same(a, b, "updates", a.row.updates, b.row.updates);
  }

  void check_pair(const Placed& a, const Placed& b) const {
    same(a, b, "seen", a.row.seen, b.row.seen);
    same(a, b, "part", a.row.part, b.row.part);
  }

  void check_disjoint(const Placed& a, const Placed& b) const {
    if (a.row.eval_seed != b.row.eval_seed || b.row.first_episode >= a.row.first_episode + a.row.episodes) return;
    const auto episodes = [](const MatrixRow& row) {
      return concat("episodes ", row.first_episode, " to ", row.first_episode + row.episodes - 1);
    };
    fail(Exit::kData, place(a), " and ", place(b), " count episodes twice: ", episodes(a.row), " and ", episodes(b.row),
         " of pair ", quoted(a.row.env), ", ", quoted(a.row.task), ", eval_seed ", a.row.eval_seed,
         a.row.run.empty() ? " (no run is named: give different runs a column run or seed)" : ", of the same run");
  }

  // Whether the failures that one counts would seem to be those of the other, too.
  static bool hides_failures(const MatrixRow& one, const MatrixRow& other) {
    return one.wrong + one.timeouts > 0 && !other.knows_failures();
  }

  // Whether the sums can be read again.
  static bool fits(const MatrixRow& one, const MatrixRow& other) {
    return one.episodes + other.episodes <= kMatrixCount && one.length + other.length <= kMatrixCount &&
           !(std::abs(one.reward + other.reward) > kMatrixReward);
  }

  static bool follows(const MatrixRow& before, const MatrixRow& row) {
    return fits(before, row) && before.eval_seed == row.eval_seed &&
           before.first_episode + before.episodes == row.first_episode && before.extra == row.extra &&
           before.knows_length() == row.knows_length() && before.knows_reward() == row.knows_reward() &&
           !hides_failures(before, row) && !hides_failures(row, before);
  }

  std::vector<MatrixSource>& sources_;
  std::vector<std::string> extra_;
  bool has_part_ = false;
  std::unordered_map<std::string, Placed> first_of_training_, first_of_env_;
  std::unordered_set<std::string> new_;  // pairs that are new to a training, as some source says
  std::unordered_map<std::string, size_t> pair_of_run_, pair_of_training_;  // places in pairs_; the first of a training
  std::vector<std::vector<Placed>> pairs_;                                  // a run's pair each
};

}  // namespace

Matrix read_matrices(std::vector<std::string> files, bool or_pairs) {
  if (files.empty()) files = {"-"};
  std::vector<MatrixSource> sources;
  for (const std::string& file : files) {
    Input input(file);
    sources.push_back({input.name(), read_matrix(input, or_pairs)});
    if (files.size() > 1 && sources.back().matrix.rows[0].episodes == 0)
      fail(Exit::kData, input.name(), ": found pairs without episodes, expected a success matrix beside the others");
  }
  return merge_matrices(std::move(sources));
}

double add_rewards(double a, double b) {
  constexpr double kExact = 1e13;  // hundredths of larger sums need not be whole numbers of 53 bits
  if (std::abs(a) < kExact && std::abs(b) < kExact) {
    const double in_a = std::round(a * 100), in_b = std::round(b * 100);
    if (in_a / 100 == a && in_b / 100 == b) return (in_a + in_b) / 100;
  }
  return a + b;
}

Matrix merge_matrices(std::vector<MatrixSource> sources) { return Merger(sources).result(); }

}  // namespace synpo
