#include "hw_bridge/serve/served_bench.h"

#include "hw_bridge/serve/scpi_commands.h"
#include "twin/core/errors.h"

namespace twinbench::hw {

ServedBench::ServedBench(RotaryBench bench, const Scenario& scenario, const AdcSettings& its_adc, double speed,
                         const Wall& wall)
    : Served("rotary-bench", scenario, wall),
      paced(bench, its_adc, speed, wall),
      target(bench.target, bench.clock, faults, "target"),
      reference(bench.reference, bench.clock, faults, "reference"),
      adc(its_adc) {}

std::vector<std::span<const ScpiCommand>> ServedBench::OwnScpiCommands() const {
  return {ScpiTableCommands(), ScpiInstrumentCommands()};
}

void ServedBench::StrikeRestarts() {
  const bool both = faults.TakeRestart("controller") != Injected::kNone;
  for (ShownTable* table : {&target, &reference}) {
    if (faults.TakeRestart(table->name()) != Injected::kNone || both) table->LoseOrigin();
  }
}

void ServedBench::StopAll() {
  target.Stop();
  reference.Stop();
}

bool ServedBench::Moves() {
  paced.CatchUp();
  return target.State().moving || reference.State().moving;
}

void ServedBench::LetGetOn() {
  for (ShownTable* table : {&target, &reference}) {
    if (table->State().moving) paced.LetGetOn(*table);
  }
}

void ServedBench::Restart(std::optional<int> run) {
  if (!bench().simulation) throw BenchError("bench: it cannot be started again");
  BeRun(run, *bench().simulation);
  paced.Restart();
  target.Restore();
  reference.Restore();
}

}  // namespace twinbench::hw
