#include "draw/vision/feature_net.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <vector>

#include "base/error.h"
#include "base/files/io.h"
#include "base/hash.h"

namespace synpo {
namespace {

constexpr size_t kFileLimit = size_t(1) << 31;  // as ONNX has it
constexpr float kMean[3] = {0.485f, 0.456f, 0.406f}, kDeviation[3] = {0.229f, 0.224f, 0.225f};

// OpenCV's words, in one line.
std::string line_of(const cv::Exception& error) {
  std::string text = error.err.empty() ? error.what() : error.err;
  std::replace(text.begin(), text.end(), '\n', ' ');
  return synpo::quoted(text);
}

}  // namespace

struct FeatureNet::Net {
  cv::dnn::Net net;
};

FeatureNet::FeatureNet(const std::string& path, int features, int threads)
    : path_(path), name_(std::filesystem::path(path).stem().string()), features_(features),
      net_(std::make_unique<Net>()) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  if (threads > 0) cv::setNumThreads(threads);
  Input input(path);
  const std::string bytes = input.rest(kFileLimit);
  hash_ = Hash().add(bytes).value();
  try {
    net_->net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
  } catch (const cv::Exception& error) {
    fail(Exit::kData, "cannot read ", input.name(), ": no network in ONNX that OpenCV can run (", line_of(error), ")");
  }
  const std::vector<uint8_t> black(size_t(kSide) * kSide * 3, 0);
  std::vector<float> made(size_t(features), 0.0f);
  extract(black.data(), 1, made.data());
}

FeatureNet::~FeatureNet() = default;

void FeatureNet::extract(const uint8_t* pictures, int count, float* features) {
  constexpr size_t kPixels = size_t(kSide) * kSide;
  const int shape[] = {count, 3, kSide, kSide};
  cv::Mat blob(4, shape, CV_32F);
  float* out = blob.ptr<float>();
  for (int n = 0; n < count; ++n, pictures += 3 * kPixels)
    for (int c = 0; c < 3; ++c)
      for (size_t i = 0; i < kPixels; ++i)
        *out++ = (float(pictures[3 * i + size_t(c)]) / 255 - kMean[c]) / kDeviation[c];
  cv::Mat made;
  try {
    net_->net.setInput(blob);
    made = net_->net.forward();
  } catch (const cv::Exception& error) {
    fail(Exit::kData, synpo::quoted(path_), ": OpenCV cannot run it on ", count, " pictures of 3 x ", kSide, " x ",
         kSide, " (", line_of(error), ")");
  }
  if (made.type() != CV_32F || made.total() != size_t(count) * size_t(features_) || made.size[0] != count) {
    std::string found;
    for (int i = 0; i < made.dims; ++i) found += (i > 0 ? " x " : "") + std::to_string(made.size[i]);
    fail(Exit::kData, synpo::quoted(path_), ": found an output of ", found, " for ", count, " pictures, expected ",
         count, " x ", features_);
  }
  std::copy_n(made.ptr<float>(), made.total(), features);
}

}  // namespace synpo
