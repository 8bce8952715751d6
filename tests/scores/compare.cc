#include "tests/scores/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

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

}  // namespace twinbench::scores
