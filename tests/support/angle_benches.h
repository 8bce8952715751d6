#pragma once

#include <nlohmann/json.hpp>

#include "tests/circular_motion/circle_run.h"
#include "tests/core/input_error.h"
#include "tests/support/twin_run.h"
#include "twin/benches/hob_transmission/estimators/hob_bench.h"
#include "twin/benches/hob_transmission/procedure.h"
#include "twin/benches/hob_transmission/twin/twin.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/turntable_autocollimator/estimators/turntable_bench.h"
#include "twin/benches/turntable_autocollimator/procedure.h"
#include "twin/benches/turntable_autocollimator/twin/twin.h"
#include "twin/procedure/machine_options.h"

/// Runs of the benches' twins without a disk.
namespace twinbench::test {

struct BenchRun {
  Scenario scenario;
  std::vector<Reading> readings;
  nlohmann::json truth;
};

inline BenchRun RunBench(const Scenario& scenario) {
  const auto twin = BenchOf(scenario).make_twin(scenario);
  MemoryLog log;
  twin->CarryOut(log, {});
  return {scenario, log.readings, twin->Truth()};
}

inline BenchRun RunCircles(const Scenario& scenario) {
  const sim::CircleRun run(scenario);
  return {scenario, CircleReadings(run), run.Truth()};
}

/// An effect of the catalogue with its default sizes, at its last place. What has an onset or a share gets ones
/// that a short run shows.
inline EffectSettings PlainEffect(const EffectEntry& entry) {
  EffectSettings effect{entry.name, entry.places.empty() ? "" : entry.places.back(), {}, ""};
  for (const EffectParameter& p : entry.parameters) effect.parameters[p.name] = p.default_SI;
  if (entry.name == "slip" || entry.name == "mode_hop") effect.parameters["at_reading"] = 5.0;
  if (entry.name == "outliers") effect.parameters["fraction"] = 0.3;
  return effect;
}

/// The readings of any bench's twin.
inline std::vector<Reading> ReadingsOf(const Scenario& scenario) {
  if (scenario.bench == kEncoderBench) return RunEncoderTwin(scenario).readings;
  if (scenario.bench == kCircularBench) return RunCircles(scenario).readings;
  return RunBench(scenario).readings;
}

}  // namespace twinbench::test
