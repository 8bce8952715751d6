#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/separate/bench.h"
#include "tests/support/truth_rows.h"

namespace twinbench::separate {
namespace {

using nlohmann::json;

const std::string kOracle = std::string(TWINBENCH_TEST_DATA) + "/oracle/full_circle_";

Truth OracleTruth(const std::string& mode) {
  const json truth = test::ReadTruthFile(kOracle + mode + "_truth.json");
  return {test::ErrorsOfRows(truth.at("target"), false),
          test::ErrorsOfRows(truth.at("reference_rotor_frame"), true)};
}

Separation SeparateOracle(const std::string& mode, Estimator estimator = Estimator::kRigorous) {
  const auto readings = ReadReadingsCsv(kOracle + mode + ".csv");
  const auto motions = measure::Measure(readings, Bench(), measure::Calibration{}, estimator);
  return Separate(motions, Bench(),
                  Options(36, mode == "reclamp" ? Clamping::kReclamp : Clamping::kReseat, estimator));
}

class Oracle : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Modes, Oracle, testing::Values("reclamp", "reseat"));

TEST_P(Oracle, ComesBackWithZeroMeanAndWithinTheUncertaintyOfARunWithoutNoise) {
  const Separation found = SeparateOracle(GetParam());
  double largest = 0.0;
  for (const test::SeparatedTable& t : test::BothTables(found, OracleTruth(GetParam()))) {
    for (const Component c : t.estimate.components) {
      // The acceptance limit of the bench; what is left is third order and the nine digits of the files.
      EXPECT_LT(t.RmsError(c), IsAngle(c) ? 0.02 * units::arcsec : 0.02 * units::um) << t.Name(c);
      largest = std::max(largest, t.ErrorOverU(c));
      const std::vector<double>& values = t.estimate.value[c];
      EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0), 0.0, 1e-16);  // 36 values of 1e-5: rounding
    }
  }
  EXPECT_LT(found.residual_rms.head<3>().maxCoeff(), 0.01 * units::arcsec);
  // The second-order terms nobody reads are known by size only: of order 1, within three.
  EXPECT_LT(largest, 3.0);
  EXPECT_GT(largest, 0.1);
}

TEST(OracleRuns, OfReclampGivesBothRadialComponentsOfTheReferenceAndReseatOnlyOne) {
  const json reclamp = ToJson(SeparateOracle("reclamp")), reseat = ToJson(SeparateOracle("reseat"));
  EXPECT_EQ(reclamp["reference"].count("dx_um"), 1u);
  EXPECT_EQ(reseat["reference"].count("dx_um"), 0u);
  EXPECT_EQ(reclamp["target"].count("dx_um"), 0u);
  EXPECT_EQ(reseat["target"]["position_deg"].size(), 36u);
  EXPECT_NEAR(reseat["target"]["position_deg"][35].get<double>(), 350.0, 1e-9);  // rounding
}

TEST(OracleRuns, ShowsWhatThePublishedEquationsMissWhenTheGratingIsReclamped) {
  // Same tables, same readings: the scalar equations are right in `reseat` up to order one, wrong in `reclamp` by
  // the full wobble of the reference (docs/theory.md 3.1: 1.5 arcsec of 2).
  const Separation reclamp = SeparateOracle("reclamp", Estimator::kPublished);
  EXPECT_GT(test::BothTables(reclamp, OracleTruth("reclamp"))[0].RmsError(Component::kEx), 1.0 * units::arcsec);
}

}  // namespace
}  // namespace twinbench::separate
