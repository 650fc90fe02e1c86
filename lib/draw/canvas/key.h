// The key of a picture: signs and their names in rows.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"

namespace synpo {

// Draws itself in a square box.
using Sign = std::function<void(Canvas&, const Box&)>;

// A square of this colour with a hairline around it.
Sign colour_sign(Rgb colour);

struct KeyEntry {
  std::vector<Sign> signs;
  std::string name;
};

class Key {
 public:
  // Rows are at most `width` pixels wide where an entry is not wider alone. `scale` is in pixels per point.
  Key(std::vector<KeyEntry> entries, int width, double scale, const Font& font);
  int height() const { return height_; }
  void draw(Canvas& canvas, int x, int y) const;

 private:
  struct Place {
    int x, y;
  };
  std::vector<KeyEntry> entries_;
  std::vector<Place> places_;
  int sign_, space_, before_name_, text_, height_;
};

}  // namespace synpo
