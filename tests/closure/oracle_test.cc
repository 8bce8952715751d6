#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/twin_run.h"

namespace twinbench {
namespace {

/// Errors of tests/data/oracle: rows are positions; the reference's row j is its own angle -j steps, in its rotor
/// frame.
TableErrors OracleErrors(const nlohmann::json& rows, bool reference) {
  TableErrors errors;
  const int n = static_cast<int>(rows.size());
  for (int row = 0; row < n; ++row) {
    const int step = reference ? (n - row) % n : row;
    errors.position_rad.push_back(step * 2.0 * units::kPi / n);
    for (int c = 0; c < kComponents; ++c) {
      const double unit = IsAngle(static_cast<Component>(c)) ? units::arcsec : units::um;
      errors.value[c].push_back(rows.at(row).at(c).get<double>() * unit);
    }
  }
  return errors;
}

Scenario OracleScenario(const std::string& clamping) {
  std::ifstream in(test::DataPath("oracle/full_circle_" + clamping + "_truth.json"));
  const nlohmann::json truth = nlohmann::json::parse(in);
  Scenario scenario;
  scenario.noise_free = true;
  scenario.target.errors = OracleErrors(truth.at("target"), false);
  scenario.reference.errors = OracleErrors(truth.at("reference_rotor_frame"), true);
  scenario.procedure.phases = {"full_circle"};
  scenario.procedure.passes = {1};
  scenario.procedure.clamping = clamping;
  return scenario;
}

class FullCircleOracle : public ::testing::TestWithParam<const char*> {};

TEST_P(FullCircleOracle, TheTwinReadsTheIndependentValuesToANanometre) {
  const Scenario scenario = OracleScenario(GetParam());
  const auto oracle = ReadReadingsCsv(test::DataPath(std::string("oracle/full_circle_") + GetParam() + ".csv"));
  const auto readings = test::RunTwin(scenario).readings;
  ASSERT_EQ(readings.size(), oracle.size());
  // 1 nm on the PSD; the file itself is rounded to 1 nV, half a femtometre.
  const double one_nm_V = units::nm * scenario.psd_a.sensitivity_V_m;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    EXPECT_EQ(readings[k].setup, oracle[k].setup);
    EXPECT_EQ(readings[k].position, oracle[k].position);
    EXPECT_NEAR(readings[k].target_rad, oracle[k].target_rad, 1e-9);
    EXPECT_NEAR(readings[k].reference_rad, oracle[k].reference_rad, 1e-9);
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(readings[k].mean_V[c], oracle[k].mean_V[c], one_nm_V);
  }
}

INSTANTIATE_TEST_SUITE_P(BothClampings, FullCircleOracle, ::testing::Values("reclamp", "reseat"));

}  // namespace
}  // namespace twinbench
