#include "draw/canvas/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"

namespace synpo {
namespace {

// Corners are given to OpenCV in 1/16 pixel; its pixel centres are whole numbers, ours lie at a half.
constexpr int kShift = 4;

cv::Point fixed_point(Point p) {
  return {int(std::lround((p.x - 0.5) * (1 << kShift))), int(std::lround((p.y - 0.5) * (1 << kShift)))};
}

cv::Scalar scalar(Rgb colour) { return cv::Scalar(colour.b, colour.g, colour.r); }

}  // namespace

struct Canvas::Pixels {
  cv::Mat bgr;
};

Canvas::Canvas(int width, int height, const Font& font) : pixels_(std::make_unique<Pixels>()), font_(font) {
  constexpr int kLongest = 30000;
  constexpr int64_t kMost = 400'000'000;
  if (width > kLongest || height > kLongest || int64_t{width} * height > kMost)
    fail(Exit::kUsage, kPictureTooLarge, "the picture would have ", width, " x ", height, " pixels");
  pixels_->bgr = cv::Mat(height, width, CV_8UC3, cv::Scalar::all(255));
}

Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;

int Canvas::width() const { return pixels_->bgr.cols; }
int Canvas::height() const { return pixels_->bgr.rows; }

Rgb Canvas::at(int x, int y) const {
  const cv::Vec3b& pixel = pixels_->bgr.at<cv::Vec3b>(y, x);
  return {pixel[2], pixel[1], pixel[0]};
}

void Canvas::fill(const Box& box, Rgb colour) {
  if (box.width <= 0 || box.height <= 0) return;
  const cv::Rect whole(0, 0, width(), height());
  pixels_->bgr(cv::Rect(box.x, box.y, box.width, box.height) & whole).setTo(scalar(colour));
}

void Canvas::frame(const Box& box, int line, Rgb colour) {
  fill({box.x, box.y, box.width, line}, colour);
  fill({box.x, box.bottom() - line, box.width, line}, colour);
  fill({box.x, box.y, line, box.height}, colour);
  fill({box.right() - line, box.y, line, box.height}, colour);
}

void Canvas::polygon(const std::vector<Point>& corners, Rgb colour) {
  std::vector<cv::Point> fixed;
  for (const Point& corner : corners) fixed.push_back(fixed_point(corner));
  cv::fillConvexPoly(pixels_->bgr, fixed, scalar(colour), cv::LINE_AA, kShift);
}

void Canvas::disc(Point centre, double radius, Rgb colour) {
  cv::circle(pixels_->bgr, fixed_point(centre), int(std::lround(radius * (1 << kShift))), scalar(colour), cv::FILLED,
             cv::LINE_AA, kShift);
}

void Canvas::picture(const Box& box, const uint8_t* rgb) {
  for (int y = box.y; y < box.bottom(); ++y)
    for (int x = box.x; x < box.right(); ++x, rgb += 3) pixels_->bgr.at<cv::Vec3b>(y, x) = {rgb[2], rgb[1], rgb[0]};
}

void Canvas::blend(int x, int y, uint8_t coverage, Rgb colour) {
  if (coverage == 0) return;
  if (x < 0 || y < 0 || x >= width() || y >= height()) {
    ++clipped_;
    return;
  }
  cv::Vec3b& pixel = pixels_->bgr.at<cv::Vec3b>(y, x);
  const uint8_t to[3] = {colour.b, colour.g, colour.r};
  for (int i = 0; i < 3; ++i) pixel[i] = uint8_t((pixel[i] * (255 - coverage) + to[i] * coverage + 127) / 255);
}

void Canvas::paint(const Mask& mask, Rgb colour, double opacity) {
  const Box& box = mask.box;
  for (int y = std::max(0, box.y); y < std::min(height(), box.bottom()); ++y)
    for (int x = std::max(0, box.x); x < std::min(width(), box.right()); ++x) {
      const uint8_t coverage = mask.coverage[size_t(y - box.y) * box.width + (x - box.x)];
      blend(x, y, uint8_t(std::lround(coverage * opacity)), colour);
    }
}

void Canvas::text(int x, int y, const std::string& text, int size, Rgb colour, Across across, Upright upright) {
  const TextMask& mask = font_.mask(text, size);
  const int left = across == Across::kLeft ? x : across == Across::kCentre ? x - mask.width / 2 : x - mask.width;
  const int digit = font_.digit_height(size);
  const int baseline = upright == Upright::kBaseline ? y
                       : upright == Upright::kMiddle ? y + (digit + 1) / 2
                                                     : y + digit;
  const uint8_t* coverage = mask.coverage.data();
  for (int row = -mask.ascent; row < mask.descent; ++row)
    for (int column = 0; column < mask.width; ++column) blend(left + column, baseline + row, *coverage++, colour);
}

void Canvas::text_up(int x, int y, const std::string& text, int size, Rgb colour, Across along) {
  const TextMask& mask = font_.mask(text, size);
  const int start = along == Across::kLeft ? y : along == Across::kCentre ? y + mask.width / 2 : y + mask.width;
  const int baseline = x + (font_.digit_height(size) + 1) / 2;
  const uint8_t* coverage = mask.coverage.data();
  for (int row = -mask.ascent; row < mask.descent; ++row)
    for (int column = 0; column < mask.width; ++column) blend(baseline + row, start - 1 - column, *coverage++, colour);
}

std::string Canvas::png() const {
  std::vector<uint8_t> bytes;
  // Both parameters are given so that a build's defaults cannot change the bytes.
  cv::imencode(".png", pixels_->bgr, bytes,
               {cv::IMWRITE_PNG_COMPRESSION, 6, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_DEFAULT});
  return {bytes.begin(), bytes.end()};
}

}  // namespace synpo
