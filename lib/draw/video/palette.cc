#include "draw/video/palette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace synpo {
namespace {

struct Shade {
  std::array<int, 3> channel;
  int64_t count;
};
using Shades = std::vector<Shade>;

Rgb colour_of(const Shade& shade) {
  return {uint8_t(shade.channel[0]), uint8_t(shade.channel[1]), uint8_t(shade.channel[2])};
}

// Some of the shades, that one colour may stand for.
struct Cluster {
  Shades::iterator begin, end;
  double spread = 0;  // sum of the squared distances to the mean, along the channel where it is largest
  size_t widest = 0;  // that channel
  double mean = 0;    // there

  Cluster(Shades::iterator from, Shades::iterator to) : begin(from), end(to) {
    for (size_t channel = 0; channel < 3; ++channel) {
      double count = 0, sum = 0, squares = 0;
      for (auto shade = begin; shade != end; ++shade) {
        count += double(shade->count);
        sum += double(shade->count) * shade->channel[channel];
      }
      for (auto shade = begin; shade != end; ++shade) {
        const double distance = shade->channel[channel] - sum / count;
        squares += double(shade->count) * distance * distance;
      }
      if (squares <= spread) continue;
      spread = squares;
      widest = channel;
      mean = sum / count;
    }
  }

  // The shade of most of its pixels, or their mean where there is none.
  Rgb colour() const {
    const auto most = std::max_element(begin, end, [](const Shade& a, const Shade& b) { return a.count < b.count; });
    double count = 0;
    std::array<double, 3> sum{};
    for (auto shade = begin; shade != end; ++shade) {
      count += double(shade->count);
      for (size_t channel = 0; channel < 3; ++channel) sum[channel] += double(shade->count) * shade->channel[channel];
    }
    if (2 * double(most->count) > count) return colour_of(*most);
    const auto rounded = [&](size_t channel) { return int(std::lround(sum[channel] / count)); };
    return colour_of({{rounded(0), rounded(1), rounded(2)}, 0});
  }
};

}  // namespace

// The cluster that is spread most is cut at its mean until there are enough.
void Palette::choose(size_t most) {
  Shades shades;
  for (const auto& [key, entry] : entries_)
    shades.push_back({{int(key >> 16), int(key >> 8 & 255), int(key & 255)}, entry.count});
  std::sort(shades.begin(), shades.end(), [](const Shade& a, const Shade& b) { return a.channel < b.channel; });
  std::vector<Cluster> clusters;
  if (!shades.empty()) clusters.emplace_back(shades.begin(), shades.end());
  const auto less = [](const Cluster& a, const Cluster& b) { return a.spread < b.spread; };
  while (!clusters.empty() && clusters.size() < most) {
    const auto widest = std::max_element(clusters.begin(), clusters.end(), less);
    if (widest->spread == 0) break;
    const Cluster cluster = *widest;
    const auto cut = std::stable_partition(
        cluster.begin, cluster.end, [&](const Shade& shade) { return shade.channel[cluster.widest] <= cluster.mean; });
    *widest = Cluster(cluster.begin, cut);
    clusters.emplace_back(cut, cluster.end);
  }
  colours_.clear();
  for (const Cluster& cluster : clusters) {
    for (auto shade = cluster.begin; shade != cluster.end; ++shade)
      entries_[key(colour_of(*shade))].index = int(colours_.size());
    colours_.push_back(cluster.colour());
  }
}

}  // namespace synpo
