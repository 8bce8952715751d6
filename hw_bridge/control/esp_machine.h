#pragma once

#include <functional>

#include "hw_bridge/control/device_line.h"
#include "twin/core/machine.h"

namespace twinbench::hw {

/// How a machine behind an ESP controller is to be driven.
struct EspMachineManner {
  double traverse_m_s = 0.0;     // of moves that have no feed
  bool polls_pass_time = false;  // the bench is a served twin with its clock held
  int decimals = -1;             // digits behind the point of a number in a command; -1: all that matter
};

/// A machine whose axes 1 to N are group 1 of a Newport ESP controller (docs/protocols.md), or its axis 1 alone.
///
/// A move beyond the soft limits sends nothing, and one that was understood otherwise is stopped. An axis that has
/// lost its origin is not moved before Home, and its places are NaN: kRestarted. A controller without MS? (the ESP301 has
/// none) tells a restart by the motor of an axis, which is off after it.
class EspMachine : public MachineController {
 public:
  /// @param limits  Of the bench file, one entry an axis; infinite: the controller's own.
  EspMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
             EspMachineManner manner);

  /// Takes over the controller's limits where the bench file gives none.
  /// @throws DeviceFault kRefused if the controller allows less than the bench file.
  void AgreeOnLimits();
  const std::vector<AxisLimits>& limits() const { return limits_; }

  /// From here on Settles on a bench of real time asks `stop_asked` every 20 ms, and ends with a DeviceFault kStopped where it says so.
  void HearStop(std::function<bool()> stop_asked) { stop_asked_ = std::move(stop_asked); }

  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  std::vector<AxisLimits> Travel() override;
  void StartMove(const std::vector<double>& to, double feed_m_s) override;
  void StartArc(const Arc& arc) override;
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override;
  bool Settles(Duration within) override;
  std::vector<AxisState> State() override;
  void Stop() override;
  void Home() override;

 private:
  bool IsGroup() const { return axes_.size() > 1; }  // one axis alone goes by itself, as fast as it was set up
  void Prepare();
  void PrepareAxis(std::size_t axis);
  std::string Text(double value_SI, double to_SI) const;
  double Understood(const MachineAxis& axis) const;
  void SetFeed(double feed_m_s);
  AxisState ReadAxis(std::size_t axis, const std::function<std::string()>& next_answer);
  bool AskDone();
  bool PollRunning(Duration within);
  void RequireWithinLimits(std::size_t axis, double to);
  void RequireReady(const std::vector<AxisState>& states);
  void RequireUnderstood(const std::vector<double>& to);
  [[noreturn]] void StopAndFail(FaultKind kind, const std::string& why);
  std::string Place(std::size_t axis, double at) const;

  DeviceLine line_;
  std::vector<MachineAxis> axes_;
  std::vector<AxisLimits> limits_;
  EspMachineManner manner_;
  std::function<bool()> stop_asked_;
  int prepared_opening_ = 0;
  bool knows_status_ = true;  // MS?
  std::vector<bool> lost_origin_;  // of each axis, so far as its motor tells
};

}  // namespace twinbench::hw
