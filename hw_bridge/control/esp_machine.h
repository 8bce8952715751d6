#pragma once

#include "hw_bridge/control/controlled_machine.h"

namespace twinbench::hw {

/// A machine whose axes 1 to N are group 1 of a Newport ESP controller (docs/protocols.md), or its axis 1 alone.
///
/// A move that was understood otherwise is stopped. A controller without MS? (the ESP301 has none) tells a restart
/// by the motor of an axis, which is off after it.
class EspMachine : public ControlledMachine {
 public:
  EspMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
             const MachineManner& manner);

  std::vector<AxisLimits> Travel() override;
  void StartMove(const std::vector<double>& to, double feed_m_s) override;
  void StartArc(const Arc& arc) override;
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override;
  bool Settles(Duration within) override;
  std::vector<AxisState> State() override;

 private:
  std::string StopWord() const override { return "ST"; }
  void SendStop() override;
  bool AskDone() override;
  void SendHome() override;
  std::optional<double> Fastest(std::size_t axis) override;
  bool FindsOrigin(Duration within) override { return Settles(within); }

  bool IsGroup() const { return Axes().size() > 1; }  // one axis alone goes by itself, as fast as it was set up
  void Prepare();
  void PrepareAxis(std::size_t axis);
  void SetFeed(double feed_m_s);
  AxisState ReadAxis(std::size_t axis, const std::function<std::string()>& next_answer);
  void RequireUnderstood(const std::vector<double>& to);

  int prepared_opening_ = 0;
  bool knows_status_ = true, knows_speed_ = false;  // MS?, VU?
  std::vector<bool> lost_origin_;  // of each axis, so far as its motor tells
};

}  // namespace twinbench::hw
