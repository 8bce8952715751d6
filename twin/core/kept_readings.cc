#include "twin/core/kept_readings.h"

#include <algorithm>
#include <cmath>

namespace twinbench {

/// A record has quantities by name, none that is not available, and no -0.0 in a column.
void KeptReadings::Append(const Reading& reading, const Acquisition& /*block*/) {
  Reading& r = readings_.emplace_back(reading);
  std::ranges::stable_sort(r.quantities, {}, &std::pair<std::string, double>::first);
  std::erase_if(r.quantities, [](const auto& quantity) { return !std::isfinite(quantity.second); });
  for (double* value : {&r.target_rad, &r.reference_rad, &r.dwell_s, &r.temperature_degC, &r.autocollimator_yaw_rad,
                        &r.autocollimator_tilt_rad, &r.measured_rad, &r.velocity_rad_s, &r.head_rad, &r.interferometer_rad})
    *value += 0.0;
  for (std::size_t c = 0; c < r.mean_V.size(); ++c) {
    r.mean_V[c] += 0.0;
    r.std_V[c] += 0.0;
  }
}

}  // namespace twinbench
