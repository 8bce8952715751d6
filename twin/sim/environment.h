#pragma once

#include <vector>

#include "twin/core/sampled_curve.h"
#include "twin/core/scenario.h"
#include "twin/core/stream.h"
#include "twin/core/time.h"

namespace twinbench::sim {

/// The room's temperature as a function of time: a level, a drift, a swing, a random walk and a record from a file.
class Environment {
 public:
  /// @throws InputError if the temperature file cannot be read.
  Environment(const EnvironmentSettings& settings, std::uint64_t seed);

  /// True temperature; `now` may jump back and forth.
  double Temperature_degC(Time now);
  /// What the bench's thermometer shows: the true temperature plus its noise.
  double Measure_degC(Time now);
  double AboveReference_K(Time now) { return Temperature_degC(now) - settings_.reference_degC; }

 private:
  double RandomWalk_K(double t_s);

  EnvironmentSettings settings_;
  Stream walk_steps_;
  Stream sensor_noise_;
  std::vector<double> walk_K_ = {0.0};  // one value a minute, extended when it is asked for
  SampledCurve record_degC_;            // over seconds
};

}  // namespace twinbench::sim
