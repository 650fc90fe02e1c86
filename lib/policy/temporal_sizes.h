// Sizes of the temporal network of Table 3 (temporal_net.h).
#pragma once
#include "world/world.h"

namespace synpo {

struct TemporalSizes {
  int view = kViewFeatures;  // features of a view
  int channels = 1024;       // of both convolutions
  int objects = 8;           // that the hand may hold; nothing is one of them
  int object_embedding = 32;
  int hidden = 2048;
};

}  // namespace synpo
