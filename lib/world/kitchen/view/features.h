// The built-in extractor of features: soft histograms of colours. A view of 32 x 32 pixels is cut into 8 rows of 4
// cells, 4 pixels high and 8 wide. In every cell the pixels are counted in 4 x 4 x 4 bins of r, g and b, each shared
// out among the eight nearest bins in proportion to how near it is. A feature is 8 sqrt(share of the cell): a small
// object in a large cell still shows. Features stand by cell, row by row, then by r, g, b.
#pragma once
#include <cstdint>

#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/view/view.h"

namespace synpo {

constexpr const char* kExtractorName = "colour-histograms-1";
constexpr int kViewFeatures = 2048;

// Of the extractor's name and numbers: features of two extractors with one hash mean the same.
uint64_t extractor_hash();

// The features [kViewFeatures] of a picture [kSmallView, kSmallView, 3].
void extract_features(const uint8_t* rgb, float* features);

// The features of a view, which stay until the thread's next call. Recent views are kept per thread; what comes out
// does not depend on that.
const float* view_features(const KitchenSolids& solids, const KitchenFrame& frame);

}  // namespace synpo
