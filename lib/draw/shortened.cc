#include "draw/shortened.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/text.h"

namespace synpo {

std::vector<size_t> character_starts(const std::string& text) {
  std::vector<size_t> starts;
  for (size_t i = 0; i < text.size();) {
    const auto [length, code] = character_at(text, i);
    if (i == 0 || length == 0 || columns_of(code) > 0) starts.push_back(i);
    i += std::max<size_t>(length, 1);
  }
  starts.push_back(text.size());
  return starts;
}

Ruler by_columns(std::string ellipsis) {
  return {.width_of = [](const std::string& text) { return int(columns_of(text)); }, .ellipsis = std::move(ellipsis)};
}

std::string fitted(const std::string& text, const Ruler& ruler, int width) {
  const std::vector<size_t> starts = character_starts(text);
  const size_t characters = starts.size() - 1;
  // Hardly any character is narrower than a pixel, and to measure takes thousands of bytes for each.
  const size_t most = size_t(std::max(width, 0)) + 1;
  if (characters <= most && ruler.width_of(text) <= width) return text;
  // Names that share a long beginning differ at their end, so both are kept.
  const auto shortened = [&](size_t kept) {
    const size_t tail = kept / 2, head = kept - tail;
    return text.substr(0, starts[head]) + ruler.ellipsis + text.substr(starts[characters - tail]);
  };
  size_t fits = 0, too_long = std::min(characters, most);
  while (fits + 1 < too_long) {
    const size_t middle = (fits + too_long) / 2;
    (ruler.width_of(shortened(middle)) <= width ? fits : too_long) = middle;
  }
  return shortened(fits);
}

std::vector<std::string> fitted_apart(const std::vector<std::string>& names, const Ruler& ruler, int width) {
  std::vector<std::string> out;
  std::map<std::string, std::set<std::string>> sharing;  // names by what they were shortened to
  for (const std::string& name : names) {
    out.push_back(fitted(name, ruler, width));
    sharing[out.back()].insert(name);
  }
  for (const auto& [same, group] : sharing) {
    if (group.size() < 2) continue;
    // In order, so the first and the last share least.
    const std::string &first = *group.begin(), &last = *group.rbegin();
    const size_t differ =
        size_t(std::mismatch(first.begin(), first.end(), last.begin(), last.end()).first - first.begin());
    std::map<std::string, std::string> apart;
    std::set<std::string> different;
    for (const std::string& name : group) {
      const std::vector<size_t> starts = character_starts(name);
      size_t from = size_t(std::upper_bound(starts.begin(), starts.end(), differ) - starts.begin()) - 1, to = from;
      const auto cut = [&](size_t end) {
        return ruler.ellipsis + name.substr(starts[from], starts[end] - starts[from]) +
               (end + 1 < starts.size() ? ruler.ellipsis : "");
      };
      while (to + 1 < starts.size() && to - from < size_t(std::max(width, 0)) && ruler.width_of(cut(to + 1)) <= width)
        ++to;
      apart[name] = cut(to);
      different.insert(apart[name]);
    }
    int number = 0;
    if (different.size() < group.size())
      for (auto& [name, shown] : apart) {
        const std::string mark = concat("#", ++number);
        shown = fitted(name, ruler, width - ruler.width_of(mark) - ruler.gap) + mark;
      }
    for (size_t i = 0; i < names.size(); ++i)
      if (const auto shown = apart.find(names[i]); shown != apart.end() && out[i] == same) out[i] = shown->second;
  }
  return out;
}

}  // namespace synpo
