#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {

EmpiricalSignal::EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel) {
  for (const EmpiricalSettings& signal : empiricals) {
    if (signal.channel != channel) continue;
    for (const std::vector<double>& values : {signal.value_m, signal.value_rad, signal.value}) {
      for (std::size_t i = 0; i < values.size(); ++i) by_reading_[signal.reading[i]] += values[i];
    }
  }
}

double EmpiricalSignal::At(int reading) const {
  const auto found = by_reading_.find(reading);
  return found == by_reading_.end() ? 0.0 : found->second;
}

}  // namespace twinbench::sim
