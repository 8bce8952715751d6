#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {

EmpiricalSignal::EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel) {
  for (const EmpiricalSettings& signal : empiricals) {
    if (signal.channel != channel) continue;
    for (std::size_t i = 0; i < signal.reading.size(); ++i)
      by_reading_rad_[signal.reading[i]] += signal.value_rad[i];
  }
}

double EmpiricalSignal::At_rad(int reading) const {
  const auto found = by_reading_rad_.find(reading);
  return found == by_reading_rad_.end() ? 0.0 : found->second;
}

}  // namespace twinbench::sim
