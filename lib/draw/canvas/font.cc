#include "draw/canvas/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <hb-ft.h>
#include <hb.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
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
  ~Face() {
    if (font) hb_font_destroy(font);
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  hb_font_t* font = nullptr;
  double em = 1;
};

Font::Font(const std::string& path) : face_(std::make_shared<Face>()) {
  const std::string file = font_path(path);
  try {
    Input probe(file);  // its message is better than FreeType's
  } catch (const Error& error) {
    fail(error.code(), "cannot read the font: ", error.what());
  }
  // What has no outlines cannot be scaled.
  if (FT_Init_FreeType(&face_->library) || FT_New_Face(face_->library, file.c_str(), 0, &face_->face) ||
      !FT_IS_SCALABLE(face_->face))
    fail(Exit::kData, "cannot read the font ", quoted(file), ": no format that FreeType knows");
  face_->em = face_->face->units_per_EM;
  hb_face_t* const shapes = hb_ft_face_create_referenced(face_->face);
  face_->font = hb_font_create(shapes);
  hb_face_destroy(shapes);
}

Font::~Font() = default;

// It keeps all that FreeType has of the font.
std::shared_ptr<FT_FaceRec_> Font::face() const { return {face_, face_->face}; }

std::string Font::family() const {
  const char* const name = face_->face->family_name;
  return name ? name : "sans-serif";
}

const TextShape& Font::shape(const std::string& text) const {
  const auto [entry, fresh] = shapes_.try_emplace(text);
  TextShape& shape = entry->second;
  if (!fresh || text.empty()) return shape;
  hb_buffer_t* const buffer = hb_buffer_create();
  hb_buffer_add_utf8(buffer, text.data(), int(text.size()), 0, int(text.size()));
  hb_buffer_set_language(buffer, hb_language_from_string("en", -1));  // not that of the user's locale
  hb_buffer_guess_segment_properties(buffer);
  shape.leftwards = HB_DIRECTION_IS_BACKWARD(hb_buffer_get_direction(buffer));
  hb_shape(face_->font, buffer, nullptr, 0);
  unsigned count = 0;
  const hb_glyph_info_t* const infos = hb_buffer_get_glyph_infos(buffer, &count);
  const hb_glyph_position_t* const positions = hb_buffer_get_glyph_positions(buffer, &count);
  double x = 0, y = 0;
  bool inked = false;
  for (unsigned i = 0; i < count; ++i) {
    const double left = (x + positions[i].x_offset) / face_->em, up = (y + positions[i].y_offset) / face_->em;
    shape.glyphs.push_back({infos[i].codepoint, left, up, infos[i].cluster});
    hb_glyph_extents_t ink;
    if (hb_font_get_glyph_extents(face_->font, infos[i].codepoint, &ink) && ink.width != 0 && ink.height != 0) {
      const double from = left + ink.x_bearing / face_->em, top = up + ink.y_bearing / face_->em;
      const double to = from + ink.width / face_->em, bottom = top + ink.height / face_->em;
      shape.left = inked ? std::min(shape.left, from) : from;
      shape.right = inked ? std::max(shape.right, to) : to;
      shape.top = inked ? std::max(shape.top, top) : top;
      shape.bottom = inked ? std::min(shape.bottom, bottom) : bottom;
      inked = true;
    }
    x += positions[i].x_advance;
    y += positions[i].y_advance;
  }
  shape.advance = x / face_->em;
  hb_buffer_destroy(buffer);
  const std::vector<size_t> starts = character_starts(text);
  for (const TextShape::Glyph& glyph : shape.glyphs)
    if (glyph.index == 0)
      missing_.insert(
          text.substr(glyph.begin, *std::upper_bound(starts.begin(), starts.end(), glyph.begin) - glyph.begin));
  return shape;
}

int Font::width(const std::string& text, int size) const {
  const TextShape& inked = shape(text);
  return int(std::ceil(size * (inked.right - inked.left) - 1e-6));
}

int Font::digit_height(int size) const { return int(std::lround(size * shape("0").top)); }

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

std::vector<std::string> Font::fitted_apart(const std::vector<std::string>& names, int size, int width) const {
  std::vector<std::string> out;
  std::map<std::string, std::set<std::string>> sharing;  // names by what they were shortened to
  for (const std::string& name : names) {
    out.push_back(fitted(name, size, width));
    sharing[out.back()].insert(name);
  }
  for (const auto& [same, group] : sharing) {
    if (group.size() < 2) continue;
    // In order, so the first and the last share least.
    const std::string &first = *group.begin(), &last = *group.rbegin();
    const size_t differ =
        size_t(std::mismatch(first.begin(), first.end(), last.begin(), last.end()).first - first.begin());
    std::map<std::string, std::string> apart;
    std::set<std::string> different;
    for (const std::string& name : group) {
      const std::vector<size_t> starts = character_starts(name);
      size_t from = size_t(std::upper_bound(starts.begin(), starts.end(), differ) - starts.begin()) - 1, to = from;
      const auto cut = [&](size_t end) {
        return kEllipsis + name.substr(starts[from], starts[end] - starts[from]) +
               (end + 1 < starts.size() ? kEllipsis : "");
      };
      while (to + 1 < starts.size() && to - from < size_t(std::max(width, 0)) &&
             this->width(cut(to + 1), size) <= width)
        ++to;
      apart[name] = cut(to);
      different.insert(apart[name]);
    }
    int number = 0;
    if (different.size() < group.size())
      for (auto& [name, shown] : apart) {
        const std::string mark = concat("#", ++number);
        shown = fitted(name, size, width - this->width(mark, size) - size / 8) + mark;
      }
    for (size_t i = 0; i < names.size(); ++i)
      if (const auto shown = apart.find(names[i]); shown != apart.end() && out[i] == same) out[i] = shown->second;
  }
  return out;
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
