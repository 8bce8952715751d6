#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/rotary_scenario.h"
#include "tests/support/separated_table.h"
#include "tests/support/truth_rows.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/settings.h"

// Runs of the reference bench made by an implementation that shares nothing with ours.
namespace twinbench {
namespace {

struct TrueTables {
  TableErrors target, reference;
};

TrueTables TablesOf(const nlohmann::json& truth) {
  return {test::ErrorsOfRows(truth.at("target"), false), test::ErrorsOfRows(truth.at("reference_rotor_frame"), true)};
}

double MeanChi2(const test::SeparatedTable& t, Component c) {
  double sum = 0.0;
  for (std::size_t k = 0; k < t.truth[c].size(); ++k)
    sum += std::pow((t.estimate.value[c][k] - t.truth[c][k]) / t.estimate.u[c][k], 2);
  return sum / static_cast<double>(t.truth[c].size());
}

/// Noisy ones without any hidden effect.
class IndependentRun : public ::testing::TestWithParam<const char*> {};

TEST_P(IndependentRun, IsSeparatedWithinTheStatedUncertainties) {
  const std::string folder = test::DataPath(std::string("challenge/") + GetParam());
  test::TwinRun run;
  run.scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  run.readings = ReadReadingsCsv(folder + "/readings.csv");
  const separate::Separation s = test::Evaluate(run);
  const TrueTables truth = TablesOf(test::ReadTruthFile(folder + "/truth.json").at("tables"));
  for (const test::SeparatedTable& t : test::BothTables(s, truth)) {
    for (const Component c : {Component::kEx, Component::kEy, Component::kEz, Component::kDy}) {
      // 36 values, correlated over positions: mean 1, deviation about sqrt(2 / 18) = 0.33; three and a half of these.
      EXPECT_GT(MeanChi2(t, c), 0.2) << t.Name(c);
      EXPECT_LT(MeanChi2(t, c), 2.2) << t.Name(c);
    }
  }
  EXPECT_EQ(s.scale, Eigen::Vector4d::Ones().eval()) << "nothing is hidden here, so nothing may exceed the noise";
}

INSTANTIATE_TEST_SUITE_P(CleanCases, IndependentRun, ::testing::Values("002", "005", "013", "020"));

Scenario OracleScenario(const std::string& clamping, const std::string& fidelity) {
  const TrueTables truth =
      TablesOf(test::ReadTruthFile(test::DataPath("oracle/full_circle_" + clamping + "_truth.json")));
  Scenario scenario = test::RotaryScenario();
  scenario.noise_free = true;
  RotaryOf(scenario).optics.fidelity = fidelity;
  RotaryOf(scenario).target.errors = truth.target;
  RotaryOf(scenario).reference.errors = truth.reference;
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
