#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tests/hidden/judge.h"
#include "tests/scores/compare.h"

namespace twinbench::scores {
namespace {

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

std::string Summary(const Rows& rows) {
  return "## By set and bench\n\n" + CountsTable(rows) + "\n## By effect: right of those hidden\n\n" +
         FoundTable(rows) + "\n## What falls short\n\n" + WrongTable(rows);
}

}  // namespace twinbench::scores
