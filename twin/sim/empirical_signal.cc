#include "twin/sim/empirical_signal.h"

#include <iterator>

namespace twinbench::sim {
namespace {

/// The values of the kind that the channel has; the other lists are empty.
std::vector<double> ValuesOf(const EmpiricalSettings& signal) {
  std::vector<double> values = signal.value_m;
  for (const auto& more : {signal.value_rad, signal.value}) values.insert(values.end(), more.begin(), more.end());
  return values;
}

/// Straight between two times; before the first and behind the last as it is there, for a jump was never seen.
double Between(const std::map<double, double>& table, double time_s) {
  const auto behind = table.lower_bound(time_s);
  if (behind == table.end()) return std::prev(behind)->second;
  if (behind->first == time_s || behind == table.begin()) return behind->second;
  const auto before = std::prev(behind);
  const double share = (time_s - before->first) / (behind->first - before->first);
  return before->second + share * (behind->second - before->second);
}

}  // namespace

EmpiricalSignal::EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel) {
  for (const EmpiricalSettings& signal : empiricals) {
    if (signal.channel != channel) continue;
    const std::vector<double> values = ValuesOf(signal);
    if (signal.by == "time") by_time_.emplace_back();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (signal.by == "time") {
        by_time_.back()[signal.time_s[i]] = values[i];
      } else {
        by_reading_[signal.reading[i]] += values[i];
      }
    }
  }
}

double EmpiricalSignal::At(int reading, double time_s) const {
  const auto found = by_reading_.find(reading);
  double sum = found == by_reading_.end() ? 0.0 : found->second;
  for (const auto& table : by_time_) sum += Between(table, time_s);
  return sum;
}

}  // namespace twinbench::sim
