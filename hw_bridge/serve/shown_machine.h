#pragma once

#include <optional>
#include <string>

#include "hw_bridge/serve/faults.h"
#include "twin/core/machine.h"

namespace twinbench::hw {

/// The controller of a machine and what happened to it on demand. Without faults every call is one of the
/// machine's.
class ShownMachine : public MachineController {
 public:
  static constexpr const char* kName = "machine";  // as in Faults

  ShownMachine(MachineController& machine, Clock& clock, Faults& faults)
      : machine_(machine), clock_(clock), faults_(faults), limits_(machine.Travel()) {}

  const std::vector<MachineAxis>& Axes() const override { return machine_.Axes(); }
  std::vector<AxisLimits> Travel() override { return limits_; }
  void StartMove(const std::vector<double>& to, double feed_m_s) override;
  void StartArc(const Arc& arc) override;
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override;
  bool Settles(Duration within) override;
  std::vector<AxisState> State() override;
  void Stop() override;
  void Home() override;

  /// Soft limits of an axis, within its travel; may be set by a client.
  AxisLimits& limits(std::size_t axis) { return limits_[axis]; }
  /// The controller was switched off and on, if that was asked for: no axis knows its origin until it is homed.
  void StrikeRestart();
  /// Undoes what the machine suffered.
  void Restore() { mishap_ = {}; }

 private:
  struct Mishap {
    Injected kind = Injected::kNone;  // of the move under way
    Time strikes{};                   // when it does
    std::vector<AxisState> stuck;     // what is shown since then; empty: it has not struck
    bool referenced = true;
  };
  void Begin();
  void Strike();
  bool IsStuck() const { return !mishap_.stuck.empty(); }

  MachineController& machine_;
  Clock& clock_;
  Faults& faults_;
  std::vector<AxisLimits> limits_;
  Mishap mishap_;
};

}  // namespace twinbench::hw
