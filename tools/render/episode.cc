// synpo-render episode: a trajectory as a path through its maze or kitchen, and what the agent saw on the way.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/folder.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "base/text.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/episode/episode_picture.h"
#include "draw/face/film.h"
#include "draw/face/world_face.h"
#include "draw/terminal/terminal.h"
#include "draw/video/gif.h"
#include "draw/video/video.h"
#include "draw/worlds/faces.h"
#include "format/trajectory.h"
#include "play/episode.h"
#include "play/world_factory.h"
#include "render/render.h"
#include "world/world.h"

using namespace synpo;

namespace {

Trajectory read_trajectory(Input& input, int64_t line) {
  TrajectoryLines lines(input);
  std::string text;
  bool more = true;
  while (more && input.line_number() < uint64_t(line)) more = lines.next(text);
  if (input.line_number() < uint64_t(line))
    fail(Exit::kData, input.name(), ": it ends after ", counted(int64_t(input.line_number()), "line"), ", before line ",
         line);
  if (!more || input.line_number() > uint64_t(line))
    fail(Exit::kData, input.name(), ": line ", line, ": found the end of a stream, expected a trajectory");
  try {
    return parse_trajectory(text, kStepLimit);
  } catch (const Error& error) {
    input.bad_line(error);
  }
}

// The built-in world that the trajectory names.
std::unique_ptr<const WorldFace> world_named(const Input& input, const Trajectory& trajectory) {
  const std::vector<std::string>& names = world_names();
  if (std::find(names.begin(), names.end(), trajectory.world) == names.end())
    input.bad_line(concat("world ", quoted(trajectory.world), ", expected ", drawn_worlds()));
  return open_face(trajectory.world);
}

Film played(const Input& input, const World& world, const Trajectory& trajectory) {
  try {
    const Episode episode = replay(world, trajectory);
    return play_film(world, episode.pair, episode.start, episode.actions, trajectory.window);
  } catch (const Error& error) {
    input.bad_line(error);
  }
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
  WorldOptions world;
  std::string frames, video;
  int64_t line = 1;
  double rate = 8;
  Options options(
      "synpo-render episode", "[OPTION]... [TRAJECTORIES]",
      "Draws an episode as a path through its maze or kitchen, from light to dark, and what the agent saw on the way.");
  world.name.clear();
  world.add_to(options,
               "gridworld, gridworld:DIR for the map files of a folder, or kitchen [the one that the file names]");
  options.integer(0, "line", "N", "the episode's line", line, 1, INT64_MAX)
      .integer(0, "strip", "N", "pictures of what the agent saw: the first, picks, the last, others between; 0: none",
               style.strip, 0, kStepLimit)
      .call(0, "title", "TEXT", "title instead of environment and task", drawn(style.title))
      .section("instead of the picture");
  picture.add_ansi(options, "the path through a maze as text, in coloured blocks on a terminal that has colours");
  options.text(0, "frames", "DIR", "a folder of numbered PNG files, one for the start and one after every step", frames)
      .text(0, "video", "FILE", "the same as a video: .gif, .avi, or .mp4, .mkv where OpenCV can", video)
      .real(0, "rate", "HZ", "the video's frames per second", rate, 0.1, 240);
  picture.add_to(options, {"png", "pdf", "svg", "gif"});
  const auto operands = options.parse(argc, argv, 0, 1);
  const bool draws_films = !frames.empty() || !video.empty();
  if (picture.ansi && draws_films) fail(Exit::kUsage, "--ansi goes without --frames and --video");
  for (const char* option : {"output", "format"})
    if (draws_films && options.given(option))
      fail(Exit::kUsage, "--frames and --video take the place of the picture, but --", option, " is given");
  if (extension_of(video) == ".gif") {
    picture.output = std::exchange(video, "");
    picture.format = "gif";
  }
  picture.settle(options, {"strip"});
  const bool moves = picture.format == "gif";
  if ((draws_films || moves) && options.given("strip"))
    fail(Exit::kUsage, "--strip is for a picture of the whole episode, not for one of each moment");
  if (options.given("rate") && video.empty() && !moves) fail(Exit::kUsage, "--rate is for --video and for a GIF");
  style.scale = picture.scale;
  if (draws_films || moves) catch_stop_signals();

  std::unique_ptr<Output> output;
  if (moves || !draws_films)
    output = std::make_unique<Output>(picture.output, picture.ansi ? Output::Kind::kText : Output::Kind::kBinary,
                                      picture.force);
  Input input(operands.empty() ? "-" : operands[0]);
  std::unique_ptr<const Font> font;
  if (!picture.ansi) font = std::make_unique<const Font>(picture.font);
  std::unique_ptr<const WorldFace> face;
  if (options.given("world") || options.given("checkpoint")) face = world.open(options);
  const Trajectory trajectory = read_trajectory(input, line);
  if (!face) face = world_named(input, trajectory);
  if (picture.ansi && !face->kind().has_text)
    fail(Exit::kUsage, "--ansi is for ", environments_with(&FaceKind::has_text), ", but the world is ",
         quoted(face->world().name()));
  const Film film = played(input, face->world(), trajectory);
  if (picture.ansi) {
    std::string text = face->film_text(film, picture.colour.of(*output));
    if (!style.title.empty()) text.replace(0, text.find('\n'), style.title);  // the first line names the pair
    finish(*output, text);
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
