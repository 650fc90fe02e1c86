// The last states of an episode as pictures in a row, the newest on the right.
#pragma once
#include <functional>
#include <string>

#include "draw/canvas/canvas.h"

namespace synpo {

class HistoryRow {
 public:
  // `width` pixels wide; the side of a picture is a multiple of `unit` pixels.
  HistoryRow(int width, int unit, const Pixels& px);

  int height() const;
  // `draw` draws number i of kHistory, the oldest 0; of an episode that has had `count` states the first ones are
  // missing.
  void draw(Canvas& canvas, int x, int y, const std::string& heading, int count,
            const std::function<void(const Box& box, int i, bool missing)>& draw) const;

 private:
  Pixels px_;
  int side_, gap_;
};

}  // namespace synpo
