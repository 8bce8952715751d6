#include "twin/separate/compensation.h"

#include "tests/support/angle_benches.h"

// A compensation that the twins are commanded by, and what another measurement then shows.
namespace twinbench {
namespace {

using separate::Compensation, separate::CompensationCheck, separate::IndexErrors, separate::LineFate;
using separate::RootMeanSquare, testing::ElementsAre, units::arcsec;

IndexErrors Measured(const Scenario& scenario) {
  return BenchOf(scenario).index_errors(scenario, test::ReadingsOf(scenario));
}

std::optional<CompensationTable>& TableOf(Scenario& scenario) {
  return scenario.bench == kHobBench ? HobOf(scenario).transmission.compensation
                                     : TurntableOf(scenario).turntable.compensation;
}

/// The same bench measured again with the table at work, of the hobbing machine in its gearbox; noise and teeth are
/// drawn anew.
Scenario Again(Scenario scenario, const Compensation& compensation) {
  TableOf(scenario) = compensation.table;
  scenario.seed += 100000;
  return scenario;
}

struct Mended {
  Compensation compensation;
  CompensationCheck check;
};
Mended MendedOf(const Scenario& scenario) {
  const IndexErrors first = Measured(scenario);
  const Compensation compensation = Compensate(first);
  return {compensation, CheckCompensation(first, compensation, Measured(Again(scenario, compensation)))};
}

Scenario Spectrum(const std::vector<std::string>& overrides = {}) {
  return LoadScenario(test::ScenarioPath("turntable_spectrum.toml"), overrides);
}

TEST(TurntableSpectrum, AnswersAsItsScenarioSays) {
  const auto [compensation, check] = MendedOf(Spectrum());
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1, 2, 3, 23, 48, 90, 144));
  EXPECT_THAT(compensation.Orders(LineFate::kAliased), ElementsAre(160));  // 200 in truth
  EXPECT_NEAR(compensation.remaining.before_rms_rad / arcsec, 5.8, 0.1);
  EXPECT_NEAR(check.remeasured_rms_rad / arcsec, 0.41, 0.04);  // 360 places: 4 %
  EXPECT_NEAR(check.Ratio(), 1.0, 0.2);
}

TEST(TurntableSpectrum, RefusesMoreFromThePositionsAlone) {
  const Scenario scenario = Spectrum({"turntable_procedure.phases=[\"full_circle\"]"});
  const Compensation compensation = Compensate(Measured(scenario));
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1, 2, 3));
  EXPECT_TRUE(compensation.IsAliased());
  // Measured between the positions, where an order that was taken for another would show: 0.5, 0.6, 1.0, 0.8 and
  // 0.4 arcsec are left, 1.1 rms, with 0.4 of noise and teeth.
  const IndexErrors after = Measured(Again(Spectrum(), compensation));
  EXPECT_NEAR(RootMeanSquare(AboutGroups(after, after.value_rad)) / arcsec, 1.15, 0.1);
}

// --- hobbing machine ---

Scenario DriveOrders(const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all = {"mechanics.fidelity=kinematic"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return LoadScenario(test::ScenarioPath("hob_drive_orders.toml"), all);
}

TEST(HobDriveOrders, AnswersAsItsScenarioSays) {
  const auto [compensation, check] = MendedOf(DriveOrders());
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1, 2, 3, 22, 90, 180, 200));
  EXPECT_FALSE(compensation.IsAliased());
  EXPECT_NEAR(compensation.remaining.before_rms_rad / arcsec, 7.2, 0.15);
  EXPECT_LT(check.remeasured_rms_rad / arcsec, 0.25);
  EXPECT_NEAR(check.Ratio(), 1.0, 0.2);
}

TEST(HobDriveOrders, RefusesMoreFromFewSamples) {
  const Scenario scenario = DriveOrders({"hob_procedure.samples_per_turn=72"});
  const Compensation compensation = Compensate(Measured(scenario));
  EXPECT_THAT(compensation.Orders(LineFate::kCompensated), ElementsAre(1, 2, 3));
  EXPECT_TRUE(compensation.IsAliased());
}

}  // namespace
}  // namespace twinbench
