#pragma once

#include <complex>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// The error that the scale of a device was made with: orders 1 to [device] graduation_orders, each with parts drawn
/// from a normal distribution whose size falls with the order. It belongs to the bench (seed), not to the run.
class Graduation {
 public:
  explicit Graduation(const Scenario& scenario);

  /// Shows too much where positive; by the angle of the scale.
  double Error_rad(double device_rad) const;

 private:
  std::vector<std::complex<double>> order_rad_;  // [k - 1]: C_k of Re sum C_k exp(j k angle)
};

}  // namespace twinbench::sim
