// Pictures as a video, in what this build of OpenCV can write.
#pragma once
#include <memory>
#include <string>

#include "draw/canvas/canvas.h"

namespace synpo {

// The end of the file's name chooses the format: .avi is Motion JPEG and always there; .mp4, H.264 that browsers play,
// and .mkv, MPEG-4, need OpenCV's ffmpeg. A file beside `path` takes the name in finish(), as an Output's does;
// unfinished, it leaves nothing.
class Video {
 public:
  // Throws kUsage for a format that cannot be written and for what is no file, kCantCreate where the file cannot be
  // made.
  Video(const std::string& path, double frames_per_second, int width, int height);
  ~Video();

  // Of the size given.
  void add(const Canvas& frame);
  // Throws kIo when the file does not hold all frames.
  void finish();

 private:
  struct Writer;
  std::string path_;
  std::unique_ptr<Writer> writer_;
  int frames_ = 0;
};

}  // namespace synpo
