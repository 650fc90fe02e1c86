// Loops over channels in vectors as wide as the target's registers, in plain C++. Part of target.cc.
#pragma once
#include <cstring>
#include <type_traits>

namespace synpo::SYNPO_TARGET {

#if defined(__AVX512F__)
constexpr int kVectorBytes = 64;
#elif defined(__AVX__)
constexpr int kVectorBytes = 32;
#else
constexpr int kVectorBytes = 16;
#endif

template <class T>
struct Lanes {
  typedef T Vec __attribute__((vector_size(kVectorBytes)));
  static constexpr int kCount = kVectorBytes / sizeof(T);
};

template <class V>
struct ElementOf {
  using Type = std::remove_cvref_t<decltype(V{}[0])>;
};
template <>
struct ElementOf<float> {
  using Type = float;
};
template <>
struct ElementOf<double> {
  using Type = double;
};

// Unaligned load and store of a Vec or a scalar.
template <class V, class T>
inline V load(const T* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class V, class T>
inline void store(T* to, const V& v) {
  std::memcpy(to, &v, sizeof v);
}

// Calls body(tag, c) for c = 0, Lanes, ... with a vector's tag while a whole vector fits, then with a scalar's tag.
// The body's first argument is a value of the type to compute with.
template <class T, class Body>
inline void for_lanes(int count, Body&& body) {
  using Vec = typename Lanes<T>::Vec;
  int c = 0;
  for (; c + Lanes<T>::kCount <= count; c += Lanes<T>::kCount) body(Vec{}, c);
  for (; c < count; ++c) body(T{}, c);
}

}  // namespace synpo::SYNPO_TARGET
