#include "nn/layout.h"

#include <gtest/gtest.h>

#include "nn/buffer.h"
#include "nn/layers/norm.h"

namespace synpo {
namespace {

TEST(Layout, TensorsAreAlignedAndApart) {
  Layout layout;
  EXPECT_EQ(layout.add("a", {3, 5}), 0u);
  EXPECT_EQ(layout.add("b", {17}), 16u);
  EXPECT_EQ(layout.add("c", {}), 48u);
  EXPECT_EQ(layout.total(), 64u);
  EXPECT_EQ(layout.find("b")->size, 17u);
  EXPECT_EQ(layout.find("d"), nullptr);
}

}  // namespace
}  // namespace synpo
