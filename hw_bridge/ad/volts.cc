#include "hw_bridge/ad/volts.h"

#include <algorithm>
#include <cmath>

namespace twinbench::hw {

double VoltsOf(double code, const CalibrationPolynomial& calibration) {
  double volts = 0.0;
  for (auto c = calibration.coefficients_V.rbegin(); c != calibration.coefficients_V.rend(); ++c) {
    volts = volts * (code - calibration.origin) + *c;
  }
  return volts;
}

ChannelBlock CalibratedStatistics(std::span<const std::int16_t> raw, std::size_t channel,
                                  const CalibrationPolynomial& calibration) {
  const double first_V = VoltsOf(raw[channel], calibration);
  ChannelBlock block{.min_V = first_V, .max_V = first_V};
  double n = 0.0, sum_V = 0.0, squares_V2 = 0.0;  // about the first
  for (std::size_t i = channel; i < raw.size(); i += kChannels) {
    const double volts = VoltsOf(raw[i], calibration);
    n += 1.0;
    sum_V += volts - first_V;
    squares_V2 += (volts - first_V) * (volts - first_V);
    block.min_V = std::min(block.min_V, volts);
    block.max_V = std::max(block.max_V, volts);
  }
  block.mean_V = first_V + sum_V / n;
  if (n > 1.0) block.std_V = std::sqrt(std::max(squares_V2 - sum_V * (sum_V / n), 0.0) / (n - 1.0));
  return block;
}

}  // namespace twinbench::hw
