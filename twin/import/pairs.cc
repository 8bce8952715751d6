#include "twin/import/layouts.h"

#include <algorithm>
#include <cctype>

#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

constexpr std::string_view kBetween = " \t,;|";

struct Pair {
  std::string_view name, value;
};

/// Empty if the line is anything but pairs, or a single one.
std::vector<Pair> PairsIn(std::string_view line) {
  std::vector<Pair> pairs;
  for (std::size_t at = 0; (at = line.find_first_not_of(kBetween, at)) != std::string_view::npos;) {
    const std::size_t mark = line.find_first_of("=:", at);
    if (mark == std::string_view::npos || mark == at || std::isdigit(static_cast<unsigned char>(line[at]))) return {};
    const std::size_t begin = line.find_first_not_of(" \t", mark + 1);
    if (begin == std::string_view::npos) return {};
    const std::size_t end = std::min(line.find_first_of(kBetween, begin), line.size());
    pairs.push_back({Trimmed(line.substr(at, mark - at)), line.substr(begin, end - begin)});
    if (pairs.back().name.find_first_of(",;|\t") != std::string_view::npos || !CellOf(pairs.back().value, false)) return {};
    at = end;
  }
  return pairs.size() < 2 ? std::vector<Pair>() : pairs;
}

}  // namespace

bool ArePairs(const std::vector<std::string_view>& lines) {
  const auto pairs = std::ranges::count_if(lines, [](std::string_view line) { return !PairsIn(line).empty(); });
  return pairs >= 3 && 10 * pairs > 8 * std::ssize(lines);
}

std::string TableOfPairs(std::string_view text) {
  std::vector<std::string_view> names;
  std::string table;
  Lines lines(text);
  for (std::string_view line; lines.Next(line);) {
    const std::vector<Pair> pairs = PairsIn(line);
    if (pairs.empty()) {
      table += std::string(line) + "\n";
      continue;
    }
    if (names.empty()) {
      for (const Pair& pair : pairs) names.push_back(pair.name);
      for (std::size_t i = 0; i < names.size(); ++i) table += (i > 0 ? "\t" : "") + std::string(names[i]);
      table += "\n";
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto found = std::ranges::find(pairs, names[i], &Pair::name);
      table += (i > 0 ? "\t" : "") + std::string(found == pairs.end() ? "" : found->value);
    }
    table += "\n";
  }
  return table;
}

}  // namespace twinbench::imports
