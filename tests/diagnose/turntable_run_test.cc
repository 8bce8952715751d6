#include "tests/core/input_error.h"
#include "tests/diagnose/support/synthetic_run.h"
#include "tests/diagnose/turntable_bench.h"
#include "tests/support/kept_text.h"
#include "twin/benches/registry.h"
#include "twin/benches/turntable_autocollimator/bench.h"

// The forward model of the turntable bench: what it predicts, and what its unknowns absorb.
namespace twinbench::diagnose::turntable {
namespace {

using test::BenchReadings, test::CarefulScenario, test::PublishedScenario, test::Wrong;
using units::arcsec;

LinearRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return benches::turntable::Linear(readings, scenario, Estimator::kRigorous);
}

/// What the unknowns cannot absorb, in units of the stated noise.
double LeftOver(const LinearRun& run) {
  const NoiseModel noise{run.sigma, {}};
  const Projector projector = ProjectorOf(run, noise);
  const Eigen::MatrixXd white = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  return projector.Apply(white).cwiseAbs().maxCoeff();
}

Scenario Quiet(Scenario scenario) {
  scenario.noise_free = true;
  return scenario;
}

TEST(TurntableRun, AbsorbsAWholeBenchThatIsAsStated) {
  for (Scenario scenario : {CarefulScenario(), PublishedScenario()}) {
    // The slope of the turntable's error along the sweep costs its prior.
    EXPECT_LT(LeftOver(RunOf(BenchReadings(Quiet(scenario), {}, 4), scenario)), 0.2);
    // Three shifts meet other teeth, whose errors of 0.1 arcsec cost their prior.
    scenario = Altered(
        scenario, {"turntable_procedure.shifts_teeth=[0, 25, 85]", "turntable_procedure.tilts_arcsec=[60, 100, 80]",
                   "turntable_procedure.tilt_azimuths_deg=[0]"});
    EXPECT_LT(LeftOver(RunOf(BenchReadings(Quiet(scenario), {}, 4), scenario)), 0.5);
  }
}

TEST(TurntableRun, BelievesTheStatedInstrument) {
  // In a sweep the mirror, which stands before the axis, moves aside of the beam: 0.2 arcsec at 2 um, which the
  // independent bench leaves out.
  const std::vector<std::string> stated = {"autocollimator.roll_mrad=10", "autocollimator.gain_error=0.01",
                                           "autocollimator.x_per_kelvin_arcsec=3", "mirror.flatness_nm=200",
                                           "turntable.backlash_arcsec=2"};
  Scenario scenario = Altered(CarefulScenario(), stated);
  TurntableOf(scenario).turntable_procedure.eccentricities_m = {50e-6, 9e-3};
  Wrong as_stated{.kelvin_rad = {3.0 * arcsec, 0.0}, .backlash_rad = 2.0 * arcsec};
  const std::vector<Reading> readings = BenchReadings(Quiet(scenario), as_stated, 4);
  EXPECT_LT(LeftOver(RunOf(readings, scenario)), 0.2);
  for (const std::string& alone : stated)
    EXPECT_GT(LeftOver(RunOf(readings, Altered(scenario, {alone.substr(0, alone.find('=')) + "=0"}))), 1.0)
        << alone;
}

/// Index error and tilt of each.
Eigen::Index FreeTeeth(const Scenario& scenario) {
  const Eigen::Index positions = TurntableOf(scenario).turntable_procedure.positions,
                     of_mounting = 4 * TurntableOf(scenario).turntable_procedure.SetUps();
  const Eigen::Index all = RunOf(BenchReadings(scenario, {}, 4), scenario).nuisance.jacobian.cols();
  return (all - 2 * positions - of_mounting) / 2;
}

TEST(TurntableRun, TellsTeethFromPositionsOnlyWhereAShiftDoes) {
  Scenario scenario = PublishedScenario();
  EXPECT_EQ(FreeTeeth(scenario), 0);
  TurntableOf(scenario).turntable_procedure.shifts = {0, 25};
  EXPECT_EQ(FreeTeeth(scenario), 72);  // 25 teeth are five steps: the same teeth again
  TurntableOf(scenario).turntable_procedure.shifts = {0, 3};
  EXPECT_EQ(FreeTeeth(scenario), 144);
}

TEST(TurntableRun, LeavesOutReadingsWithoutBothValues) {
  const Scenario scenario = CarefulScenario();
  std::vector<Reading> readings = BenchReadings(scenario, {}, 4);
  readings[20].autocollimator_tilt_rad = kNaN;
  readings[30].status = ReadingStatus::kNoLight;
  EXPECT_EQ(RunOf(readings, scenario).schedule.Readings() + 2, std::ssize(readings));
  readings.resize(7);
  EXPECT_THROW(RunOf(readings, scenario), InputError);
}

TEST(TurntableRun, IsRefusedWhereOnePassOfOneSetUpLeavesNothingToCompare) {
  Scenario scenario = PublishedScenario();
  TurntableOf(scenario).turntable_procedure.tilts_rad = {60 * arcsec};
  TurntableOf(scenario).turntable_procedure.tilt_azimuths_rad = {0.0};
  const std::string refusal = MessageOf([&] { Diagnose(BenchReadings(scenario, {}, 4), scenario); });
  EXPECT_THAT(refusal, testing::HasSubstr("turntable_procedure.passes = [1, -1]"));
  EXPECT_KEPT(refusal);
}

}  // namespace
}  // namespace twinbench::diagnose::turntable
