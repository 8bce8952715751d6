#pragma once

#include <deque>

#include "hw_bridge/serve/served.h"
#include "hw_bridge/serve/shown_machine.h"
#include "twin/core/reading_column.h"

namespace twinbench::hw {

/// What a served machine's instruments are called in Faults.
inline constexpr const char* kServedInstruments = "instruments";

/// A bench whose machine is driven, served.
struct ServedMachine : Served {
  /// @param columns  What the instruments show, as the readings of the bench have it.
  ServedMachine(MachineBench its_bench, std::vector<ReadingColumn> columns, const Scenario& scenario, double speed);

  PacedClock& pace() override { return paced; }
  std::vector<std::span<const ScpiCommand>> OwnScpiCommands() const override;
  bool Moves() override;
  void LetGetOn() override;
  void StopAll() override { machine.Stop(); }
  void Restart(std::optional<int> run) override;

  /// Takes what was latched into `latched`.
  void Collect();

  MachineBench bench;
  PacedClock paced;
  ShownMachine machine;
  std::vector<ReadingColumn> channels;
  std::deque<Reading> latched;  // not yet fetched
  bool overrun = false;
};

}  // namespace twinbench::hw
