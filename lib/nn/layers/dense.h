// Fully connected layers over rows, on all threads. Weights are [in, out].
#pragma once
#include "base/parallel.h"

namespace synpo {

// y [rows, out] = x [rows, in] w + b, then ReLU where `relu`. b may be null.
template <class T>
void dense_forward(Parallel& parallel, int rows, int in, int out, const T* x, const T* w, const T* b, bool relu, T* y);

// From dy, the gradient of y: dx (may be null) = or, where add_dx, +=; dw and db (may be null) +=. Where the layer had
// a ReLU, pass y: dy is masked in place first.
template <class T>
void dense_backward(Parallel& parallel, int rows, int in, int out, const T* x, const T* w, const T* relu_y, T* dy,
                    T* dx, bool add_dx, T* dw, T* db);

}  // namespace synpo
