// JSON from outside, whose faults are named as every reader here names them.
#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace synpo {

struct JsonLimits {
  int depth = 8;                    // of nesting
  size_t values = size_t(1) << 22;  // numbers, words and names in all: what a hostile text may take of memory
};

// Throws kData for what is no JSON (with the parser's reason and the byte, counted from 1), for an object in which a
// name stands twice, and beyond the limits.
nlohmann::json parse_json(std::string_view text, const JsonLimits& limits = {});

}  // namespace synpo
