#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// The [[empirical]] signals of one channel.
class EmpiricalSignal {
 public:
  EmpiricalSignal(const std::vector<EmpiricalSettings>& empiricals, const std::string& channel);
  double At(int reading) const;  // SI: rad, m or what the channel reads

 private:
  std::map<int, double> by_reading_;
};

}  // namespace twinbench::sim
