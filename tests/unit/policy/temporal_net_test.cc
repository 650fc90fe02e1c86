#include "policy/encoder/temporal_net.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "helpers/numbers.h"
#include "helpers/policy_fixture.h"
#include "nn/buffer.h"

namespace synpo {
namespace {

constexpr int kView = 5, kObjects = 3, kFeature = 3;
constexpr TemporalSizes kTiny = {4, 2, 6};

ObservationSpec spec_of(int view, int objects) { return {Sight::kFeatures, 0, {}, view, objects}; }

std::vector<uint8_t> observations_of(int n, const std::vector<float>& views, const std::vector<int>& hands, int view) {
  const size_t row = size_t(kHistory) * view + ObservationSpec::kObjectFloats;
  std::vector<float> floats(n * row, 0);
  for (int i = 0; i < n; ++i) {
    std::copy_n(views.begin() + size_t(i) * kHistory * view, size_t(kHistory) * view, floats.begin() + i * row);
    floats[i * row + size_t(kHistory) * view] = float(hands[i]);
  }
  return bytes_of(floats);
}

// A network over random observations.
template <class T>
struct Fixture {
  explicit Fixture(int n) : Fixture(spec_of(kView, kObjects), kTiny, kFeature, n) {}
  Fixture(const ObservationSpec& spec, const TemporalSizes& sizes, int feature, int n)
      : n(n), net(spec, sizes, feature, layout), views(random_values<float>(size_t(n) * kHistory * spec.view, 3)) {
    Random random(1, Purpose::kBatch);
    for (int i = 0; i < n; ++i) hands.push_back(int(random.below(uint32_t(spec.objects))));
    observations = observations_of(n, views, hands, spec.view);
    EXPECT_EQ(observations.size(), n * spec.bytes());
    EXPECT_EQ(net.observation_size(), spec.bytes());
    parameters.assign(layout.total(), T(0));
    gradient.assign(layout.total(), T(7));  // backward() overwrites
    net.initialise(5, parameters.data(), nullptr);
  }
  std::vector<T> psi(Parallel& parallel, int feature) {
    std::vector<T> out(size_t(n) * feature);
    net.forward(parallel, n, observations.data(), parameters.data(), nullptr, out.data(), false);
    return out;
  }
  T* at(const char* name) { return parameters.data() + layout.find(name)->offset; }

