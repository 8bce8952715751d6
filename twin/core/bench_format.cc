#include "twin/core/bench_format.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/core/nearest_key.h"
#include "twin/core/scenario_values.h"

namespace twinbench {
namespace {

/// How well columns fit a bench; more is better.
struct Fit {
  int there = 0, missing = 0;
  bool operator>(const Fit& other) const {
    return there != other.there ? there > other.there : missing < other.missing;
  }
};

/// Columns that every bench has say nothing.
bool IsOwn(const ReadingColumn& column) {
  static const std::vector<ReadingColumn> common = CommonColumns(false);  // constant
  return column.MustBeThere() && std::ranges::find(common, column.name, &ReadingColumn::name) == common.end();
}

Fit FitOf(const BenchFormat& format, const std::function<bool(const ReadingColumn&)>& has) {
  Fit fit;
  for (const ReadingColumn& column : format.columns) {
    if (IsOwn(column)) ++(has(column) ? fit.there : fit.missing);
  }
  return fit;
}

}  // namespace

std::vector<std::string> BenchNames() {
  std::vector<std::string> names;
  for (const BenchFormat* format : BenchFormats()) names.push_back(format->name);
  return names;
}

InputError UnknownBench(const std::string& where, const std::string& name) {
  const std::vector<std::string> names = BenchNames();
  if (name.empty()) return {where, "no bench is named", Alternatives(names)};
  return {where, fmt::format("unknown bench \"{}\"", name),
          fmt::format("{}; the nearest is \"{}\"", Alternatives(names), Nearest(name, names))};
}

const BenchFormat* FindFormat(const std::string& bench) {
  for (const BenchFormat* format : BenchFormats()) {
    if (format->name == bench) return format;
  }
  return nullptr;
}

const BenchFormat& FormatOf(const std::string& bench, const std::string& where) {
  if (const BenchFormat* format = FindFormat(bench)) return *format;
  throw UnknownBench(where, bench);
}

const BenchFormat* FormatByColumns(const std::function<bool(const ReadingColumn&)>& has) {
  const BenchFormat* best = nullptr;
  Fit best_fit;
  for (const BenchFormat* format : BenchFormats()) {
    const Fit fit = FitOf(*format, has);
    if (fit.there > 0 && (!best || fit > best_fit)) {
      best = format;
      best_fit = fit;
    }
  }
  return best;
}

}  // namespace twinbench
