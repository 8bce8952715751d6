#include "tests/scores/sets.h"

#include "tests/hidden/judge.h"

namespace twinbench::scores {
namespace {

using OfMarks = std::array<Changes, kMarkNames.size()>;

void Add(const Row& now, const Row& before, OfMarks& changes) {
  for (std::size_t k = 0; k < changes.size(); ++k) {
    if (!now.marks[k] || !before.marks[k] || *now.marks[k] == *before.marks[k]) continue;
    const std::string words = fmt::format("{} {} {}: {}", now.set, now.bench, now.name, now.answer);
    (IsGood(k, *now.marks[k]) ? changes[k].won : changes[k].lost).push_back(words);
  }
}

std::string Line(const std::string& of, std::size_t mark, const Changes& c) {
  return fmt::format("  {:<26} {:<18} right -> wrong {:3}, wrong -> right {:3}, p = {:.4f}{}\n", of,
                     kMarkNames[mark], c.lost.size(), c.won.size(), c.p(), c.IsWorse() ? "  WORSE" : "");
}

std::string Lines(const std::string& of, const OfMarks& changes) {
  std::string text;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    if (!changes[k].lost.empty() || !changes[k].won.empty()) text += Line(of, k, changes[k]);
  }
  return text;
}

std::string Listed(const std::string& title, const std::vector<std::string>& cases) {
  std::string text = cases.empty() ? "" : title + "\n";
  for (const std::string& one : cases) text += "  " + one + "\n";
  return text;
}

hidden::Share ShareOf(const Rows& rows, Mark mark) {
  hidden::Share share;
  for (const Row& row : rows) {
    share.of += row.marks[mark] ? 1 : 0;
    share.count += row.marks[mark].value_or(false) ? 1 : 0;
  }
  return share;
}

std::string Counted(const Rows& rows, Mark mark) {
  const hidden::Share share = ShareOf(rows, mark);
  return share.of == 0 ? "" : fmt::format("{}/{}", share.count, share.of);
}

std::string WithInterval(const Rows& rows) {
  const hidden::Share share = ShareOf(rows, kRight);
  if (share.of == 0) return "";
  const auto [lower, upper] = share.Interval95();
  return fmt::format("{}/{}: {:.0f} to {:.0f} %", share.count, share.of, 100.0 * lower, 100.0 * upper);
}

double Seconds(const Rows& rows) {
  double sum = 0.0;
  for (const Row& row : rows) sum += row.seconds;
  return sum;
}

std::string CountsRow(const std::string& set, const std::string& bench, const Rows& rows) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.0f} |\n", set, bench, WithInterval(rows),
                     Counted(rows, kSureWrong), Counted(rows, kSecondSilent), Counted(rows, kSecondRunSilent),
                     Counted(rows, kGainRight), Seconds(rows));
}

using Groups = std::map<std::string, Rows>;

std::string CountsTable(const Rows& rows) {
  std::vector<std::string> sets;  // in their order
  std::map<std::string, Groups> benches;
  for (const Row& row : rows) {
    if (!benches.contains(row.set)) sets.push_back(row.set);
    benches[row.set][row.bench].push_back(row);
    benches[row.set]["all"].push_back(row);
  }
  std::string text =
      "| set | bench | right | sure and wrong | second diagnosis silent | second run silent | gain right | CPU s "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const std::string& set : sets) {
    for (const auto& [bench, group] : benches[set]) {
      if (bench != "all") text += CountsRow(set, bench, group);
    }
    if (benches[set].size() > 2) text += CountsRow("**" + set + "**", "all", benches[set]["all"]);
  }
  return text + CountsRow("**all**", "all", rows);
}

/// "psd_gain psd_a_x": psd_gain. Of several causes, and of those without a name, the words as they are.
std::string EffectOf(const Row& row) {
  if (row.set != "hidden" && row.set != "challenge") return "";
  const bool is_one =
      row.hidden != "none" && row.hidden.find(" + ") == std::string::npos && !row.hidden.starts_with("unlisted");
  if (!is_one) return "";
  return row.hidden.substr(0, row.hidden.find(' ')) +
         (row.name.starts_with("clamped") ? " (clamped at another time)" : "");
}

std::string FoundTable(const Rows& rows) {
  std::map<std::string, Groups> effects;
  for (const Row& row : rows) {
    const std::string effect = EffectOf(row);
    if (!effect.empty()) effects[row.bench][effect].push_back(row);
  }
  std::string text;
  for (const auto& [bench, group] : effects) {
    text += "* " + bench + ":";
    std::string separator = " ";
    for (const auto& [effect, cases] : group) {
      text += separator + effect + " " + Counted(cases, kRight);
      separator = ", ";
    }
    text += "\n";
  }
  return text;
}

std::string Shortcomings(const Row& row) {
  std::string text;
  for (std::size_t k = 0; k < kMarkNames.size(); ++k) {
    if (!row.marks[k] || IsGood(k, *row.marks[k])) continue;
    text += (text.empty() ? "" : ", ") +
            (k == kSureWrong ? std::string("sure and wrong") : std::string("not ") + kMarkNames[k]);
  }
  return text;
}

std::string WrongTable(const Rows& rows) {
  std::string text = "| set | case | hidden | falls short | answer |\n|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const std::string shortcomings = Shortcomings(row);
    if (shortcomings.empty()) continue;
    std::string answer = row.answer;
    std::ranges::replace(answer, '|', '/');
    text += fmt::format("| {} {} | {} | {} | {} | {} |\n", row.set, row.bench, row.name, row.hidden, shortcomings,
                        answer.substr(0, 250));
  }
  return text;
}

}  // namespace

double McNemar(int lost, int won) {
  return std::min(1.0, 2.0 * hidden::ProbabilityOfAtMost(std::min(lost, won), lost + won, 0.5));
}

bool Comparison::IsWorse() const {
  return std::ranges::any_of(all, &Changes::IsWorse);
}

Comparison Compare(const Rows& now, const Rows& before) {
  std::map<std::string, const Row*> earlier;
  for (const Row& row : before) earlier[row.Key()] = &row;
  Comparison comparison;
  std::map<std::string, OfMarks> of_bench;
  for (const Row& row : now) {
    const auto found = earlier.find(row.Key());
    if (found == earlier.end()) {
      ++comparison.only_now;
      continue;
    }
    Add(row, *found->second, comparison.all);
    Add(row, *found->second, of_bench[row.bench]);
    earlier.erase(found);
  }
  comparison.only_before = static_cast<int>(earlier.size());
  comparison.of_bench.assign(of_bench.begin(), of_bench.end());
  return comparison;
}

std::string InWords(const Comparison& comparison) {
  std::string text =
      fmt::format("Cases only now: {}, only before: {}\n", comparison.only_now, comparison.only_before);
  text += Lines("all", comparison.all);
  for (const auto& [bench, changes] : comparison.of_bench) text += Lines(bench, changes);
  for (std::size_t k = 0; k < kMarkNames.size(); ++k) {
    text += Listed(fmt::format("{}: right -> wrong", kMarkNames[k]), comparison.all[k].lost);
    text += Listed(fmt::format("{}: wrong -> right", kMarkNames[k]), comparison.all[k].won);
  }
  return text;
}

std::string Summary(const Rows& rows) {
  return "## By set and bench\n\n" + CountsTable(rows) + "\n## By effect: right of those hidden\n\n" +
         FoundTable(rows) + "\n## What falls short\n\n" + WrongTable(rows);
}

}  // namespace twinbench::scores
