#include "twin/report/page/readings_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/bench_format.h"
#include "twin/core/number_text.h"
#include "twin/report/page/named_numbers.h"

namespace twinbench::report {
namespace {

constexpr std::size_t kMostReadings = 20000;

/// Every n-th reading, so that a page stays small.
std::vector<Reading> Thinned(const std::vector<Reading>& readings) {
  const std::size_t step = (readings.size() + kMostReadings - 1) / kMostReadings;
  std::vector<Reading> few;
  for (std::size_t k = 0; k < readings.size(); k += std::max<std::size_t>(step, 1)) few.push_back(readings[k]);
  return few;
}

bool Varies(const std::vector<double>& values) {
  const auto is_there = [](double v) { return std::isfinite(v); };
  const auto first = std::find_if(values.begin(), values.end(), is_there);
  return std::any_of(first, values.end(), [&](double v) { return is_there(v) && v != *first; });
}

PageColumns::Column ColumnOf(const ReadingColumn& column, const std::vector<Reading>& readings) {
  const auto [name, unit] = NameAndUnit(column.name);
  PageColumns::Column made{name, unit, {}};
  for (const Reading& reading : readings) made.values.push_back(ParseNumber(column.print(reading)).value_or(kNaN));
  return made;
}

PageColumns ColumnsOf(const std::vector<Reading>& readings, const BenchFormat& format) {
  PageColumns all{"Readings", "", {}};
  std::vector<double> setup;
  for (const Reading& reading : readings) setup.push_back(reading.setup);
  for (const ReadingColumn& column : format.columns) {
    if (!column.print || !column.number) continue;
    PageColumns::Column made = ColumnOf(column, readings);
    if (!Varies(made.values)) continue;
    if (column.IsShown() && all.y == 1 && !all.columns.empty()) all.y = static_cast<int>(all.columns.size());
    all.columns.push_back(std::move(made));
  }
  all.columns.push_back({"mounting", "", setup});
  all.group = static_cast<int>(all.columns.size()) - 1;
  return all;
}

/// Shown columns by what they are called without "x" or "y": the places of spots.
std::map<std::string, std::pair<const ReadingColumn*, const ReadingColumn*>> PairsOf(const BenchFormat& format) {
  std::map<std::string, std::pair<const ReadingColumn*, const ReadingColumn*>> pairs;
  for (const ReadingColumn& column : format.columns) {
    const std::string name = NameAndUnit(column.name).name;
    const bool is_x = name.ends_with(" x");
    if (!column.IsShown() || !(is_x || name.ends_with(" y"))) continue;
    auto& pair = pairs[name.substr(0, name.size() - 2)];
    (is_x ? pair.first : pair.second) = &column;
  }
  std::erase_if(pairs, [](const auto& pair) { return !pair.second.first || !pair.second.second; });
  return pairs;
}

Figure TrackOf(const std::string& name, const ReadingColumn& x, const ReadingColumn& y, const std::vector<Reading>& readings) {
  Figure figure{FigureForm::kTrack, "Track on " + name, "a point a reading",
                {NameAndUnit(x.name).name, NameAndUnit(x.name).unit}, {NameAndUnit(y.name).name, NameAndUnit(y.name).unit}, {}};
  std::map<int, FigureSeries> setups;
  for (const Reading& reading : readings) {
    const auto at_x = ParseNumber(x.print(reading)), at_y = ParseNumber(y.print(reading));
    if (!at_x || !at_y) continue;
    FigureSeries& series = setups[reading.setup];
    series.x.push_back(*at_x);
    series.y.push_back(*at_y);
  }
  for (auto& [setup, series] : setups) {
    series.name = fmt::format("mounting {}", setup);
    figure.series.push_back(std::move(series));
  }
  return figure;
}

}  // namespace

PageSection ReadingsSection(const std::vector<Reading>& readings, const std::string& bench) {
  PageSection section{"Readings", "", {}};
  const BenchFormat* format = FindFormat(bench);
  if (!format || readings.empty()) return section;
  const std::vector<Reading> shown = Thinned(readings);
  PageColumns columns = ColumnsOf(shown, *format);
  if (shown.size() < readings.size()) columns.note = fmt::format("{} of {} readings, evenly chosen", shown.size(), readings.size());
  if (columns.columns.size() > 2) section.blocks.emplace_back(std::move(columns));
  for (const auto& [name, pair] : PairsOf(*format)) {
    if (Figure track = TrackOf(name, *pair.first, *pair.second, shown); !track.series.empty()) section.blocks.emplace_back(std::move(track));
  }
  return section;
}

}  // namespace twinbench::report
