#include "world/kitchen/view/features.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include "base/hash.h"
#include "world/kitchen/geometry/tables.h"

namespace synpo {
namespace {

constexpr int kCellRows = 4, kCellColumns = 8;  // pixels of a cell
constexpr int kLevels = 4;                      // of a colour's channel, at 0, 85, 170 and 255
constexpr int kLevelGap = 255 / (kLevels - 1);
constexpr int kBins = kLevels * kLevels * kLevels;
static_assert(kSmallView / kCellRows * (kSmallView / kCellColumns) * kBins == kViewFeatures);
constexpr int kPixelWeight = kLevelGap * kLevelGap * kLevelGap;  // that a pixel shares out among bins
constexpr float kLargest = 8;                                    // of a feature: so their root mean square is one

// The level at or below a value, and the weights of it and of the next one.
struct Levels {
  int lower, weight[2];
  explicit Levels(int value) : lower(std::min(value / kLevelGap, kLevels - 2)), weight{} {
    weight[1] = value - lower * kLevelGap;
    weight[0] = kLevelGap - weight[1];
  }
};

void count(const uint8_t* pixel, int32_t* bins) {
  const Levels r(pixel[0]), g(pixel[1]), b(pixel[2]);
  int32_t* at = bins + (r.lower * kLevels + g.lower) * kLevels + b.lower;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      int32_t* pair = at + (i * kLevels + j) * kLevels;
      const int weight = r.weight[i] * g.weight[j];
      pair[0] += weight * b.weight[0];
      pair[1] += weight * b.weight[1];
    }
}

constexpr size_t kKeptViews = 256;

struct KeptView {
  uint64_t kitchen;
  KitchenFrame frame;
  bool filled = false;
  float features[kViewFeatures];
};

uint64_t hash_of(uint64_t kitchen, const KitchenFrame& frame) {
  const int16_t rest[5] = {frame.eye.row, frame.eye.column, frame.eye.heading, frame.eye.horizon, frame.doors};
  return Hash()
      .add(&kitchen, sizeof kitchen)
      .add(rest, sizeof rest)
      .add(frame.objects.data(), sizeof frame.objects)
      .value();
}

}  // namespace

uint64_t extractor_hash() {
  const int32_t numbers[] = {kSmallView, kCellRows, kCellColumns, kLevels, int32_t(kLargest)};
  return Hash().add(kExtractorName).add(numbers, sizeof numbers).value();
}

void extract_features(const uint8_t* rgb, float* features) {
  constexpr float kUnit = kLargest * kLargest / (float(kPixelWeight) * kCellRows * kCellColumns);
  for (int row = 0; row < kSmallView; row += kCellRows)
    for (int column = 0; column < kSmallView; column += kCellColumns, features += kBins) {
      int32_t bins[kBins] = {};
      for (int y = row; y < row + kCellRows; ++y)
        for (int x = column; x < column + kCellColumns; ++x) count(rgb + 3 * (y * kSmallView + x), bins);
      for (int bin = 0; bin < kBins; ++bin) features[bin] = std::sqrt(float(bins[bin]) * kUnit);
    }
}

const float* view_features(const KitchenSolids& solids, const KitchenFrame& frame) {
  thread_local const std::unique_ptr<KeptView[]> kept(new KeptView[kKeptViews]);
  KeptView& view = kept[hash_of(solids.hash, frame) % kKeptViews];
  if (!view.filled || view.kitchen != solids.hash || view.frame != frame) {
    uint8_t rgb[kSmallView * kSmallView * 3];
    render_small(solids, frame, rgb);
    extract_features(rgb, view.features);
    view.kitchen = solids.hash;
    view.frame = frame;
    view.filled = true;
  }
  return view.features;
}

}  // namespace synpo
