// The built-in extractor of features, "colour-cells-1": a view of 32 x 32 pixels, cut into 8 x 8 cells of 4 x 4, and for every cell the mean over its
// pixels of 32 responses relu(w_c . rgb + b_c) with fixed w and b, rgb in [0, 1]. Features stand by cell, row by row, then by response.
#pragma once
#include <cstdint>
#include <string>

#include "world/kitchen_view.h"
#include "world/world.h"

namespace synpo {

constexpr size_t kKitchenObservation = kHistory * kViewFeatures + kHandFloats;  // floats

// The features of a view, which stay until the thread's next call. Recent views are kept per thread; what comes out does not depend on that.
const float* view_features(const KitchenScene& scene, const KitchenFrame& frame);

}  // namespace synpo
