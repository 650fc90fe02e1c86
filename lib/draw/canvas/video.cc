#include "draw/canvas/video.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

#include "base/error.h"

namespace synpo {
namespace {

struct Format {
  const char* extension;
  int backend;
  char code[5];
};
constexpr Format kFormats[] = {
    {".avi", cv::CAP_OPENCV_MJPEG, "MJPG"}, {".mp4", cv::CAP_FFMPEG, "mp4v"}, {".mkv", cv::CAP_FFMPEG, "mp4v"}};

const Format& format_of(const std::string& path) {
  for (const Format& format : kFormats)
    if (std::filesystem::path(path).extension() == format.extension) return format;
  fail(Exit::kUsage, "cannot tell the format of the video '", path,
       "': expected a name that ends in .avi, .mp4 or .mkv");
}

}  // namespace

struct Video::Writer {
  cv::VideoWriter video;
  cv::Mat bgr;
};

Video::Video(const std::string& path, double frames_per_second, int width, int height)
    : writer_(std::make_unique<Writer>()), path_(path) {
  const Format& format = format_of(path);
  const std::string temporary = path + ".part" + std::to_string(getpid()) + format.extension;
  const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) fail(Exit::kCantCreate, "cannot create '", path, "': ", std::strerror(errno));
  close(fd);
  temporary_ = temporary;
  writer_->bgr = cv::Mat(height, width, CV_8UC3);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const auto& c = format.code;
  if (!writer_->video.open(temporary_, format.backend, cv::VideoWriter::fourcc(c[0], c[1], c[2], c[3]),
                           frames_per_second, {width, height})) {
    unlink(temporary_.c_str());
    fail(Exit::kUsage, "cannot write the video '", path, "': this OpenCV cannot write ", format.extension,
         ", but .avi it can");
  }
}

Video::~Video() {
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

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
  cv::VideoCapture read(temporary_, format_of(path_).backend);
  int whole = 0;
  while (read.isOpened() && read.grab()) ++whole;
  if (whole != frames_) fail(Exit::kIo, "cannot write '", path_, "': ", whole, " of ", frames_, " frames got there");
  if (rename(temporary_.c_str(), path_.c_str()) != 0)
    fail(Exit::kCantCreate, "cannot create '", path_, "': ", std::strerror(errno));
  temporary_.clear();
}

}  // namespace synpo
