// A checkpoint without what only training needs.
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "finetune/finetune.h"
#include "format/checkpoint.h"

using namespace synpo;

int strip(int argc, char** argv) {
  std::string input = "-", output = "-";
  bool half = false, force = false;
  Options options("synpo-finetune strip", "[OPTION]... [CHECKPOINT] > CHECKPOINT",
                  "Leaves out of a checkpoint what only training needs.");
  options.text('c', "checkpoint", "FILE", "the checkpoint", input)
      .flag(0, "half", "weights in half precision (F16): half the size, the same policy to three digits", half)
      .text('o', "output", "FILE", "write the checkpoint to FILE", output)
      .flag('f', "force", "write the checkpoint to a terminal", force);
  const std::vector<std::string> operands = options.parse(argc, argv, 0, 1);
  if (!operands.empty()) {
    if (options.given("checkpoint")) fail(Exit::kUsage, "-c and an operand exclude each other");
    input = operands[0];
  }
  Checkpoint checkpoint = load_checkpoint(input);
  checkpoint.strip();
  if (half) checkpoint.halve();
  write_file(output, format_checkpoint(checkpoint), Output::Kind::kBinary, force);
  return 0;
}
