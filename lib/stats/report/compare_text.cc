#include <cmath>

#include "base/error.h"
#include "format/tsv.h"
#include "stats/report/compare.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

// A difference of rates in points of per cent, with its sign.
std::string points(double difference) {
  const std::string text = decimal(difference * 100, 1);
  return difference > 0 && text != "0.0" ? "+" + text : text;
}

std::string points_range(const Interval& interval) {
  return std::isnan(interval.low) ? "-" : points(interval.low) + " to " + points(interval.high);
}

std::string left_out(const Comparison& c) {
  std::string text;
  const auto add = [&](int64_t count, const char* what, const char* why) {
    if (count > 0) text += concat(text.empty() ? "Left out: " : "; ", count, ' ', what, count == 1 ? "" : "s", why);
  };
  add(c.only_one, "pair", " that only one of the two has");
  add(c.other_seen, "pair", " seen by one and unseen by the other");
  add(c.other_starts, "pair", " without common start states");
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
  const bool one_each = c.runs_a == 1 && c.runs_b == 1;
  text += concat("Interval: bootstrap over ", one_each ? "pairs" : "runs and pairs", ", ", c.plan.samples,
                 " samples, seed ", c.plan.seed);
  if (one_each)
    text += "; one run each, so what other seeds would do is not in it.\n";
  else
    text += c.matched ? "; runs of the same seed drawn together.\n" : "; each side's runs drawn on their own.\n";
  text += left_out(c);
  if (most == 0) return text;

  int64_t clear = 0;
  for (const PairChange& pair : c.pairs) clear += pair.interval.low > 0 || pair.interval.high < 0;
  rows = {{"env", "task", "", "A", "B", "B - A", "95 % interval"}};
  for (size_t i = 0; i < c.pairs.size() && i < most; ++i) {
    const PairChange& p = c.pairs[i];
    rows.push_back({p.env, p.task, p.seen ? "seen" : "unseen", concat(p.k_a, " of ", p.n_a),
                    concat(p.k_b, " of ", p.n_b), points(p.change()), points_range(p.interval)});
  }
  text += concat("\nChanged most, of ", c.pairs.size(), c.pairs.size() == 1 ? " pair:\n" : " pairs:\n");
  text += table_text(rows, TableFormat::kText, 3) + '\n';
  text += concat("Interval: Newcombe's, for this pair and these runs. ", clear, " of ", c.pairs.size(),
                 clear == 1 ? " leaves out 0" : " leave out 0", "; by chance alone it would be about 1 in 20,\n",
                 "and the largest changes of many are larger than they will be another time.\n");
  return text;
}

void write_comparison(Output& output, const Comparison& c) {
  TsvWriter writer(output);
  for (const char* name : {"level", "subset", "env", "task", "pairs", "successes_a", "episodes_a", "successes_b",
                           "episodes_b", "rate_a", "rate_b", "change", "low", "high"})
    writer.text(name);
  writer.end_row();
  for (const SubsetChange& s : c.subsets) {
    int64_t k_a = 0, n_a = 0, k_b = 0, n_b = 0;
    for (const PairChange& p : c.pairs) {
      if (!belongs({p.env, p.task, p.seen, p.part, {}}, s.name)) continue;
      k_a += p.k_a;
      n_a += p.n_a;
      k_b += p.k_b;
      n_b += p.n_b;
    }
    writer.text("subset").text(s.name).text("").text("").whole(s.pairs).whole(k_a).whole(n_a).whole(k_b).whole(n_b);
    writer.real(s.mean_a).real(s.mean_b).real(s.change).real(s.interval.low).real(s.interval.high).end_row();
  }
  for (const PairChange& p : c.pairs) {
    writer.text("pair").text(p.seen ? "seen" : "unseen").text(p.env).text(p.task).whole(int64_t{1});
    writer.whole(p.k_a).whole(p.n_a).whole(p.k_b).whole(p.n_b);
    writer.real(p.rate_a()).real(p.rate_b()).real(p.change()).real(p.interval.low).real(p.interval.high).end_row();
  }
}

}  // namespace synpo
