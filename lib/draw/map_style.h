// How plans of environments are laid out, on a picture or on a terminal.
#pragma once
#include <cstdint>
#include <string>

namespace synpo {

struct MapStyle {
  std::string title;
  double scale = 2;     // pixels per point
  int64_t columns = 0;  // plans in a row; 0: a grid a little wider than high
};

}  // namespace synpo
