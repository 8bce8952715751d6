#pragma once

#include <string>

#include "hw_bridge/serve/faults.h"
#include "hw_bridge/serve/paced_bench.h"
#include "hw_bridge/serve/shown_table.h"
#include "twin/core/scenario.h"

namespace twinbench::hw {

/// What all connections share.
struct ServedBench {
  ServedBench(RotaryBench bench, const Scenario& scenario, const AdcSettings& its_adc, double speed);

  RotaryBench& bench() { return paced.bench(); }
  /// A restarted controller has forgotten its origin before it takes the next order.
  void StrikeRestarts();
  void StopTables();
  bool Moves();
  /// `answer` when no table moves.
  Poll AtRest(const std::string& answer);
  /// @throws BenchError on a bench that cannot.
  void Restart();

  PacedBench paced;
  Faults faults;
  ShownTable target, reference;
  AdcSettings adc;
  std::string serial;
};

}  // namespace twinbench::hw
