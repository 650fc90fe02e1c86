// synpo-render of a build without OpenCV (make DRAW=no): says so, whatever it is asked.
#include "base/cli/options.h"
#include "base/error.h"

using namespace synpo;

namespace {

int body(int argc, char** argv) {
  constexpr char kMissing[] = "this build draws no pictures: it was made without OpenCV (make DRAW=no)";
  if (argc >= 2 && argv[1][0] != '-') fail(Exit::kUnavailable, kMissing);
  Options options("synpo-render", "", kMissing);
  options.parse(argc, argv);
  fail(Exit::kUnavailable, kMissing);
}

}  // namespace

int main(int argc, char** argv) { return run_tool("synpo-render", argc, argv, body); }
