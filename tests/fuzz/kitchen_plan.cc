// Plans of kitchens, into the kitchen that they are.
#include <string>

#include "episode.h"
#include "fuzz.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/kitchen_set.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::accepts([&] {
    const Kitchen kitchen = parse_kitchen("fuzz", std::string(fuzz::text(data, size)), "bytes");
    const Kitchen again = parse_kitchen("fuzz", kitchen.text, "bytes");
    fuzz::require(again.text == kitchen.text && again.hash == kitchen.hash, "canonical text reads the same");
    fuzz::play(KitchenSet({kitchen}));
  });
  return 0;
}
