#include "tools/twinbench/live_judge.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/twinbench/alarm_text.h"
#include "tools/twinbench/passing_run.h"
#include "twin/benches/registry.h"

/// What a page is told of readings while they come, against what the whole run says.
namespace twinbench::tools {
namespace {

struct Told {
  std::vector<int> predicted;  // numbers of readings
  nlohmann::json last;         // residual
  std::vector<std::string> alarms;
  std::string unjudged;
};

/// Hands the readings over in two parts and listens.
Told Judged(const Scenario& scenario, const std::vector<Reading>& readings) {
  Told told;
  const auto listen = [&told](const char* kind, const std::string& text) {
    const nlohmann::json json = nlohmann::json::parse(text);
    if (kind == std::string("alarm")) told.alarms.push_back(json.at("words"));
    if (kind == std::string("unjudged")) told.unjudged = json.at("why");
    if (kind != std::string("residuals")) return;
    for (const nlohmann::json& reading : json.at("readings")) told.predicted.push_back(reading.at("n"));
    told.last = json.at("readings").back();
  };
  LiveJudge judge(scenario, listen);
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (k == readings.size() / 2) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    judge.Hear(readings[k]);
  }
  return told;
}

Scenario Small() {
  return ParseScenario(R"(bench = "rotary_4dof"
[procedure]
phases = ["full_circle"]
positions = 12
shifts = [0, 1, 5]
[mechanics]
fidelity = "kinematic"
)",
                       "small.toml", "");
}

TEST(LiveJudge, SaysOfEveryReadingWhatTheWholeRunSays) {
  const Scenario scenario = Small();
  std::vector<Reading> readings = ReadingsOfTwin(scenario);
  const std::size_t disturbed = readings.size() * 3 / 4;
  readings[disturbed].mean_V[0] += 0.05;
  const Told told = Judged(scenario, readings);

  const diagnose::LinearRun run = BenchOf(scenario).linear_run(readings, scenario, Estimator::kRigorous);
  const Watched whole = Seen(run, {0.01, BenchOf(scenario).planned_readings(scenario)});
  ASSERT_EQ(told.predicted.size(), whole.report.predicted.size());
  for (std::size_t k = 0; k < told.predicted.size(); ++k) EXPECT_EQ(told.predicted[k], whole.report.predicted[k].reading);
  const diagnose::PredictedReading& last = whole.report.predicted.back();
  EXPECT_NEAR(told.last.at("v")[0], last.deviation[0] / whole.units[0].to_SI, 1e-6 * last.u[0] / whole.units[0].to_SI);
  ASSERT_EQ(told.alarms.size(), whole.report.alarms.size());
  ASSERT_FALSE(told.alarms.empty());
  EXPECT_EQ(told.alarms[0], AlarmText(whole.report.alarms[0], whole));
  EXPECT_EQ(whole.report.alarms[0].reading, readings[disturbed].reading);
}

TEST(LiveJudge, WaitsForEnoughReadings) {
  const Scenario scenario = Small();
  const std::vector<Reading> readings = ReadingsOfTwin(scenario);
  const Told told = Judged(scenario, {readings.begin(), readings.begin() + 2});
  EXPECT_EQ(told.unjudged, "");
  EXPECT_TRUE(told.alarms.empty());
}

}  // namespace
}  // namespace twinbench::tools
