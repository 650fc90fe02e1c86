// Shared by the commands of synpo-render: options, operands, and how pictures are written.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/cli/screen.h"
#include "base/files/io.h"
#include "colour.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/face/world_face.h"
#include "play/world_factory.h"

// Every command takes these: where the picture goes, its format, size and font; and --ansi, where the command can draw
// with characters. settle() comes after the command line is read, and before the others.
struct PictureOptions {
  static constexpr char kAnsiHelp[] = "coloured blocks for a terminal, as text, instead of a picture";
  std::string output = "-", format, font;
  synpo::ColourOption colour;
  bool force = false, ansi = false;
  double scale = 0;  // pixels per point

  void add_to(synpo::Options& options, std::vector<std::string> formats = {"png", "pdf", "svg"});
  void add_ansi(synpo::Options& options, const std::string& help = kAnsiHelp);
  // Chooses format and scale. Throws kUsage for a name that ends in no format, or in another than the one given, and
  // for --ansi with an option that only a picture knows: those of the command named here, and format, size and font;
  // and for --colour without --ansi.
  void settle(const synpo::Options& options, std::vector<const char*> not_ansi = {});
  synpo::Output open() const;
  // Writes it in its format, and says on standard error which characters its font lacks.
  void finish(synpo::Output& output, const synpo::Canvas& canvas) const;
  void say_missing(const synpo::Font& font) const;

  // Of the terminal that the text goes to; 0 where it goes elsewhere.
  static int width(const synpo::Output& output) { return synpo::screen_size(output.is_stdout() ? 1 : -1).columns; }

 private:
  std::vector<std::string> formats_;
};

void finish(synpo::Output& output, const std::string& bytes);

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

// Commands that draw of a world have it by its name or from a checkpoint.
struct WorldOptions {
  std::string name = "gridworld", checkpoint;
  int window = 1;  // that the checkpoint's agent has

  void add_to(synpo::Options& options,
              const std::string& help = "gridworld, gridworld:DIR for the map files of a folder, or kitchen") {
    options.text('w', "world", "WORLD", help, name)
        .suggest(synpo::world_kinds())
        .text('c', "checkpoint", "FILE", "instead of -w: the world of a checkpoint", checkpoint);
  }
  // Throws kUsage where both are given.
  std::unique_ptr<const synpo::WorldFace> open(const synpo::Options& options);
};

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
