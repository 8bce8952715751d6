#pragma once

#include "tests/support/memory_log.h"
#include "twin/benches/encoder_comparison/procedure.h"
#include "twin/benches/encoder_comparison/twin/twin.h"
#include "twin/benches/rotary_4dof/estimators/separate.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

/// Runs of the twin without a disk: what the closure, scenario and hidden tests have in common.
namespace twinbench::test {

struct TwinRun {
  Scenario scenario;
  std::vector<Reading> readings;
  sim::Truth truth;
  std::uint64_t rays_traced = 0;
};

inline TwinRun RunTwin(const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  MemoryLog log;
  procedure::CarryOut(bench, scenario, log);
  return {scenario, log.readings, twin.TheTruth(), twin.RaysTraced()};
}

/// The same of the bench encoder_comparison; its truth is that of the scenario's effects.
inline TwinRun RunEncoderTwin(const Scenario& scenario) {
  sim::EncoderTwin twin(scenario);
  MemoryLog log;
  procedure::CarryOut(twin, scenario, log);
  sim::Truth truth;
  truth.effects = scenario.effects;
  truth.seed = scenario.seed;
  return {scenario, log.readings, truth, 0};
}

/// Readings -> calibration -> motions -> errors of both tables, as `twinbench separate` does it.
inline separate::Separation Evaluate(const TwinRun& run, Estimator estimator = Estimator::kRigorous) {
  const measure::BenchGeometry geometry = measure::NominalGeometry(run.scenario);
  const measure::Calibration calibration = measure::Calibrate(run.readings, geometry);
  separate::SeparateOptions options = separate::OptionsFrom(run.scenario);
  options.estimator = estimator;
  options.cov_calibration = calibration.cov;
  return separate::Separate(measure::Measure(run.readings, geometry, calibration, estimator), geometry, options);
}

inline std::string DataPath(const std::string& name) { return std::string(TWINBENCH_TEST_DATA) + "/" + name; }
inline std::string ScenarioPath(const std::string& name) {
  return std::string(TWINBENCH_SOURCE_DIR) + "/scenarios/" + name;
}

}  // namespace twinbench::test
