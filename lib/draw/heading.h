// Title and caption above a picture, each wrapped to the width given.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas.h"

namespace synpo {

class Heading {
 public:
  // Either may be empty. `scale` is in pixels per point.
  Heading(const std::string& title, const std::string& caption, int width, double scale, const Font& font);
  // With the space beneath; 0 for no text.
  int height() const;
  void draw(Canvas& canvas, int x, int y) const;

 private:
  std::vector<std::string> title_, caption_;
  int title_size_, title_line_, caption_size_, caption_line_, space_;
};

}  // namespace synpo
