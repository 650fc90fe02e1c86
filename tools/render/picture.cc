// What every command's picture has: its options, its format, and how it is written.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "render/render.h"

using namespace synpo;

namespace {

// Lines of a PDF and an SVG lie on a grid about as fine as a printer's.
constexpr double kPngScale = 2, kVectorScale = 4;

}  // namespace

void PictureOptions::add_to(Options& options, std::vector<std::string> formats) {
  formats_ = std::move(formats);
  options.section("picture")
      .text('o', "output", "FILE", "write to FILE; the end of its name chooses the format", output)
      .choice(0, "format", "KIND", alternatives(formats_), format, formats_)
      .shown_as("by the name, else png")
      .flag('f', "force", "write to a terminal too", force)
      .real(0, "scale", "X", "pixels per point (text is about 9 points high)", scale, 0.25, 16)
      .shown_as("2, and 4 for a PDF's or SVG's grid")
      .text(0, "font", "FILE", "TrueType font instead of DejaVu Sans", font);
}

void PictureOptions::add_ansi(Options& options, const std::string& help) {
  options.flag(0, "ansi", help, ansi);
  colour.add_to(options);
}

void PictureOptions::settle(const Options& options, std::vector<const char*> not_ansi) {
  if (!ansi && options.given("colour")) fail(Exit::kUsage, "--colour is for --ansi");
  not_ansi.insert(not_ansi.end(), {"format", "scale", "font"});
  for (const char* option : not_ansi)
    if (ansi && options.given(option)) fail(Exit::kUsage, "--", option, " is for a picture, not for --ansi");
  if (ansi) return;
  const std::string ending = extension_of(output), extension = ending.substr(std::min<size_t>(1, ending.size()));
  const bool known = std::find(formats_.begin(), formats_.end(), extension) != formats_.end();
  if (format.empty() && !extension.empty() && !known) {
    std::vector<std::string> names;
    for (const std::string& one : formats_) names.push_back("." + one);
    fail(Exit::kUsage, "cannot tell the format of the picture ", synpo::quoted(output),
         ": expected a name that ends in ", alternatives(names), ", or --format");
  }
  if (!format.empty() && known && extension != format)
    fail(Exit::kUsage, "--format ", format, " does not go with the name ", synpo::quoted(output));
  if (format.empty()) format = known ? extension : "png";
  if (!options.given("scale")) scale = format == "pdf" || format == "svg" ? kVectorScale : kPngScale;
}

Output PictureOptions::open() const {
  // An SVG is text, but none that anybody wants to read.
  return Output(output, ansi ? Output::Kind::kText : Output::Kind::kBinary, force);
}

void finish(Output& output, const std::string& bytes) {
  output.write(bytes);
  output.finish();
}

void PictureOptions::finish(Output& output, const Canvas& canvas) const {
  ::finish(output, format == "pdf" ? canvas.pdf() : format == "svg" ? canvas.svg() : canvas.png());
  say_missing(canvas.font());
}

void PictureOptions::say_missing(const Font& font) const {
  // A viewer of SVG turns words around by itself.
  if (font.mixes_directions() && format != "svg")
    std::fprintf(stderr,
                 "synpo-render: note: a text that mixes directions of writing is set in that of its first letter\n");
  constexpr size_t kMostNamed = 8;
  const size_t count = font.missing().size();
  if (count == 0) return;
  std::string names;
  size_t named = 0;
  for (const std::string& character : font.missing())
    if (named++ < kMostNamed) names += (names.empty() ? "" : ", ") + quoted(character);
  if (count > kMostNamed) names += concat(" and ", count - kMostNamed, " more");
  std::fprintf(stderr, "synpo-render: note: the font %s lacks %s, drawn as boxes; --font names another\n",
               font.family().c_str(), names.c_str());
}
