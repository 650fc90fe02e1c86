// Passes over rows of channels: batch normalisation, biases, Adam. Part of target.cc.
#pragma once
#include "kernel/kernels.h"
#include "kernel/lanes.h"

namespace synpo::SYNPO_TARGET {

template <class T>
struct Rows {
  static void combine(int terms, const T* const* from, const T* factor, size_t count, T* to, bool accumulate) {
    constexpr size_t kPart = 512;  // of `to`, which thus stays in the first-level cache
    for (size_t begin = 0; begin < count; begin += kPart) {
      const size_t end = begin + kPart < count ? begin + kPart : count;
      for (int t = 0; t < terms; ++t) {
        const T* source = from[t];
        const T by = factor[t];
        if (t == 0 && !accumulate)
          for (size_t i = begin; i < end; ++i) to[i] = by * source[i];
        else
          for (size_t i = begin; i < end; ++i) to[i] += by * source[i];
      }
    }
  }

  static void add_moments(size_t rows, int channels, const T* z, const T* shift, double* sum, double* squares) {
    add_sums(rows, channels, sum, squares, [=](auto tag, size_t at, int c, auto& s, auto& q) {
      using V = decltype(tag);
      const V value = load<V>(z + at) - load<V>(shift + c);
      s += value;
      q += value * value;
    });
  }

  static void norm_relu(size_t rows, int channels, const T* z, const T* scale, const T* offset, T* y) {
    for_rows(rows, channels, [=](auto tag, size_t at, int c) {
      using V = decltype(tag);
      store(y + at, positive_part(normalised<V>(z + at, scale + c, offset + c)));
    });
  }

  static void norm_add_relu(size_t rows, int channels, const T* z, const T* scale, const T* offset, const T* other,
                            const T* other_scale, const T* other_offset, T* y) {
    if (other_scale)
      for_rows(rows, channels, [=](auto tag, size_t at, int c) {
        using V = decltype(tag);
        const V shortcut = normalised<V>(other + at, other_scale + c, other_offset + c);
        store(y + at, positive_part(V(normalised<V>(z + at, scale + c, offset + c) + shortcut)));
      });
    else
      for_rows(rows, channels, [=](auto tag, size_t at, int c) {
        using V = decltype(tag);
        store(y + at, positive_part(V(normalised<V>(z + at, scale + c, offset + c) + load<V>(other + at))));
      });
  }

  static void relu_mask(size_t count, T* d, const T* y) {
    for (size_t i = 0; i < count; ++i) d[i] = y[i] > 0 ? d[i] : T(0);
  }

  static void add_products(size_t rows, int channels, const T* d, const T* z, const T* mean, double* sum,
                           double* products) {
    add_sums(rows, channels, sum, products, [=](auto tag, size_t at, int c, auto& s, auto& p) {
      using V = decltype(tag);
      const V value = load<V>(d + at);
      s += value;
      p += value * (load<V>(z + at) - load<V>(mean + c));
    });
  }

  static void add_masked_products(size_t rows, int channels, const T* d, const T* z, const T* mean, const T* scale,
                                  const T* offset, double* sum, double* products) {
    add_sums(rows, channels, sum, products, [=](auto tag, size_t at, int c, auto& s, auto& p) {
      using V = decltype(tag);
      const V value = masked<V>(d + at, z + at, scale + c, offset + c);
      s += value;
      p += value * (load<V>(z + at) - load<V>(mean + c));
    });
  }

  static void norm_backward(size_t rows, int channels, const T* d, const T* z, const T* from_d, const T* from_z,
                            const T* constant, const T* scale, const T* offset, T* dz) {
    const auto apply = [=](auto tag, const auto& value, size_t at, int c) {
      using V = decltype(tag);
      store(dz + at, V(value * load<V>(from_d + c) + (load<V>(z + at) * load<V>(from_z + c) + load<V>(constant + c))));
    };
    if (scale)
      for_rows(rows, channels, [=](auto tag, size_t at, int c) {
        using V = decltype(tag);
        apply(tag, masked<V>(d + at, z + at, scale + c, offset + c), at, c);
      });
    else
      for_rows(rows, channels, [=](auto tag, size_t at, int c) { apply(tag, load<decltype(tag)>(d + at), at, c); });
  }

  static void add_bias(int rows, int columns, const T* bias, bool relu, T* y) {
    for_rows(size_t(rows), columns, [=](auto tag, size_t at, int c) {
      using V = decltype(tag);
      V value = load<V>(y + at);
      if (bias) value = value + load<V>(bias + c);
      store(y + at, relu ? positive_part(value) : value);
    });
  }

