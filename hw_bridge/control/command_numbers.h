#pragma once

#include <string>

namespace twinbench::hw {

/// How a controller is told a number in a command.
struct CommandNumbers {
  int decimals = -1;  // digits behind the point; -1: all that matter

  std::string Text(double value_SI, double to_SI) const;
  /// As far as a controller may be from what was meant, in SI.
  double Understood(double to_SI) const;
};

}  // namespace twinbench::hw
