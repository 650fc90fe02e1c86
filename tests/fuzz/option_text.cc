// Command lines: a word a line, read by a table with every kind of option, and each word as the texts that options
// hold. --help and --version, which end the process, are left out.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/cli/options.h"
#include "base/text.h"
#include "draw/colour.h"
#include "draw/plot/curves.h"
#include "engine/device.h"
#include "fuzz.h"
#include "learn/long_run.h"
#include "learn/ppo/ppo_options.h"
#include "learn/recipe.h"
#include "render/render.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/runs.h"
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

// A split of twelve pairs as the words plan it: shares, pairs, names and counts in any order.
void split(const std::vector<std::string>& words) {
  SplitPlan plan;
  plan.envs = {"a", "b", "c", "d"};
  plan.tasks = {"x", "y", "z"};
  int64_t* const counts[] = {&plan.seen, &plan.cover, &plan.p_envs, &plan.p_tasks};
  size_t next = 0;
  for (const std::string& word : words) {
    double share = 0;
    if (word.starts_with("0.") && parse_whole(word, share) && share > 0 && share <= 1) plan.ratio = share;
    if (word.size() == 1 && word[0] >= 'a')
      plan.singles.emplace_back(word[0] < 'x' ? word : "", word[0] < 'x' ? "" : word);
    tries([&] { plan.singles.push_back(split_pair_name(word)); });
    tries([&] {
      const int64_t count = parse_count(word);
      if (count < 0)
        plan.setting = int(1 - std::max<int64_t>(count, -2));
      else
        *counts[next++ % std::size(counts)] = count;
    });
  }
  fuzz::accepts(
      [&] {
        const std::vector<SplitPair> pairs = split_pairs(plan);
        fuzz::require(pairs.size() == 12, "a split has all pairs");
        const auto seen = std::count_if(pairs.begin(), pairs.end(), [](const SplitPair& pair) { return pair.seen; });
        fuzz::require(plan.setting > 1 || plan.seen < 0 || seen == plan.seen, "so many pairs are seen");
      },
      {Exit::kUsage});
}

// What the options of synpo-matrix and synpo-render hold beside numbers and choices, and synpo-render's operands.
void try_texts(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    tries([&] { find_measure(word); });
    tries([&] { find_order(word); });
    tries([&] { find_scheme(word); });
    tries([&] { drawable(word); });
    is_subset(word);
    fuzz::accepts(
        [&] {
          for (const std::string& name : choose_names("--envs", word, {"a", "b", "c"}))
            fuzz::require(name.size() == 1, "a chosen name is one of them");
        },
        {Exit::kUsage});
  }
  fuzz::accepts([&] { labelled_files({words.begin() + 1, words.end()}); }, {Exit::kUsage});
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
  split(words);
  try_texts(words);
  return 0;
}
