// Tests that run once with the kernels of every target.
#pragma once
#include <gtest/gtest.h>

#include "kernel/kernels.h"

namespace synpo {

template <class Body>
void for_every_target(Body&& body) {
  const std::string before = kernel_target();
  for (const NamedKernels<float>& target : all_kernels<float>()) {
    SCOPED_TRACE(target.name);
    choose_kernels(target.name);
    body(target.name);
  }
  choose_kernels(before);
}

}  // namespace synpo
