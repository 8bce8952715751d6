#pragma once

#include "hw_bridge/control/device_line.h"
#include "twin/core/devices.h"

namespace twinbench::hw {

/// The clock of a served twin, held: from Open on its time passes only in waits, moves and acquisitions. Needs a
/// connection of its own, for the hold ends with it; where it had to be opened again, time ran meanwhile.
class ScpiClock : public Clock {
 public:
  explicit ScpiClock(DeviceLine line) : line_(std::move(line)) {}

  /// Connects and holds the clock, unless it is held.
  void Open() const;
  /// @throws DeviceFault as DeviceLine, like Wait.
  Time Now() const override;
  void Wait(Duration duration) override;
  std::string Identity() const { return line_.identity(); }
  /// Whether a twin answers, which can do what a real bench cannot.
  bool IsTwin() const { return Identity().starts_with("twinbench,"); }

 private:
  friend class ScpiSimulation;
  void TakeHold() const;
  mutable DeviceLine line_;  // Now asks
  mutable int held_opening_ = 0;
};

/// What only a twin can do. Shares the clock's connection, with which pacing ends too.
/// @param run  Which of the twin's runs every restart begins, as Scenario::repeat; 0: its own.
class ScpiSimulation : public Simulation {
 public:
  explicit ScpiSimulation(ScpiClock& clock, int run = 0) : clock_(clock), run_(run) {}
  void Restart() override;
  void SetPaced(bool paced) override;

 private:
  ScpiClock& clock_;
  int run_;
};

}  // namespace twinbench::hw
