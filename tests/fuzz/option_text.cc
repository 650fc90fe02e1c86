// Command lines: a word a line, read by a table with every kind of option, and each word as the texts that options
// hold. --help and --version, which end the process, are left out.
#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

#include "base/cli/options.h"
#include "draw/plot/curves.h"
#include "engine/device.h"
#include "fuzz.h"
#include "learn/long_run.h"
#include "learn/ppo/ppo_options.h"
#include "learn/recipe.h"
#include "stats/matrix/split.h"

using namespace synpo;

namespace {

bool ends_the_process(const std::string& word) {
  if (!word.starts_with("-") || word == "--") return false;
  if (word.starts_with("--")) return word.starts_with("--h") || word.starts_with("--v");
  return word.find('h') != std::string::npos;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words = {"tool"};
  while (!text.empty() && words.size() < 64) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string word(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    // As the system hands words over.
    if (!ends_the_process(word) && word.find('\0') == std::string::npos) words.push_back(std::move(word));
  }
  return words;
}

template <class Parse>
void tries(Parse parse) {
  try {
    parse();
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::vector<std::string> words = words_of(fuzz::text(data, size));
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  fuzz::accepts(
      [&] {
        Options options("tool", "", "");
        LongRun run(1000, 100);
        RecipeOptions recipe;
        int64_t count = 1;
        double noise = 0;
        std::string choice = "a", text;
        options.integer('n', "count", "N", "", count, INT64_MIN, INT64_MAX)
            .real(0, "noise", "P", "", noise, 0, 1)
            .choice('m', "method", "NAME", "", choice, {"a", "b"})
            .text('p', "pairs", "FILE", "", text);
        run.add_to(options);
        recipe.add_to(options);
        options.parse(int(arguments.size()), arguments.data(), 0, 8);
        recipe.result("synpo");
        recipe.result("sf", Sight::kFeatures);
      },
      {Exit::kUsage});
  fuzz::accepts(
      [&] {
        Options options("tool", "", "");
        PpoOptions ppo;
        ppo.add_to(options);
        options.parse(int(arguments.size()), arguments.data(), 0, 64);
      },
      {Exit::kUsage});
  for (const std::string& word : words) {
    tries([&] { fuzz::require(std::isfinite(parse_number(word)), "a number is finite"); });
    tries([&] { fuzz::require(parse_seconds(word) > 0, "a time is above 0"); });
    tries([&] { parse_count(word); });
    tries([&] {
      const AxisRange range = parse_axis_range(word);
      fuzz::require(!(range.high <= range.low), "a range has an extent");
    });
    tries([&] { parse_curve_mark(word); });
    tries([&] {
      CurvesStyle style;
      parse_curves_size(word, style);
    });
  }
  return 0;
}
