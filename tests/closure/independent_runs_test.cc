#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/truth_rows.h"
#include "tests/support/twin_run.h"

// Noisy runs of the reference bench without any hidden effect, made by an implementation that shares nothing with
// ours.
namespace twinbench {
namespace {

using separate::Separation;
using separate::Table;

double MeanChi2(const Separation& s, Table table, const TableErrors& all, Component c) {
  const TableErrors truth = separate::RemoveNotSeparable(all, table, s.not_separable);
  const auto& estimate = table == Table::kTarget ? s.target : s.reference;
  double sum = 0.0;
  for (std::size_t k = 0; k < truth[c].size(); ++k)
    sum += std::pow((estimate.value[c][k] - truth[c][k]) / estimate.u[c][k], 2);
  return sum / static_cast<double>(truth[c].size());
}

class IndependentRun : public ::testing::TestWithParam<const char*> {};

TEST_P(IndependentRun, IsSeparatedWithinTheStatedUncertainties) {
  const std::string folder = test::DataPath(std::string("challenge/") + GetParam());
  test::TwinRun run;
  run.scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  run.readings = ReadReadingsCsv(folder + "/readings.csv");
  const nlohmann::json tables = test::ReadTruthFile(folder + "/truth.json").at("tables");
  const Separation s = test::Evaluate(run);
  const TableErrors target = test::ErrorsOfRows(tables.at("target"), false);
  const TableErrors reference = test::ErrorsOfRows(tables.at("reference_rotor_frame"), true);
  for (const Component c : {Component::kEx, Component::kEy, Component::kEz, Component::kDy}) {
    // 36 values, correlated over positions: mean 1, deviation about sqrt(2 / 18) = 0.33; three and a half of these.
    for (const double chi2 :
         {MeanChi2(s, Table::kTarget, target, c), MeanChi2(s, Table::kReference, reference, c)}) {
      EXPECT_GT(chi2, 0.2) << static_cast<int>(c);
      EXPECT_LT(chi2, 2.2) << static_cast<int>(c);
    }
  }
  EXPECT_EQ(s.scale, Eigen::Vector4d::Ones().eval()) << "nothing is hidden here, so nothing may exceed the noise";
}

INSTANTIATE_TEST_SUITE_P(CleanCases, IndependentRun, ::testing::Values("002", "005", "013", "020"));

}  // namespace
}  // namespace twinbench
