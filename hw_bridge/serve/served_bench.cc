#include "hw_bridge/serve/served_bench.h"

#include <fmt/format.h>

#include <cstdint>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

/// 64-bit FNV-1a of the whole scenario: bench, seed and every setting.
std::string SerialOf(const Scenario& scenario) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : WriteScenario(scenario)) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016X}", hash);
}

}  // namespace

ServedBench::ServedBench(RotaryBench bench, const Scenario& scenario, const AdcSettings& its_adc, double speed)
    : paced(bench, its_adc, speed),
      target(bench.target, bench.clock, faults, "target"),
      reference(bench.reference, bench.clock, faults, "reference"),
      adc(its_adc),
      serial(SerialOf(scenario)) {}

void ServedBench::StrikeRestarts() {
  const bool both = faults.TakeRestart("controller") != Injected::kNone;
  for (ShownTable* table : {&target, &reference}) {
    if (faults.TakeRestart(table->name()) != Injected::kNone || both) table->LoseOrigin();
  }
}

void ServedBench::StopTables() {
  target.Stop();
  reference.Stop();
}

bool ServedBench::Moves() {
  paced.CatchUp();
  return target.State().moving || reference.State().moving;
}

Poll ServedBench::AtRest(const std::string& answer) {
  return [this, answer]() -> std::optional<std::string> {
    if (!Moves()) return answer;
    if (!paced.Immediate()) return std::nullopt;
    for (ShownTable* table : {&target, &reference}) {
      if (table->State().moving) paced.LetGetOn(*table);
    }
    return Moves() ? std::nullopt : std::optional(answer);
  };
}

void ServedBench::Restart() {
  if (!bench().simulation) throw BenchError("bench: it cannot be started again");
  paced.Restart();
  target.Restore();
  reference.Restore();
}

}  // namespace twinbench::hw
