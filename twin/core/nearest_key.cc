#include "twin/core/nearest_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace twinbench {
namespace {

/// Units that somebody may write: those of the known keys, and others that are usual.
std::set<std::string> UnitSuffixes(const std::vector<KnownKey>& known) {
  std::set<std::string> suffixes = {"m",      "cm", "mm",  "um",  "nm", "pm", "rad",  "mrad",   "urad", "deg",
                                    "arcsec", "V",  "mV",  "uV",  "W",  "mW", "s",    "ms",     "us",   "min",
                                    "h",      "Hz", "kHz", "MHz", "K",  "mK", "degC", "percent"};
  for (const KnownKey& key : known) suffixes.insert(key.suffix);
  return suffixes;
}

/// Whether `key` is that known key with another unit or with none.
bool DiffersInUnit(const std::string& key, const KnownKey& known, const std::set<std::string>& suffixes) {
  if (known.suffix.empty()) return false;
  if (key == known.name) return true;
  return key.starts_with(known.name + "_") && suffixes.contains(key.substr(known.name.size() + 1));
}

std::vector<std::string> SameKeyElsewhere(const std::string& key, const std::vector<KnownKey>& known) {
  std::vector<std::string> paths;
  for (const KnownKey& candidate : known) {
    if (candidate.Key() == key) paths.push_back(candidate.Path());
  }
  return paths;
}

std::vector<std::string> Paths(const std::vector<KnownKey>& known) {
  std::vector<std::string> paths;
  for (const KnownKey& key : known) paths.push_back(key.Path());
  return paths;
}

}  // namespace

int EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> distance(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) distance[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) distance[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      distance[i][j] = std::min({replaced, distance[i - 1][j] + 1, distance[i][j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
    }
  }
  return distance[a.size()][b.size()];
}

std::string Nearest(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kTellsOne = 3;  // letters: whoever writes the beginning of a name means it, though a shorter name is fewer letters away
  const auto rank = [&](const std::string& name) {
    const bool begins_so = word.size() >= kTellsOne && name.starts_with(word);
    return std::pair(!begins_so, EditDistance(word, name));
  };
  const auto nearest = std::ranges::min_element(known, {}, rank);
  return nearest == known.end() ? std::string() : *nearest;
}

InputError UnknownKey(const std::string& where, const std::string& table, const std::string& key,
                      const std::vector<KnownKey>& known) {
  const std::string path = table.empty() ? key : table + "." + key;
  const auto suffixes = UnitSuffixes(known);
  for (const KnownKey& candidate : known) {
    if (candidate.table == table && DiffersInUnit(key, candidate, suffixes))
      return {where, fmt::format("the key {} has the wrong unit", path), candidate.Path()};
  }
  const auto elsewhere = SameKeyElsewhere(key, known);
  const std::string nearest = Nearest(path, elsewhere.empty() ? Paths(known) : elsewhere);
  return {where, fmt::format("unknown key {}", path), fmt::format("a known one; the nearest is {}", nearest)};
}

}  // namespace twinbench
