#include "tools/twinbench/real_bench.h"

#include <fmt/format.h>

#include "hw_bridge/bench_file.h"
#include "tools/twinbench/machine_rehearsal.h"
#include "tools/twinbench/planned_run.h"
#include "tools/twinbench/rehearsal.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"

namespace twinbench::tools {
namespace {

double DurationOf_s(const Scenario& quick) {
  const Bench& bench = BenchOf(quick);
  if (!bench.drive) return Rehearse(quick, {}, hw::AdSettings{}.mains_Hz, true).duration_s;
  return RehearseMachine(quick, bench.make_devices(quick)->Devices().machine.Travel(), true).duration_s;
}

}  // namespace

bool IsRealBench(const std::string& kind, const Simulation* simulation) {
  return kind == "hardware" && !simulation;
}

std::optional<double> MinutesOnRealBench(const Scenario& scenario) {
  if (!BenchOf(scenario).has_controllers) return std::nullopt;
  try {
    return DurationOf_s(Quick(scenario)) / 60.0;
  } catch (const InputError&) {  // what cannot be driven
    return std::nullopt;
  } catch (const BenchError&) {
    return std::nullopt;
  }
}

std::string WithProofs(double minutes, const std::optional<double>& on_real_bench) {
  constexpr double kWorthAWord_min = 0.5;
  if (!on_real_bench || *on_real_bench - minutes < kWorthAWord_min) return "";
  return fmt::format(", {:.0f} with the short steps that prove the readings of a real bench", *on_real_bench);
}

}  // namespace twinbench::tools
