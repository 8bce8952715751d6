#pragma once

#include "hw_bridge/serve/paced_bench.h"
#include "hw_bridge/serve/served.h"
#include "hw_bridge/serve/shown_table.h"

namespace twinbench::hw {

/// A rotary bench, served.
struct ServedBench : Served {
  ServedBench(RotaryBench bench, const Scenario& scenario, const AdcSettings& its_adc, double speed, const Wall& wall = WallClock::now);

  RotaryBench& bench() { return paced.bench(); }
  PacedClock& pace() override { return paced; }
  std::vector<std::span<const ScpiCommand>> OwnScpiCommands() const override;
  /// A restarted controller has forgotten its origin before it takes the next order.
  void StrikeRestarts();
  void StopAll() override;
  bool Moves() override;
  void LetGetOn() override;
  void Restart(std::optional<int> run) override;

  PacedBench paced;
  ShownTable target, reference;
  AdcSettings adc;
  std::size_t scans_asked = 0;  // of blocks that clients are waiting for
};

}  // namespace twinbench::hw
