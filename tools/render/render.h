// Shared by the commands of synpo-render: options, operands, and how pictures are written.
#pragma once
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "draw/canvas/canvas.h"
#include "draw/face/world_face.h"

// Every command takes these: where the picture goes, its size and its font; and --ansi, where the command can draw with
// characters.
struct PictureOptions {
  std::string output = "-", font;
  bool force = false, ansi = false;
  double scale = 2;

  void add_to(synpo::Options& options) {
    options.section("picture")
        .text('o', "output", "FILE", "write the PNG to FILE", output)
        .flag('f', "force", "write to a terminal too", force)
        .real(0, "scale", "X", "pixels per point (text is about 9 points high)", scale, 0.25, 16)
        .text(0, "font", "FILE", "TrueType font instead of DejaVu Sans", font);
  }

  void add_ansi(synpo::Options& options) {
    options.flag(0, "ansi", "coloured blocks for a terminal, as text, instead of a PNG", ansi);
  }
  // Throws kUsage for --ansi with an option that only a PNG knows: those of the command, and the size and the font.
  void check(const synpo::Options& options, std::vector<const char*> png_only) const {
    png_only.insert(png_only.end(), {"scale", "font"});
    for (const char* option : png_only)
      if (ansi && options.given(option))
        synpo::fail(synpo::Exit::kUsage, "--", option, " is for a PNG, not for --ansi");
  }

  synpo::Output open() const {
    return synpo::Output(output, ansi ? synpo::Output::Kind::kText : synpo::Output::Kind::kBinary, force);
  }
};

inline void finish(synpo::Output& output, const std::string& text) {
  output.write(text);
  output.finish();
}
inline void finish(synpo::Output& output, const synpo::Canvas& canvas) { finish(output, canvas.png()); }

// Files of one label: runs of one method, shards of one matrix.
struct LabelledFiles {
  std::string label;
  std::vector<std::string> paths;
};

// Operands FILE, LABEL=FILE[,FILE]..., or LABEL= in front of FILEs; none is standard input. Where there is a file of
// just that name, it is meant. A file without a label has its own name for one, and none where it is alone. Throws
// kUsage for what can't be read so, and for labels that cannot be drawn.
std::vector<LabelledFiles> labelled_files(std::vector<std::string> operands);

// The argument of an option that is drawn. Throws std::invalid_argument where it is not UTF-8, has control characters
// or more than kLongestDrawn bytes, each of which takes some kB to draw.
constexpr size_t kLongestDrawn = 1000;
const std::string& drawable(const std::string& text);
// Takes a title from an option.
inline auto drawn(std::string& title) {
  return [&title](const std::string& given) { title = drawable(given); };
}

constexpr char kWorldHelp[] = "gridworld, gridworld:DIR for the map files of a folder, or kitchen";
// Positions of an environment and a task by their names. Throw kUsage for one that is not there; `world` is what the
// message calls the world.
int find_env(const synpo::WorldFace& face, const std::string& name, const char* world = "this world");
int find_task(const synpo::WorldFace& face, const std::string& name);

int heatmap(int argc, char** argv);
int curves(int argc, char** argv);
int embedding(int argc, char** argv);
int episode(int argc, char** argv);
int policy(int argc, char** argv);
int features(int argc, char** argv);
