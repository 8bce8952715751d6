#include "hw_bridge/serve/served.h"

#include <fmt/format.h>

#include <cstdint>

#include "twin/core/errors.h"
#include "twin/core/numbered_runs.h"

namespace twinbench::hw {
namespace {

/// 64-bit FNV-1a of the whole scenario: bench, seed and every setting.
std::string SerialOf(const Scenario& scenario) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : WriteScenario(scenario)) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016X}", hash);
}

}  // namespace

Served::Served(std::string its_name, const Scenario& scenario, Wall wall)
    : name(std::move(its_name)), serial(SerialOf(scenario)), watchdog(std::move(wall)), own_run_(scenario.repeat) {}

void Served::BeRun(std::optional<int> run, Simulation& simulation) const {
  if (auto* runs = dynamic_cast<NumberedRuns*>(&simulation)) return runs->BeRun(run.value_or(own_run_));
  if (run) throw BenchError("bench: its runs have no numbers");
}

void Served::StopIfMoving() {
  if (Moves()) StopAll();
}

Poll Served::AtRest(const std::string& answer) {
  return [this, answer]() -> std::optional<std::string> {
    if (!Moves()) return answer;
    if (!pace().Immediate()) return std::nullopt;
    LetGetOn();
    return Moves() ? std::nullopt : std::optional(answer);
  };
}

}  // namespace twinbench::hw
