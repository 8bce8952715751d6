#include "twin/uncertainty/standards.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/twin_run.h"
#include "twin/benches/hob_transmission/settings.h"

namespace twinbench::uncertainty {
namespace {

Scenario Hob(const std::string& u_arcsec) {
  return LoadScenario(test::ScenarioPath("hob_transmission.toml"), {"interferometer.u_calibrator_arcsec=" + u_arcsec});
}

/// Both parts of every order of the calibrator scatter as it states, and what the scenario has in it is gone.
TEST(StandardsDrawn, DrawTheWavesOfACalibrator) {
  const Scenario scenario = Hob("0.2");
  constexpr int kTrials = 400;
  double real2 = 0.0, cross = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Scenario drawn = StandardsDrawn(scenario, 1, trial);
    const auto& waves = HobOf(drawn).interferometer.calibrator;
    ASSERT_EQ(waves.size(), 10U);
    EXPECT_EQ(waves[0].order, 1.0);
    const double real = waves[0].amplitude * std::cos(waves[0].phase_rad),
                 imaginary = waves[0].amplitude * std::sin(waves[0].phase_rad);
    real2 += real * real / kTrials;
    cross += real * imaginary / kTrials;
  }
  const double u = 0.2 * units::arcsec;
  EXPECT_NEAR(real2 / (u * u), 1.0, 0.25) << "400 trials: 7 % standard deviation";
  EXPECT_NEAR(cross / (u * u), 0.0, 0.2);
}

TEST(StandardsDrawn, LeaveACalibratorAloneThatIsSure) {
  EXPECT_TRUE(StatesStandards(Hob("0.2")));
  EXPECT_FALSE(StatesStandards(Hob("0.0")));
  EXPECT_EQ(HobOf(StandardsDrawn(Hob("0.0"), 1, 3)).interferometer.calibrator.size(), 2U);
}

}  // namespace
}  // namespace twinbench::uncertainty
