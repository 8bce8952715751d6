#include <gtest/gtest.h>

#include "twin/benches/registry.h"
#include "twin/benches/turntable_autocollimator/estimators/turntable_bench.h"
#include "twin/core/run_record.h"
#include "twin/core/units.h"
#include "twin/procedure/options.h"

namespace twinbench::separate::turntable {
namespace {

/// Errors of 150 arcsec, so that an autocollimator that bends by 20 arcsec at 410 shows.
constexpr const char* kScenario = R"(bench = "turntable_autocollimator"
seed = 6
[turntable]
harmonics = [{ order = 1, amplitude_arcsec = 150.0, phase_deg = 40.0 }]
[turntable.random]
ez_arcsec = 0.0
[multitooth]
tooth_rms_arcsec = 0.0
[autocollimator]
noise_arcsec = 0.001
[turntable_procedure]
phases = ["full_circle"]
positions = 12
)";

Eigen::VectorXd Separated_arcsec(const std::vector<std::string>& overrides) {
  const Scenario scenario = ParseScenario(kScenario, "test", "", overrides);
  const auto twin = BenchOf(scenario).make_twin(scenario);
  const auto record = RunRecord::CreateInMemory({"", "twin", scenario.seed, "", scenario.bench});
  twin->CarryOut(*record, [](const procedure::Progress&) {});
  return AnalyseTurntable(record->Readings(), scenario, Estimator::kRigorous).separation->turntable.value_rad /
         units::arcsec;
}

TEST(CollimatorScale, IsTakenOutAsTheScenarioSaysIt) {
  const Eigen::VectorXd plain = Separated_arcsec({});
  ASSERT_NEAR(plain.maxCoeff(), 150.0, 5.0);
  for (const char* key : {"autocollimator.gain_error=0.02", "autocollimator.error_at_edge_arcsec=20"}) {
    SCOPED_TRACE(key);
    EXPECT_LT((Separated_arcsec({key}) - plain).cwiseAbs().maxCoeff(), 0.01);
  }
}

}  // namespace
}  // namespace twinbench::separate::turntable
