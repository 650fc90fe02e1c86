// The text files of lib/world/grid/maps, turned into data by the Makefile.
#pragma once
#include <vector>

namespace synpo {

struct BuiltinMap {
  const char* name;
  const char* text;
};
extern const std::vector<BuiltinMap> kBuiltinMaps;

}  // namespace synpo
