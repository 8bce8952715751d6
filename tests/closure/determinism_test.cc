#include <gtest/gtest.h>

#include <atomic>
#include <sstream>
#include <thread>

#include "tests/support/twin_run.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench {
namespace {

std::string Text(const Scenario& scenario) {
  std::ostringstream out;
  WriteReadingsCsv(test::RunTwin(scenario).readings, kRotaryBench, out);
  return out.str();
}

/// Runs seeds 1..count on this many threads, each taking the next seed that is free.
std::vector<std::string> RunSeeds(Scenario scenario, int count, int threads) {
  std::vector<std::string> texts(static_cast<std::size_t>(count));
  std::atomic<int> next = 0;
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t) {
    pool.emplace_back([&, mine = scenario]() mutable {
      for (int k = next++; k < count; k = next++) {
        mine.seed = static_cast<std::uint64_t>(k + 1);
        texts[static_cast<std::size_t>(k)] = Text(mine);
      }
    });
  }
  for (std::thread& thread : pool) thread.join();
  return texts;
}

TEST(SameSeed, GivesTheSameBitsOnAnyNumberOfThreads) {
  for (const char* fidelity : {"kinematic", "linear"}) {
    Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
    RotaryOf(scenario).mechanics.fidelity = fidelity;
    RotaryOf(scenario).procedure.positions = 12;
    RotaryOf(scenario).procedure.shifts = {0, 1};
    const auto alone = RunSeeds(scenario, 6, 1);
    EXPECT_EQ(alone, RunSeeds(scenario, 6, 2)) << fidelity;
    EXPECT_EQ(alone, RunSeeds(scenario, 6, 5)) << fidelity;
    EXPECT_NE(alone[0], alone[1]) << "another seed must give other bits";
  }
}

TEST(SameSeed, GivesTheSameBitsInFullDynamics) {
  Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  RotaryOf(scenario).mechanics.fidelity = "bullet";
  RotaryOf(scenario).procedure.phases = {"full_circle"};
  RotaryOf(scenario).procedure.positions = 4;
  RotaryOf(scenario).procedure.shifts = {0, 1};
  RotaryOf(scenario).procedure.passes = {1};
  EXPECT_EQ(RunSeeds(scenario, 2, 1), RunSeeds(scenario, 2, 2));
}

TEST(OneCauseOneStream, SwitchingOneNoiseOffDoesNotChangeAnother) {
  Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"), {"mechanics.fidelity=kinematic"});
  RotaryOf(scenario).procedure.phases = {"full_circle"};
  RotaryOf(scenario).procedure.shifts = {0};
  RotaryOf(scenario).procedure.passes = {1};
  const auto with = test::RunTwin(scenario).readings;
  scenario.environment.sensor_noise_K = 0.0;
  const auto without = test::RunTwin(scenario).readings;
  for (std::size_t k = 0; k < with.size(); ++k) EXPECT_EQ(with[k].mean_V, without[k].mean_V);
}

}  // namespace
}  // namespace twinbench
