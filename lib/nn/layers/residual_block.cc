#include "nn/layers/residual_block.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernels.h"

namespace synpo {
namespace {

constexpr int kUnit = 32;  // samples of a shard where no convolution asks for another number
constexpr int kFine = 8;   // of a shard of a stage that has no product

// body(samples, thread) for all of [0, samples) in fine shards.
template <class Body>
void for_fine_parts(Parallel& parallel, int samples, Body&& body) {
  parallel.run(shard_count(samples, kFine),
               [&](int shard, int thread) { body(shard_range(samples, kFine, shard), thread); });
}

}  // namespace

void run_jobs(Parallel& parallel, const Jobs& jobs) {
  parallel.run(int(jobs.size()), [&](int job, int) { jobs[size_t(job)](); });
}

template <class T>
ResidualBlock<T>::ResidualBlock(const std::string& name, int side, int in, int out, int stride, Layout& parameters,
                                Layout& statistics) {
  const auto add = [&](const std::string& conv, const std::string& norm, int conv_side, int conv_in, int kernel,
                       int conv_stride) {
    const size_t i = convs_.size();
    convs_.emplace_back(conv_side, conv_in, out, kernel, conv_stride);
    const std::vector<int> shape = kernel == 1 ? std::vector<int>{conv_in, out} : std::vector<int>{3, 3, conv_in, out};
    weights_[i] = parameters.add(name + "." + conv + ".weight", shape);
    const std::string place = name + "." + norm;
    norm_places_[i] = {parameters.add(place + ".scale", {out}), parameters.add(place + ".shift", {out}),
                       statistics.add(place + ".mean", {out}), statistics.add(place + ".variance", {out})};
    norms_[i] = BatchNorm<T>(out);
  };
  add("conv1", "norm1", side, in, 3, stride);
  add("conv2", "norm2", side_out(), out, 3, 1);
  if (stride != 1 || in != out) add("shortcut", "shortcut_norm", side, in, 1, stride);
}

template <class T>
size_t ResidualBlock<T>::multiply_adds() const {
  size_t sum = 0;
  for (const Conv<T>& conv : convs_) sum += conv.multiply_adds();
  return sum;
}

template <class T>
void ResidualBlock<T>::initialise(InitStream& stream, T* parameters, T* statistics) const {
  for (size_t i = 0; i < places(); ++i) {
    const Conv<T>& conv = convs_[i];
    // kaiming_uniform with a = sqrt(5), PyTorch's default, is uniform within 1 / sqrt(inputs).
    stream.uniform(parameters + weights_[i], conv.weight_size(),
                   1 / std::sqrt(double(conv.weight_size()) / conv.out()));
    std::fill_n(parameters + norm_places_[i].scale, conv.out(), T(1));
    std::fill_n(parameters + norm_places_[i].shift, conv.out(), T(0));
    std::fill_n(statistics + norm_places_[i].mean, conv.out(), T(0));
    std::fill_n(statistics + norm_places_[i].variance, conv.out(), T(1));
  }
}

template <class T>
void ResidualBlock<T>::add_preparations(Jobs& jobs, const T* parameters, bool training) {
  for (size_t i = 0; i < places(); ++i)
    for (int p = 0; p < convs_[i].products(); ++p)
      jobs.push_back([this, i, p, parameters, training] { convs_[i].prepare(p, parameters + weights_[i], training); });
}

template <class T>
template <class Count, class Body>
void ResidualBlock<T>::run_shards(Parallel& parallel, std::initializer_list<Place> convs, Count&& count, Body&& body) {
  std::vector<std::pair<Place, int>> shards;
  for (const Place i : convs)
    for (int shard = 0; shard < count(convs_[i]); ++shard) shards.emplace_back(i, shard);
  parallel.run(int(shards.size()),
               [&](int number, int) { body(shards[size_t(number)].first, shards[size_t(number)].second); });
}

template <class T>
void ResidualBlock<T>::convolve(Place i, ResidualWorkspace<T>& work, const T* from, Range samples, int shard,
                                int thread, const T* statistics, bool frozen) {
  const Conv<T>& conv = convs_[i];
  T* z = z_[i].data() + samples.begin * conv.y_size();
  conv.forward(samples.size(), from, z, work.scratch[size_t(thread)].products);
  if (!frozen) norms_[i].add_rows(shard, z, size_t(samples.size()) * pixels(), statistics + norm_places_[i].mean);
}

template <class T>
void ResidualBlock<T>::finish_norm(Place i, const T* parameters, T* statistics, bool frozen) {
  const NormPlace& place = norm_places_[i];
  if (frozen)
    norms_[i].freeze(parameters + place.scale, parameters + place.shift, statistics + place.mean,
                     statistics + place.variance);
  else
    norms_[i].finish(size_t(n_) * pixels(), parameters + place.scale, parameters + place.shift, statistics + place.mean,
                     statistics + place.variance);
}

template <class T>
void ResidualBlock<T>::forward(Parallel& parallel, ResidualWorkspace<T>& work, int n, const LazyPictures<T>& x,
                               const T* parameters, T* statistics, bool frozen) {
  n_ = n;
  x_ = x.values;
  work.use_threads(parallel.threads());
  for (size_t i = 0; i < places(); ++i) z_[i].grow(n * convs_[i].y_size());
  y_.grow(n * y_size());
  const int unit = inner().unit(), shards = shard_count(n, unit);
  for (size_t i = 0; i < places(); ++i) norms_[i].begin(shards);
  if (staged(parallel, n)) return forward_staged(parallel, work, x, parameters, statistics, frozen);
  parallel.run(shards, [&](int shard, int thread) {
    const Range samples = shard_range(n, unit, shard);
    x.make(samples);
    const T* from = x.values + samples.begin * x_size();
    convolve(kFirst, work, from, samples, shard, thread, statistics, frozen);
    if (has_shortcut()) convolve(kShortcut, work, from, samples, shard, thread, statistics, frozen);
  });
  finish_norm(kFirst, parameters, statistics, frozen);
  if (has_shortcut()) finish_norm(kShortcut, parameters, statistics, frozen);
  parallel.run(shards, [&](int shard, int thread) {
    const Range samples = shard_range(n, unit, shard);
    T* y1 = work.scratch[size_t(thread)].picture.grow(samples.size() * y_size());
    kernels<T>().norm_relu(size_t(samples.size()) * pixels(), out(), z_[kFirst].data() + samples.begin * y_size(),
                           norms_[kFirst].scale(), norms_[kFirst].shift(), y1);
    convolve(kSecond, work, y1, samples, shard, thread, statistics, frozen);
  });
  finish_norm(kSecond, parameters, statistics, frozen);
}

// Products and outputs of convolutions whose inputs are made (a plain one's are x), then the sums of normalisation.
template <class T>
void ResidualBlock<T>::run_stages(Parallel& parallel, ResidualWorkspace<T>& work, std::initializer_list<Place> convs,
                                  const T* x, const T* statistics, bool frozen) {
  run_shards(
      parallel, convs, [&](const Conv<T>& conv) { return conv.product_shards(n_); },
      [&](Place i, int shard) { convs_[i].stage_product(shard, work.slabs[i], n_, x, z_[i].data()); });
  for_fine_parts(parallel, n_, [&](Range part, int) {
    for (const Place i : convs) convs_[i].stage_outputs(work.slabs[i], part, z_[i].data());
  });
  if (frozen) return;
  const int unit = inner().unit(), shards = shard_count(n_, unit);
  parallel.run(shards * int(convs.size()), [&](int number, int) {
    const Place i = convs.begin()[number / shards];
    const int shard = number % shards;
    const Range samples = shard_range(n_, unit, shard);
    norms_[i].add_rows(shard, z_[i].data() + samples.begin * y_size(), size_t(samples.size()) * pixels(),
                       statistics + norm_places_[i].mean);
  });
}

template <class T>
void ResidualBlock<T>::forward_staged(Parallel& parallel, ResidualWorkspace<T>& work, const LazyPictures<T>& x,
                                      const T* parameters, T* statistics, bool frozen) {
  for (size_t i = 0; i < places(); ++i) convs_[i].reserve_stages(work.slabs[i], n_, false);
  for_fine_parts(parallel, n_, [&](Range part, int) {
    x.make(part);
    const T* from = x.values + part.begin * x_size();
    convs_[kFirst].stage_inputs(work.slabs[kFirst], part, from);
    if (has_shortcut()) convs_[kShortcut].stage_inputs(work.slabs[kShortcut], part, from);
  });
  if (has_shortcut())
    run_stages(parallel, work, {kFirst, kShortcut}, x.values, statistics, frozen);
  else
    run_stages(parallel, work, {kFirst}, x.values, statistics, frozen);
  finish_norm(kFirst, parameters, statistics, frozen);
  if (has_shortcut()) finish_norm(kShortcut, parameters, statistics, frozen);
  T* y1 = work.dy1.grow(n_ * y_size());
  for_fine_parts(parallel, n_, [&](Range part, int) {
    const size_t at = part.begin * y_size();
    kernels<T>().norm_relu(size_t(part.size()) * pixels(), out(), z_[kFirst].data() + at, norms_[kFirst].scale(),
                           norms_[kFirst].shift(), y1 + at);
    convs_[kSecond].stage_inputs(work.slabs[kSecond], part, y1 + at);
  });
  run_stages(parallel, work, {kSecond}, y1, statistics, frozen);
  finish_norm(kSecond, parameters, statistics, frozen);
}

template <class T>
LazyPictures<T> ResidualBlock<T>::output() {
  return {y_.data(), [this](Range samples) { finish_output(samples); }};
}

template <class T>
void ResidualBlock<T>::finish_output(Range samples) {
  const size_t at = samples.begin * y_size();
  const bool own = has_shortcut();
  const T* shortcut = own ? z_[kShortcut].data() : x_;
  kernels<T>().norm_add_relu(size_t(samples.size()) * pixels(), out(), z_[kSecond].data() + at, norms_[kSecond].scale(),
                             norms_[kSecond].shift(), shortcut + at, own ? norms_[kShortcut].scale() : nullptr,
                             own ? norms_[kShortcut].shift() : nullptr, y_.data() + at);
}

// `d`, the gradient of the output, is masked by the last ReLU and summed for the normalisations before it.
template <class T>
void ResidualBlock<T>::mask_gradient(int shard, Range samples, T* d) {
  const size_t at = samples.begin * y_size(), count = samples.size() * y_size();
  kernels<T>().relu_mask(count, d + at, y_.data() + at);
  for (size_t i = kSecond; i < places(); ++i)
    norms_[i].add_backward_rows(shard, d + at, z_[i].data() + at, count / out(), false);
}

template <class T>
void ResidualBlock<T>::finish_norm_backward(Place i, const T* parameters, T* gradient) {
  const NormPlace& place = norm_places_[i];
  norms_[i].finish_backward(n_ * pixels(), parameters + place.scale, gradient + place.scale, gradient + place.shift);
}

template <class T>
void ResidualBlock<T>::weight_gradients(Parallel& parallel, ResidualWorkspace<T>& work,
                                        std::initializer_list<Place> convs, Range samples, T* gradient) {
  const bool in_stages = staged(parallel, samples.size());
  run_shards(
      parallel, convs, [&](const Conv<T>& conv) { return conv.pack_shards(in_stages); },
      [&](Place i, int p) { convs_[i].pack_outputs(p, work.slabs[i], samples.size()); });
  run_shards(
      parallel, convs, [&](const Conv<T>& conv) { return conv.gradient_shards(in_stages); },
      [&](Place i, int shard) {
        const Conv<T>& conv = convs_[i];
        T* to = conv.transformed() ? dfactors_[i].data() : gradient + weights_[i];
        conv.weight_gradient(shard, in_stages, work.slabs[i], samples.size(), samples.begin > 0, to);
      });
}

// What comes after the operands of a slab's convolutions: gradients of parts, and products for dx.
template <class T>
void ResidualBlock<T>::stage_gradients(Parallel& parallel, ResidualWorkspace<T>& work,
                                       std::initializer_list<Place> convs, int samples, bool dx) {
  const auto parts = [&](const Conv<T>& conv) { return conv.part_gradient_shards(samples); };
  run_shards(
      parallel, convs, [&](const Conv<T>& conv) { return parts(conv) + (dx ? conv.product_shards(samples) : 0); },
      [&](Place i, int shard) {
        const Conv<T>& conv = convs_[i];
        if (shard < parts(conv))
          conv.stage_part_gradient(shard, work.slabs[i], samples);
        else
          conv.stage_dproduct(shard - parts(conv), work.slabs[i], samples);
      });
}

template <class T>
void ResidualBlock<T>::backward_second_staged(Parallel& parallel, ResidualWorkspace<T>& work, Range slab) {
  const Conv<T>& conv = convs_[kSecond];
  const size_t size = y_size(), from = slab.begin * size;
  const int samples = slab.size(), unit = conv.unit();
  conv.reserve_stages(work.slabs[kSecond], samples, true);
  for_fine_parts(parallel, samples, [&](Range part, int thread) {
    const size_t at = from + part.begin * size, count = part.size() * pixels();
    auto& scratch = work.scratch[size_t(thread)];
    T* dz = scratch.picture.grow(part.size() * size);
    T* y1 = scratch.second.grow(part.size() * size);
    norms_[kSecond].apply_backward(work.d.data() + at, z_[kSecond].data() + at, dz, count, false);
    kernels<T>().norm_relu(count, out(), z_[kFirst].data() + at, norms_[kFirst].scale(), norms_[kFirst].shift(), y1);
    conv.stage_operands(work.slabs[kSecond], part, y1, dz);
  });
  stage_gradients(parallel, work, {kSecond}, samples, true);
  for_fine_parts(parallel, samples,
                 [&](Range part, int) { conv.stage_dx(work.slabs[kSecond], part, work.dy1.data() + from, false); });
  parallel.run(shard_count(samples, unit), [&](int shard, int) {
    const Range part = shard_range(samples, unit, shard);
    const size_t at = from + part.begin * size;
    norms_[kFirst].add_backward_rows(slab.begin / unit + shard, work.dy1.data() + at, z_[kFirst].data() + at,
                                     part.size() * pixels(), true);
  });
}

template <class T>
void ResidualBlock<T>::backward_first_staged(Parallel& parallel, ResidualWorkspace<T>& work, ResidualBlock* before,
                                             Range slab, T* dx) {
  const bool own = has_shortcut();
  const size_t size = y_size(), from = slab.begin * size;
  const int samples = slab.size(), unit = inner().unit();
  T* slab_dx = dx ? dx + slab.begin * x_size() : nullptr;
  for (const Place i : {kFirst, kShortcut})
    if (i == kFirst || own) convs_[i].reserve_stages(work.slabs[i], samples, true);
  for_fine_parts(parallel, samples, [&](Range part, int thread) {
    const size_t at = from + part.begin * size, count = part.size() * pixels();
    const T* x = x_ + (slab.begin + part.begin) * x_size();
    T* dz = work.scratch[size_t(thread)].picture.grow(part.size() * size);
    norms_[kFirst].apply_backward(work.dy1.data() + at, z_[kFirst].data() + at, dz, count, true);
    convs_[kFirst].stage_operands(work.slabs[kFirst], part, x, dz);
    if (!own) return;
    norms_[kShortcut].apply_backward(work.d.data() + at, z_[kShortcut].data() + at, dz, count, false);
    convs_[kShortcut].stage_operands(work.slabs[kShortcut], part, x, dz);
  });
  if (own)
    stage_gradients(parallel, work, {kFirst, kShortcut}, samples, dx);
  else
    stage_gradients(parallel, work, {kFirst}, samples, dx);
  if (!dx) return;
  for_fine_parts(parallel, samples, [&](Range part, int) {
    convs_[kFirst].stage_dx(work.slabs[kFirst], part, slab_dx, !own);
    if (own) convs_[kShortcut].stage_dx(work.slabs[kShortcut], part, slab_dx, true);
  });
  if (!before) return;
  parallel.run(shard_count(samples, unit), [&](int shard, int) {
    const Range part = shard_range(samples, unit, shard);
    before->mask_gradient(slab.begin / unit + shard, {slab.begin + part.begin, slab.begin + part.end}, dx);
  });
}

// From d through the second convolution: dy1, and what the first normalisation needs.
template <class T>
void ResidualBlock<T>::backward_second(Parallel& parallel, ResidualWorkspace<T>& work, const T* parameters,
                                       T* gradient) {
  const Conv<T>& conv = convs_[kSecond];
  const size_t size = y_size();
  const int unit = conv.unit();
  norms_[kFirst].begin_backward(shard_count(n_, unit));
  conv.reserve(work.slabs[kSecond], Conv<T>::kSlab);
  for (int begin = 0; begin < n_; begin += Conv<T>::kSlab) {
    const Range slab = {begin, std::min(n_, begin + Conv<T>::kSlab)};
    if (staged(parallel, slab.size())) {
      backward_second_staged(parallel, work, slab);
      weight_gradients(parallel, work, {kSecond}, slab, gradient);
      continue;
    }
    parallel.run(shard_count(slab.size(), unit), [&](int shard, int thread) {
      const Range part = shard_range(slab.size(), unit, shard);
      const size_t at = (begin + part.begin) * size, count = part.size() * pixels();
      auto& scratch = work.scratch[size_t(thread)];
      const T* z = z_[kFirst].data() + at;
      T* dy1 = work.dy1.data() + at;
      T* dz = scratch.picture.grow(part.size() * size);
      T* y1 = scratch.second.grow(part.size() * size);
      norms_[kSecond].apply_backward(work.d.data() + at, z_[kSecond].data() + at, dz, count, false);
      kernels<T>().norm_relu(count, out(), z, norms_[kFirst].scale(), norms_[kFirst].shift(), y1);
      conv.backward(work.slabs[kSecond], part, y1, dz, dy1, false, scratch.products);
      norms_[kFirst].add_backward_rows(begin / unit + shard, dy1, z, count, true);
    });
    weight_gradients(parallel, work, {kSecond}, slab, gradient);
  }
  finish_norm_backward(kFirst, parameters, gradient);
}

// From dy1 and d through the first convolution and the shortcut: d becomes the gradient of the input.
template <class T>
void ResidualBlock<T>::backward_first(Parallel& parallel, ResidualWorkspace<T>& work, ResidualBlock* before,
                                      T* gradient) {
  const Conv<T>& conv = convs_[kFirst];
  const bool own = has_shortcut();
  const size_t size = y_size();
  const int unit = conv.unit();
  conv.reserve(work.slabs[kFirst], Conv<T>::kSlab);
  if (own) convs_[kShortcut].reserve(work.slabs[kShortcut], Conv<T>::kSlab);
  if (before)
    for (BatchNorm<T>& norm : before->norms_) norm.begin_backward(shard_count(n_, unit));
  T* dx = !before ? nullptr : own ? work.dx.data() : work.d.data();
  for (int begin = 0; begin < n_; begin += Conv<T>::kSlab) {
    const Range slab = {begin, std::min(n_, begin + Conv<T>::kSlab)};
    const bool in_stages = staged(parallel, slab.size());
    if (in_stages) backward_first_staged(parallel, work, before, slab, dx);
    parallel.run(in_stages ? 0 : shard_count(slab.size(), unit), [&](int shard, int thread) {
      const Range part = shard_range(slab.size(), unit, shard), samples = {begin + part.begin, begin + part.end};
      const size_t at = samples.begin * size, count = part.size() * pixels();
      auto& scratch = work.scratch[size_t(thread)];
      const T* x = x_ + samples.begin * x_size();
      T* dx_part = dx ? dx + samples.begin * x_size() : nullptr;
      T* dz = scratch.picture.grow(part.size() * size);
      norms_[kFirst].apply_backward(work.dy1.data() + at, z_[kFirst].data() + at, dz, count, true);
      conv.backward(work.slabs[kFirst], part, x, dz, dx_part, !own, scratch.products);
      if (own) {
        norms_[kShortcut].apply_backward(work.d.data() + at, z_[kShortcut].data() + at, dz, count, false);
        convs_[kShortcut].backward(work.slabs[kShortcut], part, x, dz, dx_part, true, scratch.products);
      }
      if (before) before->mask_gradient(begin / unit + shard, samples, dx);
    });
    if (own)
      weight_gradients(parallel, work, {kFirst, kShortcut}, slab, gradient);
    else
      weight_gradients(parallel, work, {kFirst}, slab, gradient);
  }
  if (own) std::swap(work.d, work.dx);
}

template <class T>
void ResidualBlock<T>::begin_backward(Parallel& parallel, ResidualWorkspace<T>& work) {
  for (BatchNorm<T>& norm : norms_) norm.begin_backward(shard_count(n_, kUnit));
  parallel.run(shard_count(n_, kUnit),
               [&](int shard, int) { mask_gradient(shard, shard_range(n_, kUnit, shard), work.d.data()); });
}

template <class T>
void ResidualBlock<T>::backward(Parallel& parallel, ResidualWorkspace<T>& work, ResidualBlock* before,
                                const T* parameters, T* gradient) {
  for (size_t i = 0; i < places(); ++i)
    if (convs_[i].transformed()) dfactors_[i].grow(convs_[i].dfactors_size());
  finish_norm_backward(kSecond, parameters, gradient);
  if (has_shortcut()) finish_norm_backward(kShortcut, parameters, gradient);
  backward_second(parallel, work, parameters, gradient);
  backward_first(parallel, work, before, gradient);
}

template <class T>
void ResidualBlock<T>::add_weight_gradients(Jobs& jobs, T* gradient) const {
  for (size_t i = 0; i < places(); ++i)
    for (int tap = 0; convs_[i].transformed() && tap < Conv<T>::kTaps; ++tap)
      jobs.push_back(
          [this, i, tap, gradient] { convs_[i].finish_gradient(tap, dfactors_[i].data(), gradient + weights_[i]); });
}

template <class T>
void ResidualBlock<T>::prepare_inference(const T* parameters, const T* statistics) {
  for (size_t i = 0; i < places(); ++i) {
    const int count = out();
    const NormPlace& place = norm_places_[i];
    frozen_[i].resize(2 * size_t(count));
    frozen_norm(count, parameters + place.scale, parameters + place.shift, statistics + place.mean,
                statistics + place.variance, frozen_[i].data(), frozen_[i].data() + count);
  }
}

template <class T>
void ResidualBlock<T>::infer(int n, const T* x, T* y, T* const spare[3], Buffer<T>& products) const {
  const size_t rows = size_t(n) * pixels();
  const auto scale = [&](Place i) { return frozen_[i].data(); };
  const auto shift = [&](Place i) { return frozen_[i].data() + out(); };
  convs_[kFirst].forward(n, x, spare[kFirst], products);
  kernels<T>().norm_relu(rows, out(), spare[kFirst], scale(kFirst), shift(kFirst), spare[kFirst]);
  convs_[kSecond].forward(n, spare[kFirst], spare[kSecond], products);
  const bool own = has_shortcut();
  if (own) convs_[kShortcut].forward(n, x, spare[kShortcut], products);
  kernels<T>().norm_add_relu(rows, out(), spare[kSecond], scale(kSecond), shift(kSecond), own ? spare[kShortcut] : x,
                             own ? scale(kShortcut) : nullptr, own ? shift(kShortcut) : nullptr, y);
}

template class ResidualBlock<float>;
template class ResidualBlock<double>;

}  // namespace synpo
