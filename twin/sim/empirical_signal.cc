#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {
namespace {

/// The values of the kind that the channel has; the other lists are empty.
const std::vector<double>& StatedValues(const EmpiricalSettings& signal) {
  if (!signal.value_m.empty()) return signal.value_m;
  return signal.value_rad.empty() ? signal.value : signal.value_rad;
}

}  // namespace

EmpiricalSignal::EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel) {
  for (const EmpiricalSettings& signal : empiricals) {
    if (signal.channel != channel) continue;
    const std::vector<double>& values = StatedValues(signal);
    if (signal.by == "time") {
      by_time_.emplace_back(signal.time_s, values);
    } else {
      for (std::size_t i = 0; i < values.size(); ++i) by_reading_[signal.reading[i]] += values[i];
    }
  }
}

double EmpiricalSignal::At(int reading, double time_s) const {
  const auto found = by_reading_.find(reading);
  double sum = found == by_reading_.end() ? 0.0 : found->second;
  for (const SampledCurve& table : by_time_) sum += table.At(time_s);
  return sum;
}

}  // namespace twinbench::sim
