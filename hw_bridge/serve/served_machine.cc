#include "hw_bridge/serve/served_machine.h"

#include <algorithm>

#include "hw_bridge/serve/scpi_commands.h"

namespace twinbench::hw {

ServedMachine::ServedMachine(MachineBench its_bench, std::vector<ReadingColumn> columns, const Scenario& scenario,
                             double speed)
    : Served("machine-bench", scenario),
      bench(its_bench),
      paced(bench.clock, bench.simulation, speed),
      machine(bench.machine, bench.clock, faults),
      channels(std::move(columns)) {}

std::vector<std::span<const ScpiCommand>> ServedMachine::OwnScpiCommands() const {
  return {ScpiMachineCommands()};
}

bool ServedMachine::Moves() {
  paced.CatchUp();
  return std::ranges::any_of(machine.State(), [](const AxisState& axis) { return axis.moving; });
}

void ServedMachine::LetGetOn() {
  paced.LetGetOn([this](Duration within) { return machine.Settles(within); });
}

void ServedMachine::Restart(std::optional<int> run) {
  BeRun(run, *bench.simulation);
  paced.Restart();
  machine.Restore();
  latched.clear();
  overrun = false;
}

void ServedMachine::Collect() {
  const LatchedSamples now = bench.instruments.Latched();
  latched.insert(latched.end(), now.samples.begin(), now.samples.end());
  overrun = overrun || now.overrun;
  if (!now.samples.empty() && faults.TakeLatch(kServedInstruments) != Injected::kNone) {
    latched.pop_back();
    overrun = true;
  }
}

}  // namespace twinbench::hw
