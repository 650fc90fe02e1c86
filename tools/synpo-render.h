// What the commands of synpo-render share.
#pragma once
#include <string>

#include "base/io.h"
#include "base/options.h"
#include "draw/canvas.h"

// What every command takes: where the picture goes, its size and its font.
struct PictureOptions {
  std::string output = "-", font;
  bool force = false;
  double scale = 2;

  void add_to(synpo::Options& options) {
    options.section("picture")
        .text('o', "output", "FILE", "write the PNG to FILE", output)
        .flag('f', "force", "write to a terminal too", force)
        .real(0, "scale", "X", "pixels per point (text is about 9 points high)", scale, 0.25, 16)
        .text(0, "font", "FILE", "TrueType font instead of DejaVu Sans", font);
  }
};

inline void finish(synpo::Output& output, const synpo::Canvas& canvas) {
  output.write(canvas.png());
  output.finish();
}

int curves(int argc, char** argv);
int embedding(int argc, char** argv);
int episode(int argc, char** argv);
int policy(int argc, char** argv);
