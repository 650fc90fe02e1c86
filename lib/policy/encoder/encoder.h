// An encoder gives the state feature psi(s) of an observation: it is a network of its own for each kind of sight
// (world.h).
#pragma once
#include <cstddef>
#include <cstdint>

#include "base/parallel.h"

namespace synpo {

template <class T>
class Encoder {
 public:
  virtual ~Encoder() = default;

  virtual size_t observation_size() const = 0;  // bytes of a state

  virtual void initialise(uint64_t seed, T* parameters, T* statistics) const = 0;

  // psi [n, feature] of observations, one after the other. Keeps what backward() needs, which may be where the
  // observations stand: they have to live as long. Memory grows with n. Where `frozen`, normalisation takes the running
  // statistics, which stay.
  virtual void forward(Parallel& parallel, int n, const uint8_t* observations, const T* parameters, T* statistics,
                       T* psi, bool frozen) = 0;
  // Writes the gradients of the encoder's parameters; dpsi, which may be overwritten, is the gradient of the last
  // forward()'s psi.
  virtual void backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) = 0;

  virtual void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) = 0;
  // One thread's part, n at most Policy::kInferenceUnit.
  virtual void infer(int thread, int n, const uint8_t* observations, T* psi) = 0;

  // Multiply-adds of one state's forward pass, as executed.
  virtual size_t multiply_adds() const = 0;
};

}  // namespace synpo
