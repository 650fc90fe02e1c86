// PNG files.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

namespace synpo {

// 8 bits each of red, green and blue. `row` fills in the 3 * width bytes of a row; rows are asked for from the top.
// `scale`, pixels per point, tells how large the picture is on paper (the chunk pHYs).
std::string png_of(int width, int height, double scale, const std::function<void(int y, uint8_t* rgb)>& row);

}  // namespace synpo