  // In as many sums as the widest target has lanes of floats, what is left over beside zeros, so that all with fused
  // products come to the same bits.
  static T dot(int n, const T* a, const T* b) {
    constexpr int kSums = 16;
    typedef T Sums __attribute__((vector_size(kSums * sizeof(T))));
    Sums sums{};
    const int whole = n - n % kSums;
    for (int i = 0; i < whole; i += kSums) sums += load<Sums>(a + i) * load<Sums>(b + i);
    if (whole < n) {
      Sums rest_a{}, rest_b{};
      std::memcpy(&rest_a, a + whole, size_t(n - whole) * sizeof(T));
      std::memcpy(&rest_b, b + whole, size_t(n - whole) * sizeof(T));
      sums += rest_a * rest_b;
    }
    T sum = 0;
    for (int i = 0; i < kSums; ++i) sum += sums[i];
    return sum;
  }

  static void adam(size_t count, const AdamFactors<T>& f, const T* gradient, T* parameter, T* m, T* v, T* average) {
    const AdamFactors<T> factors = f;
    for (size_t i = 0; i < count; ++i) {
      const T g = gradient[i] + factors.decay * parameter[i];
      m[i] = factors.beta1 * m[i] + (1 - factors.beta1) * g;
      v[i] = factors.beta2 * v[i] + (1 - factors.beta2) * g * g;
      parameter[i] -= factors.rate * m[i] / (root(v[i]) * factors.correction + factors.epsilon);
    }
    if (average)
      for (size_t i = 0; i < count; ++i) average[i] = factors.keep * average[i] + (1 - factors.keep) * parameter[i];
  }

  static void rmsprop(size_t count, const RmsPropFactors<T>& f, const T* gradient, T* parameter, T* v) {
    const RmsPropFactors<T> factors = f;  // what is written can't be any of them
    for (size_t i = 0; i < count; ++i) {
      const T g = factors.scale * gradient[i] + factors.decay * parameter[i];
      v[i] = factors.smoothing * v[i] + (1 - factors.smoothing) * g * g;
      parameter[i] -= factors.rate * g / (root(v[i]) + factors.epsilon);
    }
  }

  // In as many sums as the widest target has lanes, so that all with fused products come to the same bits.
  static double sum_of_squares(size_t count, const T* values) {
    constexpr size_t kSums = 32;
    double sums[kSums] = {};
    const size_t whole = count - count % kSums;
    for (size_t i = 0; i < whole; i += kSums)
      for (size_t j = 0; j < kSums; ++j) sums[j] += double(values[i + j]) * double(values[i + j]);
    for (size_t i = whole; i < count; ++i) sums[i - whole] += double(values[i]) * double(values[i]);
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
  }

 private:
  static float root(float x) { return __builtin_sqrtf(x); }
  static double root(double x) { return __builtin_sqrt(x); }

  template <class V>
  static V positive_part(V v) {
    return v > 0 ? v : V{};
  }
  template <class V>
  static V normalised(const T* z, const T* scale, const T* offset) {
    return load<V>(z) * load<V>(scale) + load<V>(offset);
  }
  // d where what norm_relu made of z is positive, else 0.
  template <class V>
  static V masked(const T* d, const T* z, const T* scale, const T* offset) {
    return normalised<V>(z, scale, offset) > 0 ? load<V>(d) : V{};
  }

  // Calls body(tag, place, channel) for every vector of every row.
  template <class Body>
  static void for_rows(size_t rows, int channels, Body&& body) {
    for (size_t row = 0; row < rows; ++row)
      for_lanes<T>(channels, [&](auto tag, int c) { body(tag, row * channels + c, c); });
  }

  // Sums of two quantities over rows, per channel: body(tag, place, channel, first, second) adds one row's. Within
  // blocks of 64 rows the sums are taken in T, from block to block in double.
  template <class Body>
  static void add_sums(size_t rows, int channels, double* first, double* second, Body&& body) {
    constexpr size_t kBlock = 64;
    for (size_t begin = 0; begin < rows; begin += kBlock) {
      const size_t end = begin + kBlock < rows ? begin + kBlock : rows;
      for_lanes<T>(channels, [&](auto tag, int c) {
        using V = decltype(tag);
        V a{}, b{};
        for (size_t row = begin; row < end; ++row) body(tag, row * channels + c, c, a, b);
        add_lanes(first + c, a);
        add_lanes(second + c, b);
      });
    }
  }

  // sums[i] += lane i of v.
  template <class V>
  static void add_lanes(double* sums, const V& v) {
    T lanes[sizeof(V) / sizeof(T)];
    store(lanes, v);
    for (size_t i = 0; i < sizeof(V) / sizeof(T); ++i) sums[i] += lanes[i];
  }
};

}  // namespace synpo::SYNPO_TARGET
