#pragma once

#include "hw_bridge/control/allowed_motion.h"
#include "hw_bridge/control/command_numbers.h"
#include "hw_bridge/control/device_line.h"
#include "twin/core/machine.h"

namespace twinbench::hw {

/// How a machine is to be driven, whatever the language of its controller.
struct MachineManner {
  double traverse_m_s = 0.0;     // of moves that have no feed
  bool polls_pass_time = false;  // the bench is a served twin with its clock held
  CommandNumbers numbers;        // in commands
};

/// A machine behind a controller.
///
/// A move beyond the soft limits sends nothing. An axis that has lost its origin is not moved before Home, and its
/// places are NaN: kRestarted.
class ControlledMachine : public MachineController {
 public:
  /// @param limits  Of the bench file, one entry an axis; infinite: the controller's own.
  ControlledMachine(DeviceLine line, std::vector<MachineAxis> axes, std::vector<AxisLimits> limits,
                    const MachineManner& manner);

  /// Takes over the controller's limits where the bench file gives none.
  /// @throws DeviceFault kRefused if the controller allows less than the bench file.
  void AgreeOnLimits();
  const std::vector<AxisLimits>& limits() const { return limits_; }

  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  /// In real time: looks every 20 ms whether it is done, and whether the line hears a stop.
  bool Settles(Duration within) override;
  /// Said before the controller is identified or prepared, where the connection has to be opened again.
  void Stop() override;
  void Home() override;

 protected:
  DeviceLine& line() { return line_; }
  const MachineManner& manner() const { return manner_; }

  /// Of a place in a command.
  std::string Text(double value_SI, double to_SI) const { return manner_.numbers.Text(value_SI, to_SI); }
  double Understood(const MachineAxis& axis) const { return manner_.numbers.Understood(axis.to_SI()); }
  std::string Place(std::size_t axis, double at) const;
  double Feed_m_s(double feed_m_s) const { return feed_m_s > 0.0 ? feed_m_s : manner_.traverse_m_s; }

  /// Before a move, of a controller that answers at once.
  /// @throws what RequireAsAgreed throws.
  void RequireAllowedAsAgreed();
  void RequireWithinLimits(std::size_t axis, double to);
  void RequireReady(const std::vector<AxisState>& states);
  [[noreturn]] void StopAndFail(FaultKind kind, const std::string& why) {
    line_.StopAndFail([this] { Stop(); }, kind, why);
  }

 private:
  /// What is said first of all to a controller that takes it from anybody; empty: there is no such word.
  virtual std::string StopWord() const = 0;
  virtual void SendStop() = 0;
  virtual bool AskDone() = 0;
  virtual void SendHome() = 0;
  virtual std::optional<double> Fastest(std::size_t /*axis*/) { return std::nullopt; }
  /// Lets at most `within` pass. @return true as soon as every axis has its origin again.
  virtual bool FindsOrigin(Duration within) = 0;

  std::vector<AllowedMotion> Allowed();

  DeviceLine line_;
  std::vector<MachineAxis> axes_;
  std::vector<AxisLimits> limits_;
  std::vector<AllowedMotion> agreed_;
  MachineManner manner_;
};

}  // namespace twinbench::hw
