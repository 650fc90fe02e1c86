// The font of all pictures of a run of the tests: each canvas refers to it.
#pragma once
#include "draw/canvas/font.h"

namespace synpo {

inline const Font& font() {
  static const Font shared;
  return shared;
}

}  // namespace synpo
