// False alarms: differences that chance alone makes.
#pragma once
#include <cstdint>

namespace synpo {

// How often Newcombe's 95 % interval leaves out 0 where n1 and n2 trials all succeed at the same `rate`: 1 in 20 where
// there are many successes and failures, hardly ever where there are few. To within 0.001. n1, n2 > 0.
double newcombe_false_alarms(double rate, int64_t n1, int64_t n2);

}  // namespace synpo
