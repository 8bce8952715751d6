#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/twin_run.h"
#include "twin/benches/encoder_comparison/bench.h"

namespace twinbench::test {

/// A shipped scenario of the encoders carried out; results and score are evaluations of their own, each made by whoever asks.
struct EncoderScenarioRun {
  Scenario scenario;
  Estimator estimator;
  std::vector<Reading> readings;

  nlohmann::json Results() const { return benches::encoder::Evaluate(scenario, readings, estimator).results; }
  nlohmann::json Score() const {
    return benches::encoder::ScoreRun(scenario, readings, sim::EncoderTwin(scenario).Truth(), estimator).json;
  }
};

inline EncoderScenarioRun RunEncoderScenario(const std::string& file, const std::vector<std::string>& overrides,
                                             Estimator estimator = Estimator::kRigorous) {
  const Scenario scenario = LoadScenario(ScenarioPath(file), overrides);
  return {scenario, estimator, RunEncoderTwin(scenario).readings};
}

/// By the path of a JSON pointer.
inline double Figure(const nlohmann::json& json, const char* path) {
  return json.at(nlohmann::json::json_pointer(path)).get<double>();
}

}  // namespace twinbench::test
