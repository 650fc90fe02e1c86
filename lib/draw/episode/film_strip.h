// The pictures of some steps of an episode in rows, each in a frame of its step's colour.
#pragma once
#include <string>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"

namespace synpo {

struct StripPicture {
  Rgb frame;
  std::string label;
  Sign draw;
};

class FilmStrip {
 public:
  // In a strip `width` pixels wide, at most `columns` in a row; the side of a picture is a multiple of `unit` pixels.
  // Labels that are wider are broken.
  FilmStrip(std::string heading, std::vector<StripPicture> pictures, int columns, int unit, int width, const Pixels& px,
            const Font& font);

  int height() const;  // 0 without pictures
  void draw(Canvas& canvas, int x, int y) const;

 private:
  int rows() const { return (int(pictures_.size()) + columns_ - 1) / columns_; }
  int row_height() const;
  int heading_height() const;
  std::string heading_;
  std::vector<StripPicture> pictures_;
  Pixels px_;
  int gap_, line_, side_, columns_, columns_gap_;  // side_ with the frame
  std::vector<std::vector<std::string>> labels_;   // lines of each
  int lines_ = 1;                                  // of the longest
};

}  // namespace synpo
