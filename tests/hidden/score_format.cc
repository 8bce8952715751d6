#include "tests/hidden/score_format.h"

#include <fmt/format.h>

#include <algorithm>

namespace twinbench::hidden {

std::string Percent(const Share& share) {
  return share.of == 0 ? "-" : fmt::format("{:.0f} %", 100.0 * share.count / share.of);
}

std::string WithInterval(const Share& share) {
  if (share.of == 0) return "-";
  const auto [low, high] = share.Interval95();
  return fmt::format("{}/{} = {:.1f} % ({:.1f} to {:.1f})", share.count, share.of, 100.0 * share.count / share.of,
                     100.0 * low, 100.0 * high);
}

std::string TableHead(const std::string& columns) {
  std::string line = "|---|";
  for (auto bars = std::ranges::count(columns, '|'); bars > 0; --bars) line += "---|";
  return "| " + columns + " |\n" + line + "\n";
}

std::string Rows(const Groups& groups, const Row& row) {
  std::string text;
  for (const auto& [key, group] : groups) text += row(key, group);
  return text;
}

Key WithinSet(const Key& key) {
  return [key](const Outcome& o) { return o.set + " | " + key(o); };
}

std::string RowsBySetAnd(const Key& key, const Outcomes& outcomes, const Row& row) {
  const auto all_of_set = [](const Outcome&) { return "all"; };
  return Rows(By(outcomes, WithinSet(key)), row) + Rows(By(outcomes, WithinSet(all_of_set)), row);
}

}  // namespace twinbench::hidden
