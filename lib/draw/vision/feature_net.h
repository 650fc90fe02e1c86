// A network in an ONNX file that makes features of pictures, run by OpenCV.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

namespace synpo {

class FeatureNet {
 public:
  static constexpr int kSide = 224;  // of a picture

  // Throws kData for a file that is no network OpenCV can run, or one that does not make `features` numbers of a
  // picture.
  FeatureNet(const std::string& path, int features, int threads);
  ~FeatureNet();

  const std::string& name() const { return name_; }  // the file's stem
  uint64_t hash() const { return hash_; }            // of the file

  // The features [count, features] of pictures [count, kSide, kSide, 3], red, green, blue. The network is given [count,
  // 3, kSide, kSide] with the channels normalised by mean and deviation of ImageNet.
  void extract(const uint8_t* pictures, int count, float* features);

 private:
  struct Net;
  std::string path_, name_;
  int features_;
  uint64_t hash_ = 0;
  std::unique_ptr<Net> net_;
};

}  // namespace synpo
