// Pairs files: what was read is written as a file that reads the same.
#include "format/pairs.h"

#include <memory>

#include "fuzz.h"
#include "play/episode.h"
#include "play/world_factory.h"
#include "world/world.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::unique_ptr<World> world = open_world("gridworld");
  fuzz::accepts([&] {
    fuzz::Bytes bytes(fuzz::text(data, size));
    const std::vector<PairRow> rows = read_pairs(bytes.input());
    const auto text = [](const std::vector<PairRow>& of) {
      return fuzz::written([&](Output& output) { write_pairs(output, of); });
    };
    const std::string again = text(rows);
    fuzz::Bytes written(again);
    fuzz::require(text(read_pairs(written.input())) == again, "what is written reads the same");
    resolve_pairs(*world, rows, true, "bytes");
  });
  return 0;
}
