#pragma once

#include <optional>
#include <string>

#include "hw_bridge/control/allowed_motion.h"
#include "hw_bridge/control/command_numbers.h"
#include "hw_bridge/control/device_line.h"
#include "twin/core/devices.h"
#include "twin/core/table_limits.h"

namespace twinbench::hw {

/// A table behind a controller, whatever its language.
///
/// A move beyond the soft limits sends nothing. A controller that understood another angle than it was told is
/// stopped. One that has lost its origin is not moved before Home, its angles are NaN and it never settles:
/// kRestarted.
class ControlledTable : public RotaryTable {
 public:
  /// @param numbers  Angles in commands.
  ControlledTable(DeviceLine line, const TableLimits& limits, CommandNumbers numbers);

  void StartMove(double angle_rad) override;
  bool Settles(Duration within) override;
  TableState State() override;
  /// Said before the controller is identified or prepared, where the connection has to be opened again.
  void Stop() override;
  void Home() override;

  /// Takes over the controller's own limits where the bench file gives none; RequireAsAgreed holds before later moves.
  /// @throws DeviceFault kRefused if the controller allows less than the bench file.
  void AgreeOnLimits();
  const TableLimits& limits() const { return limits_; }

 protected:
  DeviceLine& line() { return line_; }

 private:
  virtual void SendMove(const std::string& angle_deg) = 0;
  /// Lets at most `within` of bench time pass. @return true as soon as the controller says that it has settled.
  virtual bool AwaitSettled(Duration within) = 0;
  virtual TableState ReadState() = 0;
  /// What SendStop says, without its questions.
  virtual std::string StopWord() const = 0;
  virtual void SendStop() = 0;
  virtual void SendHome() = 0;
  virtual AllowedMotion ReadAllowed() = 0;

  /// Where the line hears a stop, asks every 50 ms of bench time: nobody waits out the second that a procedure watches a moving table for.
  bool AwaitSettledOrStop(Duration within);
  void RequireWithinLimits(double angle_rad) const;
  void RequireOrigin(const TableState& now) const;
  void RequireUnderstood(double angle_rad, const TableState& now);
  [[noreturn]] void StopAndFail(FaultKind kind, const std::string& why) {
    line_.StopAndFail([this] { Stop(); }, kind, why);
  }

  DeviceLine line_;
  TableLimits limits_;
  std::optional<AllowedMotion> agreed_;
  CommandNumbers numbers_;
};

}  // namespace twinbench::hw
