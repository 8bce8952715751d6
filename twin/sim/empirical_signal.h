#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// The [[empirical]] signals of one channel that reads an angle.
class EmpiricalSignal {
 public:
  EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel);
  double At_rad(int reading) const;

 private:
  std::map<int, double> by_reading_rad_;
};

}  // namespace twinbench::sim
