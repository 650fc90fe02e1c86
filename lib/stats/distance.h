// How far rows of a table lie from one another.
#pragma once
#include <vector>

namespace synpo {

// 1 - cos of the angle between two rows, 0 to 2 (1 where a row is zero and the other is not, 0 where both are), or the
// length of their difference.
enum class Distance { kCosine, kEuclidean };

// [rows, rows] of `values` [rows, columns]: symmetric, with an exact 0 for a row and itself.
std::vector<double> distances(const std::vector<double>& values, int rows, int columns, Distance kind);

}  // namespace synpo
