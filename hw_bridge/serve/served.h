#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hw_bridge/serve/faults.h"
#include "hw_bridge/serve/paced_clock.h"
#include "hw_bridge/serve/watchdog.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {

struct ScpiCommand;

/// A served bench of any kind, as far as all connections share it.
class Served {
 public:
  /// @param its_name  As *IDN? tells it: "rotary-bench".
  Served(std::string its_name, const Scenario& scenario, Wall wall = WallClock::now);
  virtual ~Served() = default;

  virtual PacedClock& pace() = 0;
  /// What it understands beside the commands that every served bench has.
  virtual std::vector<std::span<const ScpiCommand>> OwnScpiCommands() const = 0;
  /// Whether anything that a controller moves is moving.
  virtual bool Moves() = 0;
  /// Lets what moves get on where time does not pass by itself.
  virtual void LetGetOn() = 0;
  virtual void StopAll() = 0;
  /// @param run  Which of the bench's runs begins, as Scenario::repeat; none: its scenario's own.
  /// @throws BenchError on a bench that cannot.
  virtual void Restart(std::optional<int> run) = 0;

  /// Stops everything if something moves.
  void StopIfMoving();

  /// `answer` when nothing moves.
  Poll AtRest(const std::string& answer);

  std::string name;
  std::string serial;  // made from bench, scenario and seed
  std::string token;   // whoever moves or spoils anything must have shown it; empty: anybody may
  Faults faults;
  Duration late{};     // that an answer is by the fault of that name
  Watchdog watchdog;

 protected:
  /// @throws BenchError if it is asked for a run that the simulation cannot be.
  void BeRun(std::optional<int> run, Simulation& simulation) const;

 private:
  int own_run_;
};

}  // namespace twinbench::hw
