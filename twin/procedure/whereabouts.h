#pragma once

#include <vector>

#include "twin/core/machine.h"

namespace twinbench::procedure {

inline constexpr double kSameTarget = 1e-5;  // m or rad: more than commands are rounded by

/// Those of an axis; where none are stated, the widest.
AxisLimits LimitsOf(const std::vector<AxisLimits>& limits, std::size_t axis);

/// @throws DeviceFault kMoved: its controller has another target than the one it was given.
[[noreturn]] void TellSentElsewhere(const MachineAxis& axis, double sent, double commanded);

/// Of the circle on which they stand, as their encoders say.
double RadiusNow_m(const Arc& arc, const std::vector<AxisState>& states);

/// Where the axes of a machine were sent by us: what its controller and its encoders say is compared with that, for somebody else
/// (a pendant, another program) may have sent them elsewhere. Metres and radians.
class Whereabouts {
 public:
  /// @param limits  One entry an axis, or none.
  Whereabouts(const std::vector<MachineAxis>& axes, const std::vector<AxisLimits>& limits);

  void SentTo(const std::vector<double>& to) { sent_ = to; }
  /// @param states  Of before: where it was not we who sent an axis, it goes on from where its controller has it.
  void SentRound(const Arc& arc, const std::vector<AxisState>& states);
  /// The axis turns on and on; where it comes to rest nobody has said.
  void Released(std::size_t axis);

  /// Where we sent it, or where its controller says that it was sent, where it was not we. NaN: nobody knows.
  double Sent(std::size_t axis, const AxisState& state) const;
  /// Encoder against Sent: as the limits say, else what no controller leaves.
  double Tolerance(std::size_t axis) const;

  /// @throws DeviceFault kMoved if a controller has another target than the one it was given.
  void RequireOurs(const std::vector<AxisState>& states) const;

 private:
  const std::vector<MachineAxis>& axes_;
  const std::vector<AxisLimits>& limits_;
  std::vector<double> sent_;  // NaN: not by us; infinite: it turned on since
};

}  // namespace twinbench::procedure
