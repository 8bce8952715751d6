#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/rotary_scenario.h"
#include "tests/support/truth_rows.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench {
namespace {

Scenario OracleScenario(const std::string& clamping, const std::string& fidelity) {
  const nlohmann::json truth =
      test::ReadTruthFile(test::DataPath("oracle/full_circle_" + clamping + "_truth.json"));
  Scenario scenario = test::RotaryScenario();
  scenario.noise_free = true;
  RotaryOf(scenario).optics.fidelity = fidelity;
  RotaryOf(scenario).target.errors = test::ErrorsOfRows(truth.at("target"), false);
  RotaryOf(scenario).reference.errors = test::ErrorsOfRows(truth.at("reference_rotor_frame"), true);
  RotaryOf(scenario).procedure.phases = {"full_circle"};
  RotaryOf(scenario).procedure.passes = {1};
  RotaryOf(scenario).procedure.clamping = clamping;
  return scenario;
}

class FullCircleOracle : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(FullCircleOracle, TheTwinReadsTheIndependentValuesToANanometre) {
  const auto [clamping, fidelity] = GetParam();
  const Scenario scenario = OracleScenario(clamping, fidelity);
  const auto oracle = ReadReadingsCsv(test::DataPath(std::string("oracle/full_circle_") + clamping + ".csv"));
  const test::TwinRun run = test::RunTwin(scenario);
  const std::vector<Reading>& readings = run.readings;
  EXPECT_EQ(run.rays_traced > 0, std::string(fidelity) == "traced");
  ASSERT_EQ(readings.size(), oracle.size());
  // 1 nm on the PSD; the file itself is rounded to 1 nV, half a femtometre.
  const double one_nm_V = units::nm * RotaryOf(scenario).psd_a.sensitivity_V_m;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    EXPECT_EQ(readings[k].setup, oracle[k].setup);
    EXPECT_EQ(readings[k].position, oracle[k].position);
    EXPECT_NEAR(readings[k].target_rad, oracle[k].target_rad, 1e-9);
    EXPECT_NEAR(readings[k].reference_rad, oracle[k].reference_rad, 1e-9);
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(readings[k].mean_V[c], oracle[k].mean_V[c], one_nm_V);
  }
}

INSTANTIATE_TEST_SUITE_P(BothClampings, FullCircleOracle,
                         ::testing::Combine(::testing::Values("reclamp", "reseat"),
                                            ::testing::Values("traced", "closed")));

}  // namespace
}  // namespace twinbench