  int n;
  Layout layout;
  TemporalNet<T> net;
  std::vector<float> views;
  std::vector<int> hands;
  std::vector<uint8_t> observations;
  std::vector<T> parameters, gradient;
};

// A convolution of kernel 3, stride 2 and padding 1 by its definition, with ReLU: x [length, in] to y [length / 2,
// out].
std::vector<double> convolved(const std::vector<double>& x, int length, int in, int out, const double* w,
                              const double* b) {
  std::vector<double> y(size_t(length / 2) * out);
  for (int t = 0; t < length / 2; ++t)
    for (int o = 0; o < out; ++o) {
      double sum = b[o];
      for (int tap = 0; tap < 3; ++tap) {
        const int at = 2 * t - 1 + tap;
        if (at < 0 || at >= length) continue;
        for (int i = 0; i < in; ++i) sum += x[size_t(at) * in + i] * w[(size_t(tap) * in + i) * out + o];
      }
      y[size_t(t) * out + o] = std::max(0.0, sum);
    }
  return y;
}

TEST(TemporalNet, IsTable3) {
  Fixture<double> f(9);
  Parallel parallel(2);
  const std::vector<double> psi = f.psi(parallel, kFeature);
  for (int i = 0; i < f.n; ++i) {
    const auto first = f.views.begin() + size_t(i) * kHistory * kView;
    std::vector<double> x = convolved({first, first + kHistory * kView}, 4, kView, kTiny.channels,
                                      f.at("encoder.conv1.weight"), f.at("encoder.conv1.bias"));
    x = convolved(x, 2, kTiny.channels, kTiny.channels, f.at("encoder.conv2.weight"), f.at("encoder.conv2.bias"));
    const double* object = f.at("encoder.object") + size_t(f.hands[i]) * kTiny.object_embedding;
    x.insert(x.end(), object, object + kTiny.object_embedding);
    const auto dense = [&](const std::vector<double>& in, int out, const char* w, const char* b, bool relu) {
      std::vector<double> y(f.at(b), f.at(b) + out);
      for (size_t k = 0; k < in.size(); ++k)
        for (int o = 0; o < out; ++o) y[o] += in[k] * f.at(w)[k * out + o];
      for (double& value : y) value = relu ? std::max(0.0, value) : value;
      return y;
    };
    x = dense(x, kTiny.hidden, "encoder.fc.hidden.weight", "encoder.fc.hidden.bias", true);
    x = dense(x, kFeature, "encoder.fc.out.weight", "encoder.fc.out.bias", false);
    for (int o = 0; o < kFeature; ++o) EXPECT_NEAR(psi[size_t(i) * kFeature + o], x[o], 1e-12) << i << " " << o;
  }
}

TEST(TemporalNet, FullSizeHasTable3sShapes) {
  Layout layout;
  const TemporalNet<float> net(spec_of(2048, 8), {}, 256, layout);
  EXPECT_EQ(layout.find("encoder.conv1.weight")->shape, (std::vector<int>{3, 2048, 1024}));
  EXPECT_EQ(layout.find("encoder.conv2.weight")->shape, (std::vector<int>{3, 1024, 1024}));
  EXPECT_EQ(layout.find("encoder.fc.hidden.weight")->shape, (std::vector<int>{1056, 2048}));
  EXPECT_EQ(layout.find("encoder.fc.out.weight")->shape, (std::vector<int>{2048, 256}));
  EXPECT_EQ(net.multiply_adds(), size_t(1024) * 5 * 2048 + size_t(1024) * 2 * 1024 + 1056 * 2048 + 2048 * 256);
}

TEST(TemporalNet, GradientIsThatOfFiniteDifferences) {
  Fixture<double> f(70);  // more than a shard
  Parallel parallel(2);
  const std::vector<double> by = random_values<double>(size_t(f.n) * kFeature, 11);
  const auto loss = [&] {
    const std::vector<double> psi = f.psi(parallel, kFeature);
    double sum = 0;
    for (size_t i = 0; i < psi.size(); ++i) sum += psi[i] * by[i];
    return sum;
  };
  loss();
  std::vector<double> dpsi = by;
  f.net.backward(parallel, f.parameters.data(), dpsi.data(), f.gradient.data());
  for (const TensorInfo& tensor : f.layout.tensors())
    for (size_t at = tensor.offset; at < tensor.offset + tensor.size; ++at) {
      const double kept = f.parameters[at], step = 1e-6;
      f.parameters[at] = kept + step;
      const double right = loss();
      f.parameters[at] = kept - step;
      const double left = loss();
      f.parameters[at] = kept;
      ASSERT_NEAR(f.gradient[at], (right - left) / (2 * step), 1e-4 * (1 + std::abs(f.gradient[at])))
          << tensor.name << " at " << at - tensor.offset;
    }
}

TEST(TemporalNet, InferenceGivesWhatTrainingGave) {
  Fixture<float> f(spec_of(96, 8), {64, 32, 128}, 48, 130);
  Parallel one(1), two(2);
  const std::vector<float> psi = f.psi(two, 48);
  EXPECT_EQ(f.psi(one, 48), psi);
  std::vector<float> again(psi.size());
  f.net.prepare_inference(two, f.parameters.data(), nullptr);
  for (const auto& [from, count] : {std::pair{0, 64}, {64, 1}, {65, 64}, {129, 1}})
    f.net.infer(1, count, f.observations.data() + from * f.net.observation_size(), again.data() + size_t(from) * 48);
  for (size_t i = 0; i < psi.size(); ++i) ASSERT_NEAR(again[i], psi[i], 1e-5 * (1 + std::abs(psi[i]))) << i;
}

TEST(TemporalNet, ObservationsMayStandAnywhere) {
  Fixture<float> f(9);
  Parallel parallel(1);
  const std::vector<float> psi = f.psi(parallel, kFeature);
  const std::vector<uint8_t> bytes = f.observations;
  f.observations.resize(bytes.size() + 1);
  std::copy(bytes.begin(), bytes.end(), f.observations.begin() + 1);
  std::vector<float> out(psi.size());
  f.net.forward(parallel, f.n, f.observations.data() + 1, f.parameters.data(), nullptr, out.data(), false);
  EXPECT_EQ(out, psi);
}

TEST(TemporalNet, ThreadsDoNotShowInTheGradient) {
  std::vector<float> gradients[2];
  for (const int threads : {1, 2}) {
    Fixture<float> f(spec_of(600, 8), {520, 32, 40}, 16, 150);  // so large that threads pack them together
    Parallel parallel(threads);
    std::vector<float> dpsi = f.psi(parallel, 16);
    f.net.backward(parallel, f.parameters.data(), dpsi.data(), f.gradient.data());
    gradients[threads - 1] = f.gradient;
  }
  EXPECT_TRUE(gradients[0] == gradients[1]) << "bits differ";
}

}  // namespace
}  // namespace synpo
