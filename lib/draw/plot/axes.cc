#include "draw/plot/axes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/rgb.h"
#include "draw/colour.h"

namespace synpo {
namespace {

constexpr double kLabelPt = 8.5, kTitlePt = 9, kTickPt = 3.5, kLinePt = 0.6, kGridPt = 0.5;
constexpr double kSpacePt = 3, kTitleSpacePt = 6, kBetweenLabelsPt = 14;
constexpr Rgb kGrid = {230, 232, 235};

}  // namespace

int Axes::pixels(double pt) const { return std::max(1, int(std::lround(pt * scale_))); }

Ticks Axes::x_ticks(int width) const {
  for (int most = 12;; --most) {
    Ticks ticks = x_.ticks(most);
    if (most == 2) return ticks;
    int labels = 0;
    for (const double at : ticks.at) labels = std::max(labels, font_.width(x_.label(at, ticks), pixels(kLabelPt)));
    double nearest = 1;  // shares of the way
    for (size_t i = 1; i < ticks.at.size(); ++i)
      nearest = std::min(nearest, x_.place(ticks.at[i]) - x_.place(ticks.at[i - 1]));
    if ((labels + pixels(kBetweenLabelsPt)) / double(width) <= nearest) return ticks;
  }
}

Ticks Axes::y_ticks(int height) const { return y_.ticks(std::clamp(height / pixels(21), 2, 11)); }

int Axes::y_label_width(int height) const {
  const Ticks ticks = y_ticks(height);
  int width = 0;
  for (const double at : ticks.at) width = std::max(width, font_.width(y_.label(at, ticks), pixels(kLabelPt)));
  return width;
}

Axes::Margins Axes::margins(int width, int height) const {
  const int beside = pixels(kTickPt) + pixels(kSpacePt), title = pixels(kTitlePt);
  const Ticks ticks = x_ticks(width);
  int right = 0;
  for (const double at : ticks.at) {
    const int label = (font_.width(x_.label(at, ticks), pixels(kLabelPt)) + 1) / 2;
    right = std::max(right, label - int((1 - x_.place(at)) * width));
  }
  // Letters reach below the digits' line by up to a third of their size.
  return {
      title + pixels(kSpacePt) + y_label_width(height) + beside, right, pixels(kLabelPt) / 2,
      beside + font_.digit_height(pixels(kLabelPt)) + pixels(kTitleSpacePt) + font_.digit_height(title) + title / 3};
}

Point Axes::place(const Box& box, double x, double y) const {
  return {box.x + x_.place(x) * box.width, box.bottom() - y_.place(y) * box.height};
}

void Axes::draw(Canvas& canvas, const Box& box) const {
  const int size = pixels(kLabelPt), title = pixels(kTitlePt), tick = pixels(kTickPt), space = pixels(kSpacePt),
            line = pixels(kLinePt);
  const int grid = pixels(kGridPt);
  const Ticks across = x_ticks(box.width), up = y_ticks(box.height);
  for (const double at : up.at) {
    const int y = int(std::lround(place(box, x_.low, at).y));
    canvas.fill({box.x, y - grid / 2, box.width, grid}, kGrid);
    canvas.fill({box.x - tick, y - line / 2, tick, line}, kSoftInk);
    canvas.text(box.x - tick - space, y, y_.label(at, up), size, kInk, Across::kRight, Upright::kMiddle);
  }
  for (const double at : across.at) {
    const int x = int(std::lround(place(box, at, y_.low).x));
    canvas.fill({x - grid / 2, box.y, grid, box.height}, kGrid);
    canvas.fill({x - line / 2, box.bottom(), line, tick}, kSoftInk);
    canvas.text(x, box.bottom() + tick + space, x_.label(at, across), size, kInk, Across::kCentre);
  }
  const auto fitted = [&](const std::string& text, int length) { return font_.fitted(text, title, length); };
  const int below = box.bottom() + tick + space + font_.digit_height(size) + pixels(kTitleSpacePt);
  canvas.text(box.x + box.width / 2, below, fitted(x_.title, box.width), title, kInk, Across::kCentre);
  canvas.text_up(box.x - tick - space - y_label_width(box.height) - pixels(kSpacePt) - title * 2 / 3,
                 box.y + box.height / 2, fitted(y_.title, box.height + title * 2), title, kInk, Across::kCentre);
}

void Axes::frame(Canvas& canvas, const Box& box) const {
  const int line = pixels(kLinePt);
  canvas.frame({box.x - line / 2, box.y - line / 2, box.width + line, box.height + line}, line, kSoftInk);
}

}  // namespace synpo
