// synpo-render episode: a trajectory as a path through its maze or kitchen, and what the agent saw on the way.
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/folder.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/episode/episode_picture.h"
#include "draw/face/film.h"
#include "draw/face/world_face.h"
#include "draw/terminal/terminal.h"
#include "draw/video/gif.h"
#include "draw/video/video.h"
#include "draw/worlds/faces.h"
#include "play/episode.h"
#include "play/stream.h"
#include "render/render.h"
#include "world/world.h"

using namespace synpo;

namespace {

Film read_film(Input& input, const World& world, int64_t line) {
  TrajectoryStream stream(input, world, {});
  const uint64_t before = stream.length_up_to(uint64_t(line - 1));
  const std::optional<Episode> episode = stream.next();
  if (!episode)
    fail(Exit::kData, input.name(), ": it ends after ", before, before == 1 ? " line" : " lines", ", before line ",
         line);
  return play_film(world, episode->pair, episode->start, episode->actions, stream.window());
}

// Of the start and after every step.
using Frame = std::function<Canvas(int moment)>;

void write_frames(const std::string& path, int steps, const Frame& frame) {
  OutputFolder folder(path);
  for (int i = 0; i <= steps; ++i) {
    stop_if_asked();
    char name[32];
    std::snprintf(name, sizeof name, "%04d.png", i);
    folder.write(name, frame(i).png());
  }
  folder.finish();
}

void write_gif(Output& output, double rate, int steps, const Frame& frame) {
  finish(output, animated_gif(steps + 1, rate, [&](int i) {
           stop_if_asked();
           return frame(i);
         }));
}

void write_video(const std::string& path, double rate, int steps, const Frame& frame) {
  std::unique_ptr<Video> video;
  for (int i = 0; i <= steps; ++i) {
    stop_if_asked();
    const Canvas drawn = frame(i);
    if (!video) video = std::make_unique<Video>(path, rate, drawn.width(), drawn.height());
    video->add(drawn);
  }
  video->finish();
}

}  // namespace

int episode(int argc, char** argv) {
  EpisodeStyle style;
  PictureOptions picture;
  std::string world_name = "gridworld", frames, video;
  int64_t line = 1;
  double rate = 8;
  bool ansi = false;
  Options options(
      "synpo-render episode", "[OPTION]... [TRAJECTORIES]",
      "Draws an episode as a path through its maze or kitchen, from light to dark, and what the agent saw on the way.");
  options.text('w', "world", "WORLD", kWorldHelp, world_name)
      .integer(0, "line", "N", "the episode's line", line, 1, INT64_MAX)
      .integer(0, "strip", "N", "pictures of what the agent saw: the first, picks, the last, others between; 0: none",
               style.strip, 0, kStepLimit)
      .call(0, "title", "TEXT", "title instead of environment and task", drawn(style.title))
      .section("instead of the picture")
      .flag(0, "ansi", "the path through a maze as text, in coloured blocks on a terminal that has colours", ansi)
      .text(0, "frames", "DIR", "a folder of numbered PNG files, one for the start and one after every step", frames)
      .text(0, "video", "FILE", "the same as a video: .gif, .avi, or .mp4, .mkv where OpenCV can", video)
      .real(0, "rate", "HZ", "the video's frames per second", rate, 0.1, 240);
  picture.add_to(options, {"png", "pdf", "svg", "gif"});
  const auto operands = options.parse(argc, argv, 0, 1);
  const std::unique_ptr<const WorldFace> face = open_face(world_name);
  const bool draws_films = !frames.empty() || !video.empty();
  if (ansi && draws_films) fail(Exit::kUsage, "--ansi goes without --frames and --video");
  if (ansi && !face->kind().has_text)
    fail(Exit::kUsage, "--ansi is for ", environments_with(&FaceKind::has_text), ", but the world is ",
         quoted(world_name));
  for (const char* option : {"output", "format"})
    if (draws_films && options.given(option))
      fail(Exit::kUsage, "--frames and --video take the place of the picture, but --", option, " is given");
  if (ansi && options.given("format")) fail(Exit::kUsage, "--format is for a picture, not for --ansi");
  if (video.ends_with(".gif")) {
    picture.output = std::exchange(video, "");
    picture.format = "gif";
  }
  if (!ansi) picture.settle(options);
  const bool moves = picture.format == "gif";
  if (options.given("rate") && video.empty() && !moves) fail(Exit::kUsage, "--rate is for --video and for a GIF");
  style.scale = picture.scale;
  if (draws_films || moves) catch_stop_signals();

  std::unique_ptr<Output> output;
  if (moves || !draws_films)
    output =
        std::make_unique<Output>(picture.output, ansi ? Output::Kind::kText : Output::Kind::kBinary, picture.force);
  Input input(operands.empty() ? "-" : operands[0]);
  std::unique_ptr<const Font> font;
  if (!ansi) font = std::make_unique<const Font>(picture.font);
  const Film film = read_film(input, face->world(), line);
  if (ansi) {
    finish(*output, face->film_text(film, terminal_colour(output->is_stdout() ? 1 : -1)));
    return 0;
  }
  const Frame frame = [&](int moment) { return draw_episode_frame(*face, film, moment, style, *font); };
  if (!frames.empty()) write_frames(frames, film.steps(), frame);
  if (!video.empty()) write_video(video, rate, film.steps(), frame);
  if (moves) write_gif(*output, rate, film.steps(), frame);
  if (output && !moves)
    picture.finish(*output, draw_episode(*face, film, style, *font));
  else
    picture.say_missing(*font);
  return 0;
}
