#include "twin/sim/own_tables.h"

#include <cmath>
#include <map>

namespace twinbench::sim {
namespace {

using Times = std::map<int, double>;  // by number of the reading, s

/// Files keep times to a nanosecond.
bool IsSameTime(double a_s, double b_s) {
  return std::abs(a_s - b_s) <= 2e-9 + 1e-12 * std::abs(a_s);
}

bool IsForeign(const EmpiricalSettings& table, const Times& times_s) {
  if (table.by != "reading") return false;
  for (std::size_t i = 0; i < table.time_s.size(); ++i) {
    const auto taken = times_s.find(table.reading[i]);
    if (taken != times_s.end() && !IsSameTime(taken->second, table.time_s[i])) return true;
  }
  return false;
}

}  // namespace

void LeaveOutForeignTables(const std::vector<Reading>& record, std::vector<EmpiricalSettings>& empiricals) {
  if (empiricals.empty()) return;
  Times times_s;
  for (const Reading& reading : record) times_s[reading.reading] = ToSeconds(reading.time);
  std::erase_if(empiricals, [&](const EmpiricalSettings& table) { return IsForeign(table, times_s); });
}

}  // namespace twinbench::sim
