#pragma once

#include <optional>
#include <string>

#include "hw_bridge/serve/faults.h"
#include "twin/core/devices.h"

namespace twinbench::hw {

/// A table of the bench and what happened to it on demand. Without faults every call is one call of the table.
class ShownTable : public RotaryTable {
 public:
  /// @param name  "target" or "reference", as in Faults.
  ShownTable(RotaryTable& table, Clock& clock, Faults& faults, std::string name)
      : table_(table), clock_(clock), faults_(faults), name_(std::move(name)) {}

  const std::string& name() const { return name_; }

  void StartMove(double angle_rad) override;
  bool Settles(Duration within) override;
  TableState State() override;
  void Stop() override;
  void Home() override;

  enum class Refusal { kNone, kSoftLimit, kLimitSwitch };
  /// Whether the controller would take a move there.
  Refusal Refuses(double angle_rad);

  /// The controller is switched off and on: it counts from where the table stands, and knows no origin.
  void LoseOrigin();
  /// Undoes what the table suffered.
  void Restore() { mishap_ = {}; }

  static constexpr double kFarthest_rad = 1e4;                   // beyond it no soft limit can be set
  double lower_rad = -kFarthest_rad, upper_rad = kFarthest_rad;  // soft limits
  bool motor_on = true;                                          // for the ESP dialect, the only one that asks

 private:
  struct Mishap {
    double origin_rad = 0.0;          // angle of the table where the controller shows zero
    double slip_rad = 0.0;            // the table is that much ahead of where the controller drives it
    std::optional<double> asked_rad;  // as the controller shows it; empty: as the table's own says
    bool referenced = true, stands_still = false, misses_window = false;
    int limit = 0;
  };
  bool CannotSettle() const { return mishap_.stands_still || mishap_.misses_window; }
  void Begin(double angle_rad, Injected fault);

  RotaryTable& table_;
  Clock& clock_;
  Faults& faults_;
  std::string name_;
  Mishap mishap_;
};

}  // namespace twinbench::hw
