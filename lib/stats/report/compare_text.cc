#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "format/tsv.h"
#include "stats/chance.h"
#include "stats/interval.h"
#include "stats/report/compare.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

// A difference of rates in points of per cent, with its sign. 0.0 and 100.0 stand there only for what is exactly that.
std::string points(double difference, int digits = 1) {
  if (std::abs(difference) < 1e-12) difference = 0;
  const std::string size = percent(std::min(1.0, std::abs(difference)), digits);
  return (difference > 0 ? "+" : difference < 0 ? "-" : "") + size;
}

std::string points_range(const Interval& interval) {
  int digits = 1;
  while (digits < 7 && points(interval.low, digits) == points(interval.high, digits)) ++digits;
  return points(interval.low, digits) + " to " + points(interval.high, digits);
}

// "mixed": seen by some runs and not by others.
std::string standing_text(const PairChange& pair) { return pair.standing ? name_of(*pair.standing) : "mixed"; }

std::string temperature(const std::optional<double>& value) { return value ? shortest(*value) : "not known"; }

// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  return text;
}

// Says what the interval of a subset is over, and what it is not.
std::string interval_words(const Comparison& c) {
  const bool one_each = c.runs_a == 1 && c.runs_b == 1;
  std::vector<std::string> over;
  if (!one_each) over.push_back("runs");
  if (c.many_envs) over.push_back("environments");
  if (c.many_tasks) over.push_back("tasks");
  over.push_back("episodes");
  std::string text = "Interval: over " + listed(over) + ": what others of their kind would do";
  text += over.size() == 1 ? "; Newcombe's.\n" : ".\nStudent's t, never narrower than Newcombe's for the episodes.\n";
  if (one_each) text += "One run each: what other seeds would do is not in it.\n";
  if (!c.many_envs) text += "One environment: what others would do is not in it.\n";
  if (!c.many_tasks) text += "One task: what others would do is not in it.\n";
  if (one_each) return text;
  if (c.matched)
    text += "Runs of the same seed are compared with one another.\n";
  else if (c.runs_a == 1 || c.runs_b == 1)
    text += c.runs_a == 1 ? "A has one run, which is taken to vary as B's do.\n"
                          : "B has one run, which is taken to vary as A's do.\n";
  return text;
}

std::string left_out(const Comparison& c) {
  std::string text;
  const auto add = [&](int64_t count, const char* what, const char* why) {
    if (count > 0) text += concat(text.empty() ? "Left out: " : "; ", counted(count, what), why);
  };
  const auto add_both = [&](const LeftOut& left, const char* why) {
    add(left.pairs, "pair", why);
    add(left.rows, "row", concat(" of other pairs", why).c_str());
  };
  add_both(c.only_one, " that only one of the two has");
  add_both(c.other_env, " of another environment that goes by the same name (env_hash)");
  add_both(c.new_to_one, " new to one and known to the other");
  add_both(c.other_seen, " seen by one and unseen by the other");
  add_both(c.other_starts, " without common start states");
  add(c.lost_runs, "run", " that had no start state of the other side");
  return text.empty() ? text : text + ".\n";
}

}  // namespace

std::string comparison_text(const Comparison& c, size_t most) {
  std::string text = "A: " + c.heading_a + "\nB: " + c.heading_b + "\n\n";
  std::vector<std::vector<std::string>> rows = {
      {"", "pairs", "A %", "B %", "B - A", "95 % interval", "better", "alike", "worse"}};
  for (const SubsetChange& s : c.subsets)
    rows.push_back({s.name, std::to_string(s.pairs), percent(s.mean_a), percent(s.mean_b), points(s.change),
                    points_range(s.interval), std::to_string(s.better), std::to_string(s.alike),
                    std::to_string(s.worse)});
  text += table_text(rows) + '\n';
  text += "A, B: success, every pair alike, mean over runs; B - A in points of per cent; better: pairs where B is.\n";
  text += interval_words(c);
  if (c.temperature_a != c.temperature_b)
    text += concat("Actions were drawn at temperature ", temperature(c.temperature_a), " in A, ",
                   temperature(c.temperature_b), " in B.\n");
  text += left_out(c);
  if (most == 0) return text;

  int64_t clear = 0;
  double by_chance = 0;
  for (const PairChange& pair : c.pairs) {
    clear += pair.interval.low > 0 || pair.interval.high < 0;
    const double rate = double(pair.k_a + pair.k_b) / double(pair.n_a + pair.n_b);
    by_chance += newcombe_false_alarms(rate, pair.n_a, pair.n_b);
  }
  rows = {{"env", "task", "", "A", "B", "B - A", "95 % interval"}};
  for (size_t i = 0; i < c.pairs.size() && i < most; ++i) {
    const PairChange& p = c.pairs[i];
    rows.push_back({p.env, p.task, standing_text(p), concat(p.k_a, " of ", p.n_a), concat(p.k_b, " of ", p.n_b),
                    points(p.change()), points_range(p.interval)});
  }
  text += concat("\nChanged most, of ", counted(int64_t(c.pairs.size()), "pair"), ":\n");
  text += table_text(rows, TableFormat::kText, 3) + '\n';
  text += concat("Interval: Newcombe's, for this pair and these runs. ", clear, " of ", c.pairs.size(),
                 clear == 1 ? " leaves out 0" : " leave out 0", "; by chance alone it would be about ",
                 decimal(by_chance, by_chance < 10 ? 1 : 0),
                 ",\nand the largest changes of many are larger than they will be another time.\n");
  return text;
}

void write_comparison(Output& output, const Comparison& c) {
  TsvWriter writer(output);
  for (const char* name : {"level", "subset", "env", "task", "pairs", "successes_a", "episodes_a", "successes_b",
                           "episodes_b", "rate_a", "rate_b", "change", "low", "high"})
    writer.text(name);
  writer.end_row();
  for (const SubsetChange& s : c.subsets) {
    writer.text("subset").text(s.name).text("").text("").whole(s.pairs);
    writer.whole(s.k_a).whole(s.n_a).whole(s.k_b).whole(s.n_b);
    writer.real(s.mean_a).real(s.mean_b).real(s.change).real(s.interval.low).real(s.interval.high).end_row();
  }
  for (const PairChange& p : c.pairs) {
    writer.text("pair").text(standing_text(p)).text(p.env).text(p.task).whole(int64_t{1});
    writer.whole(p.k_a).whole(p.n_a).whole(p.k_b).whole(p.n_b);
    writer.real(p.rate_a()).real(p.rate_b()).real(p.change()).real(p.interval.low).real(p.interval.high).end_row();
  }
}

}  // namespace synpo
