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
#include "base/text.h"

namespace synpo {
namespace {

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

// Whether a letter is written in the other direction. Digits, marks and signs have none of their own.
bool has_letters_against(const std::string& text, hb_direction_t direction) {
  for (size_t i = 0; i < text.size();) {
    const auto [length, code] = character_at(text, i);
    const hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), code);
    if (script != HB_SCRIPT_COMMON && script != HB_SCRIPT_INHERITED && script != HB_SCRIPT_UNKNOWN &&
        hb_script_get_horizontal_direction(script) != direction)
      return true;
    i += std::max<size_t>(length, 1);
  }
  return false;
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
  mixes_directions_ |= has_letters_against(text, hb_buffer_get_direction(buffer));
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

Ruler Font::ruler(int size) const {
  return {.width_of = [this, size](const std::string& text) { return width(text, size); }, .gap = size / 8};
}

std::string Font::fitted(const std::string& text, int size, int width) const {
  return synpo::fitted(text, ruler(size), width);
}

std::vector<std::string> Font::fitted_apart(const std::vector<std::string>& names, int size, int width) const {
  return synpo::fitted_apart(names, ruler(size), width);
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
