#include "twin/import/seconds_of_arc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// "s" and "ms" are times whatever they stand behind, "min" may be the least of several.
std::string_view OfArc(const std::string& unit) {
  constexpr std::array kSeconds = std::to_array<std::string_view>({"sec", "secs", "second", "seconds", "sek", "sekunden"});
  constexpr std::array kMinutes = std::to_array<std::string_view>({"minute", "minutes", "minuten"});
  const std::string small = SmallLetters(unit);
  if (std::ranges::count(kSeconds, small) > 0) return "arcsec";
  return std::ranges::count(kMinutes, small) > 0 ? "arcmin" : "";
}

bool IsAnAngleByName(const std::string& name) {
  const bool is_time = ClearnessBy(name, {"time", "zeit", "clock", "timestamp", "dwell", "delay", "lag", "latency", "duration", "dauer", "elapsed", "settling", "exposure",
                                          "period", "interval", "integration", "temps", "tiempo", "tempo"}) > 0;
  const bool is_angle = IsCalledError(name) || Clearness(name, Speaks::kReference) > 0 || Clearness(name, Speaks::kDevice) > 0 ||
                        ClearnessBy(name, {"autocollimator", "collimator", "autokollimator", "akf", "ablesung", "anzeige", "readings", "certificate", "kalibrierwert", "winkel",
                                           "forward", "reverse", "x", "y", "lecture", "lectura", "lettura"}) > 0;
  return is_angle && !is_time;
}

}  // namespace

void TakeSecondsOfArc(Track& track, std::vector<std::string>& remarks) {
  for (Column& column : track.columns) {
    const std::string_view of_arc = OfArc(column.unit);
    if (of_arc.empty() || !column.IsNumber() || !IsAnAngleByName(column.name)) continue;
    const std::string remark = fmt::format("\"{}\" is no time: its \"{}\" is taken as {}", column.name, column.unit, of_arc);
    if (std::ranges::find(remarks, remark) == remarks.end()) remarks.push_back(remark);
    column.unit = of_arc;
  }
}

}  // namespace twinbench::imports
