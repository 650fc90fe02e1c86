// The built-in extractor of features: a view of 32 x 32 pixels, cut into 8 x 8 cells of 4 x 4, and for every cell the mean over its pixels of 32 responses
// relu(w_c . rgb + b_c), rgb in [0, 1], with fixed w and b, computed in integers of 16 bits. Features stand by cell, row by row, and within it by response.
#pragma once
#include <cstddef>
#include <cstdint>

#include "world/kitchen_view.h"
#include "world/world.h"

namespace synpo {

constexpr const char* kExtractorName = "colour-cells-1";
constexpr size_t kKitchenObservation = kHistory * kViewFeatures + kHandFloats;  // floats

// Of the extractor's name and numbers: features of two extractors with one hash mean the same.
uint64_t extractor_hash();

// The features [kViewFeatures] of a picture [kSmallView, kSmallView, 3].
void extract_features(const uint8_t* rgb, float* features);

// The features of a view, which stay until the thread's next call. Recent views are kept per thread; what comes out does not depend on that.
const float* view_features(const KitchenScene& scene, const KitchenFrame& frame);

}  // namespace synpo
