#include "base/hash.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Hash, IsFnv1a) {
  EXPECT_EQ(Hash().value(), 0xcbf29ce484222325u);
  EXPECT_EQ(Hash().add("a").value(), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(Hash().add("foobar").value(), 0x85944171f73967e8u);
  EXPECT_EQ(Hash::resume(Hash().add("foo").value()).add("bar").value(), 0x85944171f73967e8u);
}

TEST(Hash, HexBothWays) {
  for (const uint64_t value : {0ull, 0x85944171f73967e8ull, ~0ull}) EXPECT_EQ(parse_hex(hex(value)), value);
  EXPECT_EQ(hex(0xab), "00000000000000ab");
  for (const char* bad : {"", "ab", "00000000000000AB", "00000000000000ag", "00000000000000abc"})
    EXPECT_EQ(thrown([&] { parse_hex(bad); }),
              concat("65 found '", bad, "', expected a hash of 16 hexadecimal digits"));
}

}  // namespace
}  // namespace synpo
