// Loops over channels in vectors of 64 bytes, in plain C++: the compiler maps them to whatever the machine has.
#pragma once
#include <cstring>

namespace synpo {

template <class T>
struct Lanes {
  typedef T Vec __attribute__((vector_size(64)));
  static constexpr int kCount = 64 / sizeof(T);
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

// Sum of a[i] * b[i]; the order of the additions depends on n alone.
template <class T>
inline T dot(int n, const T* a, const T* b) {
  typename Lanes<T>::Vec sums{};
  T sum = 0;
  for_lanes<T>(n, [&](auto tag, int c) {
    using V = decltype(tag);
    if constexpr (sizeof(V) > sizeof(T))
      sums += load<V>(a + c) * load<V>(b + c);
    else
      sum += a[c] * b[c];
  });
  for (int i = 0; i < Lanes<T>::kCount; ++i) sum += sums[i];
  return sum;
}

}  // namespace synpo
