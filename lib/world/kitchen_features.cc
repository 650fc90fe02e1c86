#include "world/kitchen_features.h"

#include <algorithm>
#include <memory>

#include "base/hash.h"
#include "base/random.h"

namespace synpo {
namespace {

constexpr int kResponses = 32;
constexpr int kCellPixels = 4;
constexpr int kCells = kSmallView / kCellPixels;
static_assert(kCells * kCells * kResponses == kViewFeatures);
constexpr uint64_t kSeed = 2018;
// Sixteen bits hold every response and every sum: 3 * 255 * kLargestWeight and, of sixteen responses each divided by sixteen, the same.
constexpr int kLargestWeight = 42;
constexpr int kShift = 4;
constexpr float kScale = 3.0f / (255 * kLargestWeight);  // brings the largest features to a few units

struct Responses {
  std::array<int16_t, kResponses> r, g, b, bias;
};

// Planes through random points of the colour cube, in random directions.
const Responses& responses() {
  static const Responses fixed = [] {
    Responses all;
    Random random(kSeed, Purpose::kInit, 2);
    for (size_t c = 0; c < kResponses; ++c) {
      int at_point = 0;
      for (auto* weights : {&all.r, &all.g, &all.b}) {
        const int weight = int(random.below(2 * kLargestWeight + 1)) - kLargestWeight;
        (*weights)[c] = int16_t(weight);
        at_point += weight * int(random.below(256));
      }
      all.bias[c] = int16_t(-at_point);
    }
    return all;
  }();
  return fixed;
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
  return Hash().add(&kitchen, sizeof kitchen).add(rest, sizeof rest).add(frame.objects.data(), sizeof frame.objects).value();
}

}  // namespace

uint64_t extractor_hash() { return Hash().add(kExtractorName).add(&responses(), sizeof(Responses)).value(); }

void extract_features(const uint8_t* rgb, float* features) {
  const Responses fixed = responses();
  for (int row = 0; row < kSmallView; row += kCellPixels)
    for (int column = 0; column < kSmallView; column += kCellPixels, features += kResponses) {
      std::array<int16_t, kResponses> sums = {};
      for (int y = row; y < row + kCellPixels; ++y)
        for (int x = column; x < column + kCellPixels; ++x) {
          const uint8_t* pixel = rgb + 3 * (y * kSmallView + x);
          const int16_t r = pixel[0], g = pixel[1], b = pixel[2];
          for (size_t c = 0; c < kResponses; ++c) {
            const int16_t response = int16_t(r * fixed.r[c] + g * fixed.g[c] + b * fixed.b[c] + fixed.bias[c]);
            sums[c] = int16_t(sums[c] + (std::max<int16_t>(response, 0) >> kShift));
          }
        }
      for (size_t c = 0; c < kResponses; ++c) features[c] = float(sums[c]) * kScale;
    }
}

const float* view_features(const KitchenScene& scene, const KitchenFrame& frame) {
  thread_local const std::unique_ptr<KeptView[]> kept(new KeptView[kKeptViews]);
  KeptView& view = kept[hash_of(scene.hash, frame) % kKeptViews];
  if (!view.filled || view.kitchen != scene.hash || view.frame != frame) {
    uint8_t rgb[kSmallView * kSmallView * 3];
    render_small(scene, frame, rgb);
    extract_features(rgb, view.features);
    view.kitchen = scene.hash;
    view.frame = frame;
    view.filled = true;
  }
  return view.features;
}

}  // namespace synpo
