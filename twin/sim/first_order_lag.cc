#include "twin/sim/first_order_lag.h"

#include <cmath>

namespace twinbench::sim {

double FirstOrderLag::Follow(double time_s, double value) {
  const double elapsed_s = time_s - time_s_;
  if (std::isnan(lagged_) || lag_s_ <= 0.0) {
    lagged_ = value;
  } else if (elapsed_s > 0.0) {
    // It chases a ramp: `slope * lag` behind once the transient has gone.
    const double slope = (value - value_) / elapsed_s;
    const double transient = (lagged_ - value_) + slope * lag_s_;
    lagged_ = value - slope * lag_s_ + transient * std::exp(-elapsed_s / lag_s_);
  }
  time_s_ = time_s;
  value_ = value;
  return lagged_;
}

}  // namespace twinbench::sim
