#include "draw/video/video.h"

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "base/error.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/files/unfinished.h"
#include "base/rgb.h"
#include "base/text.h"

namespace synpo {
namespace {

struct Format {
  const char* extension;
  int backend;
  char code[5];
};
constexpr Format kFormats[] = {
    {".avi", cv::CAP_OPENCV_MJPEG, "MJPG"}, {".mp4", cv::CAP_FFMPEG, "avc1"}, {".mkv", cv::CAP_FFMPEG, "mp4v"}};

const Format& format_of(const std::string& path) {
  for (const Format& format : kFormats)
    if (extension_of(path) == format.extension) return format;
  fail(Exit::kUsage, "cannot tell the format of the video '", path,
       "': expected a name that ends in .gif, .avi, .mp4 or .mkv");
}

}  // namespace

struct Video::Writer {
  Writer(const std::string& path, const Destination& destination, const char* extension, int width, int height)
      : use(path, destination.identity()), file(destination, extension), bgr(height, width, CV_8UC3) {}

  OutputUse use;
  UnfinishedFile file;
  cv::VideoWriter video;
  cv::Mat bgr;
};

Video::Video(const std::string& path, double frames_per_second, int width, int height) : path_(path) {
  const Format& format = format_of(path);
  const Destination destination = Destination::find(path);
  if (destination.kind != Destination::Kind::kFile)
    fail(Exit::kUsage, "cannot write the video '", path, "': expected a file, found a device or a pipe");
  destination.check_replaceable();
  writer_ = std::make_unique<Writer>(path, destination, format.extension, width, height);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const auto& c = format.code;
  if (!writer_->video.open(writer_->file.path(), format.backend, cv::VideoWriter::fourcc(c[0], c[1], c[2], c[3]),
                           frames_per_second, {width, height}))
    fail(Exit::kUsage, "cannot write the video '", path, "': this OpenCV has no encoder for ", format.extension,
         ", but .gif and .avi can be written");
}

Video::~Video() = default;

void Video::add(const Canvas& frame) {
  cv::Mat& bgr = writer_->bgr;
  if (frame.width() != bgr.cols || frame.height() != bgr.rows) fail(Exit::kInternal, "a frame of another size");
  for (int y = 0; y < bgr.rows; ++y)
    for (int x = 0; x < bgr.cols; ++x) {
      const Rgb colour = frame.at(x, y);
      bgr.at<cv::Vec3b>(y, x) = {colour.b, colour.g, colour.r};
    }
  writer_->video.write(bgr);
  ++frames_;
}

void Video::finish() {
  writer_->video.release();
  // The writer tells of no error. The backend that wrote the file counts what is in it.
  cv::VideoCapture read(writer_->file.path(), format_of(path_).backend);
  int whole = 0;
  while (read.isOpened() && read.grab()) ++whole;
  if (whole != frames_) fail(Exit::kIo, "cannot write '", path_, "': ", whole, " of ", frames_, " frames got there");
  writer_->file.publish();
}

}  // namespace synpo
