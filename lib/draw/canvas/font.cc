#include "draw/canvas/font.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/freetype.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "base/error.h"
#include "base/files/io.h"

namespace synpo {
namespace {

const char kEllipsis[] = "\u2026";

const char* const kFontPaths[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",          "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/local/share/fonts/DejaVuSans.ttf",
};

std::string font_path(const std::string& wish) {
  if (!wish.empty()) return wish;
  if (const char* named = std::getenv("SYNPO_FONT"); named && *named) return named;
  for (const char* path : kFontPaths)
    if (std::error_code error; std::filesystem::is_regular_file(path, error)) return path;
  fail(Exit::kNoInput, kNoFont,
       "cannot find the font DejaVuSans.ttf: install the Debian package fonts-dejavu-core, or name a TrueType file");
}

// Positions at which a new character of UTF-8 text begins, and the text's end.
std::vector<size_t> character_starts(const std::string& text) {
  std::vector<size_t> starts;
  for (size_t i = 0; i < text.size(); ++i)
    if ((uint8_t(text[i]) & 0xc0) != 0x80) starts.push_back(i);
  starts.push_back(text.size());
  return starts;
}

}  // namespace

struct Font::Face {
  cv::Ptr<cv::freetype::FreeType2> freetype;
};

Font::Font(const std::string& path) : face_(std::make_unique<Face>()) {
  const std::string file = font_path(path);
  try {
    Input probe(file);  // its message is better than OpenCV's
  } catch (const Error& error) {
    fail(error.code(), "cannot read the font: ", error.what());
  }
  try {
    face_->freetype = cv::freetype::createFreeType2();
    face_->freetype->loadFontData(file, 0);
  } catch (const cv::Exception&) {
    fail(Exit::kData, "cannot read the font ", quoted(file), ": no format that FreeType knows");
  }
}

Font::~Font() = default;

const TextMask& Font::mask(const std::string& text, int size) const {
  const auto [entry, fresh] = masks_.try_emplace({text, size});
  TextMask& mask = entry->second;
  if (!fresh || text.empty()) return mask;
  int baseline = 0;
  const cv::Size box = face_->freetype->getTextSize(text, size, -1, &baseline);
  // Accents and overhangs may leave the box that is measured.
  const int margin = size + 2, origin = 2 * size;
  cv::Mat ink(3 * size + 2, box.width + 2 * margin, CV_8UC3, cv::Scalar::all(0));
  face_->freetype->putText(ink, text, cv::Point(margin, origin), size, cv::Scalar::all(255), -1, cv::LINE_AA, true);
  std::vector<cv::Point> inked;
  cv::Mat grey;
  cv::extractChannel(ink, grey, 0);
  cv::findNonZero(grey, inked);
  if (inked.empty()) return mask;
  const cv::Rect bounds = cv::boundingRect(inked);
  const int top = std::min(bounds.y, origin - 1), bottom = std::max(bounds.y + bounds.height, origin);
  mask.width = bounds.width;
  mask.ascent = origin - top;
  mask.descent = bottom - origin;
  for (int y = top; y < bottom; ++y)
    mask.coverage.insert(mask.coverage.end(), grey.ptr(y) + bounds.x, grey.ptr(y) + bounds.x + bounds.width);
  return mask;
}

std::string Font::fitted(const std::string& text, int size, int width) const {
  const std::vector<size_t> starts = character_starts(text);
  const size_t characters = starts.size() - 1;
  // Hardly any character is narrower than a pixel, and to measure takes thousands of bytes for each.
  const size_t most = size_t(std::max(width, 0)) + 1;
  if (characters <= most && this->width(text, size) <= width) return text;
  // Names that share a long beginning differ at their end, so both are kept.
  const auto shortened = [&](size_t kept) {
    const size_t tail = kept / 2, head = kept - tail;
    return text.substr(0, starts[head]) + kEllipsis + text.substr(starts[characters - tail]);
  };
  size_t fits = 0, too_long = std::min(characters, most);
  while (fits + 1 < too_long) {
    const size_t middle = (fits + too_long) / 2;
    (this->width(shortened(middle), size) <= width ? fits : too_long) = middle;
  }
  return shortened(fits);
}

std::vector<std::string> Font::wrapped(const std::string& text, int size, int width) const {
  std::vector<std::string> lines;
  std::string line;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    const std::string word = fitted(text.substr(begin, end - begin), size, width);
    const bool new_line = begin > 0 && text[begin - 1] == '\n';
    begin = end + 1;
    if (word.empty()) continue;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && (new_line || this->width(longer, size) > width)) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace synpo
