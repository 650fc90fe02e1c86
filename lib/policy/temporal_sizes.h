// Sizes of the temporal network of Table 3 (temporal_net.h).
#pragma once

namespace synpo {

struct TemporalSizes {
  int channels = 1024;  // of both convolutions
  int object_embedding = 32;
  int hidden = 2048;
};

}  // namespace synpo
