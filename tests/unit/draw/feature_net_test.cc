#include <gtest/gtest.h>

#include <vector>

#include "draw/vision/feature_net.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

constexpr char kMeans[] = "tests/data/means.onnx";  // made by tests/data/means_onnx.py

TEST(FeatureNet, IsGivenTheNormalisedChannels) {
  FeatureNet net(kMeans, 2048, 1);
  EXPECT_EQ(net.name(), "means");
  constexpr size_t kPixels = size_t(FeatureNet::kSide) * FeatureNet::kSide;
  std::vector<uint8_t> pictures(5 * kPixels * 3);
  for (size_t n = 0; n < 5; ++n)
    for (size_t i = 0; i < kPixels; ++i)
      for (size_t c = 0; c < 3; ++c)
        pictures[(n * kPixels + i) * 3 + c] = uint8_t(n == 4 ? (i % 2 ? 100 : 0) : 20 * n + 70 * c);
  std::vector<float> made(5 * 2048);
  net.extract(pictures.data(), 5, made.data());
  const double mean[] = {0.485, 0.456, 0.406}, deviation[] = {0.229, 0.224, 0.225};
  for (size_t n = 0; n < 5; ++n)
    for (size_t j = 0; j < 2048; ++j) {
      const double level = n == 4 ? 50 : 20 * double(n) + 70 * double(j % 3);
      ASSERT_NEAR(made[n * 2048 + j], (level / 255 - mean[j % 3]) / deviation[j % 3] * double(j + 1) / 2048, 1e-3)
          << n << " " << j;
    }
}

TEST(FeatureNet, RefusesWhatItCannotRun) {
  const TemporaryFolder folder;
  EXPECT_EQ(thrown([] { FeatureNet(kMeans, 1024, 1); }),
            "65 'tests/data/means.onnx': found an output of 1 x 2048 for 1 pictures, expected 1 x 1024");
  const std::string good = contents(kMeans), start = "65 cannot read ";
  for (const std::string& bad :
       {std::string(), std::string("no network"), good.substr(0, good.size() / 2), std::string(1000, '\0')})
    EXPECT_TRUE(thrown([&] { FeatureNet(folder.file("bad.onnx", bad), 2048, 1); }).starts_with(start)) << bad.size();
  EXPECT_TRUE(thrown([&] { FeatureNet(folder.file("none.onnx"), 2048, 1); }).starts_with("66 "));
}

}  // namespace
}  // namespace synpo
