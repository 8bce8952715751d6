#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/sampled_curve.h"
#include "twin/core/scenario.h"

namespace twinbench::sim {

/// The [[empirical]] signals of one channel.
class EmpiricalSignal {
 public:
  EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel);

  /// SI: rad, m or what the channel reads. @param time_s  As the record counts it.
  double At(int reading, double time_s) const;

 private:
  std::map<int, double> by_reading_;
  std::vector<SampledCurve> by_time_;
};

}  // namespace twinbench::sim
