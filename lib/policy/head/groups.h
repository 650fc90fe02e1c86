// Samples sorted by a key: those of one pair, one label or one module together.
#pragma once
#include <cstddef>
#include <vector>

namespace synpo {

struct Groups {
  std::vector<int> keys;      // that occur, ascending
  std::vector<int> begin;     // [keys + 1], of each group in `members`
  std::vector<int> members;   // samples, group by group, in their order
  std::vector<int> group_of;  // [samples]

  int count() const { return int(keys.size()); }
  int size(int group) const { return begin[group + 1] - begin[group]; }

  // key(i) of sample i is in [0, key_count).
  template <class Key>
  void sort(int samples, int key_count, Key key) {
    std::vector<int> number(size_t(key_count), 0);
    for (int i = 0; i < samples; ++i) ++number[key(i)];
    keys.clear();
    begin.assign(1, 0);
    for (int k = 0; k < key_count; ++k) {
      const int size = number[k];
      if (size == 0) continue;
      number[k] = count();
      keys.push_back(k);
      begin.push_back(begin.back() + size);
    }
    group_of.resize(samples);
    members.resize(samples);
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (int i = 0; i < samples; ++i) members[next[group_of[i] = number[key(i)]]++] = i;
  }
};

}  // namespace synpo
