#pragma once

#include "twin/core/reading.h"

namespace twinbench::sim {

/// What follows a quantity with one time constant: a post behind the temperature of its room. Starts in
/// equilibrium.
class FirstOrderLag {
 public:
  /// @param lag_s  0: it follows at once.
  explicit FirstOrderLag(double lag_s) : lag_s_(lag_s) {}

  /// Goes on to a time at which the quantity has this value; exact where it has run linearly since the call before.
  /// @param time_s  Not before that of the call before.
  /// @return what follows, in the unit of `value`.
  double Follow(double time_s, double value);

 private:
  double lag_s_;
  double time_s_ = kNaN, value_ = kNaN, lagged_ = kNaN;
};

}  // namespace twinbench::sim
