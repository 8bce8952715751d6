#include <utility>

#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/turntable_bench.h"
#include "tests/support/angle_benches.h"
#include "tests/support/noise.h"
#include "tests/support/thresholds.h"
#include "twin/diagnose/extend.h"

// Whole diagnoses of readings that the independent bench made, with noise.
namespace twinbench::diagnose::turntable {
namespace {

using test::BenchReadings, test::CarefulScenario, test::PublishedScenario, test::Wrong;
using testing::AnyOf, testing::HasSubstr;
using units::arcsec;

DiagnosisRun Diagnosed(const std::vector<Reading>& readings, const Scenario& scenario) {
  return Diagnose(readings, scenario, twinbench::test::QuickOptions());
}

DiagnosisRun DiagnosisOf(const Scenario& scenario, const Wrong& wrong, std::uint64_t seed = 21) {
  return Diagnosed(BenchReadings(scenario, wrong, seed), scenario);
}

/// The only cause, if there is one and it is this.
const Cause* OnlyCause(const DiagnosisRun& run, const std::string& effect, const std::string& where = "") {
  const std::vector<Cause>& causes = run.diagnosis.causes;
  const bool alone = run.diagnosis.verdict == Verdict::kNamed && causes.size() == 1;
  return alone && causes[0].effect == effect && causes[0].where == where ? &causes[0] : nullptr;
}

const ParameterEstimate& ParameterOf(const Cause& cause, const std::string& name) {
  return *std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
}

/// What is wrong, and how it must be named.
struct Named {
  Wrong wrong;
  const char *effect, *where, *parameter;
  double value;
};

/// Named alone, with the parameter within three of its standard uncertainties.
void ExpectNamed(const Named& named, const Scenario& scenario = CarefulScenario()) {
  const DiagnosisRun run = DiagnosisOf(scenario, named.wrong);
  SCOPED_TRACE(std::string(named.effect) + " at " + named.where + "\n" + test::Told(run));
  const Cause* cause = OnlyCause(run, named.effect, named.where);
  ASSERT_TRUE(cause);
  EXPECT_LE(cause->probability, 0.97);
  const ParameterEstimate& p = ParameterOf(*cause, named.parameter);
  EXPECT_NEAR(p.value, named.value, 3.0 * p.u);
  EXPECT_LT(p.u, 0.3 * std::abs(named.value));
  EXPECT_GT(run.diagnosis.gain.folds, run.accepted.empty() ? -1 : 0);
}

// Two slips, up and down again, would explain it as well.
TEST(TurntableDiagnosis, TakesASingleDisturbedReadingForNoSlips) {
  Scenario sweep = CarefulScenario();
  TurntableOf(sweep).turntable_procedure.phases = {"calibration"};
  TurntableOf(sweep).turntable_procedure.sweep_points = 41;
  for (const std::size_t disturbed : {2u, 20u, 38u}) {
    std::vector<Reading> readings = twinbench::test::RunBench(sweep).readings;
    readings[disturbed].autocollimator_tilt_rad += 17.0 * TurntableOf(sweep).autocollimator.noise_rad;
    const DiagnosisRun run = Diagnosed(readings, sweep);
    EXPECT_TRUE(OnlyCause(run, "outliers")) << disturbed << ": " << test::Told(run);
  }
}

TEST(TurntableDiagnosis, NamesEveryFaultOfTheInstrumentAndWhatTheTurntableDoes) {
  for (const Named& named : std::vector<Named>{
           {{.roll_rad = 3e-3}, "autocollimator_roll", "", "angle", 3e-3},
           {{.gain_error = -0.005}, "autocollimator_scale", "", "gain_error", -0.005},
           {{.gain_error = 0.03}, "autocollimator_scale", "", "gain_error", 0.03},  // the calibration's readings are all far off
           {{.at_edge_rad = 8.0 * arcsec}, "autocollimator_nonlinearity", "", "at_edge", 8.0 * arcsec},
           {{.ripple_rad = {0.2 * arcsec, 0.0}}, "autocollimator_periodic", "x", "amplitude", 0.2 * arcsec},
           {{.ripple_rad = {0.0, 0.2 * arcsec}}, "autocollimator_periodic", "y", "amplitude", 0.2 * arcsec},
           {{.backlash_rad = 0.5 * arcsec}, "backlash", "", "width", 0.5 * arcsec},
           {{.settling_rad = 2.0 * arcsec, .settling_s = 2.5}, "settling", "", "time_constant", 2.5},
           // On arrival it is off by minutes of arc, of which the soonest reading shows an arc second: that is
           // thought of.
           {{.settling_rad = 300.0 * arcsec, .settling_s = 0.6}, "settling", "", "time_constant", 0.6},
           {{.seating_rad = 0.15 * arcsec}, "multitooth_seating", "", "scatter", 0.15 * arcsec}})
    ExpectNamed(named);
  EXPECT_TRUE(OnlyCause(DiagnosisOf(CarefulScenario(), {.spoilt = 0.01}), "outliers"));
  Scenario off_centre = CarefulScenario();
  TurntableOf(off_centre).turntable_procedure.eccentricities_m = {5e-3, 0.0};
  ExpectNamed({{.sag_m = 600e-9}, "mirror_flatness", "", "sag", 600e-9}, off_centre);
  const double roll_rad = 0.6 * units::deg;
  ExpectNamed({{.roll_rad = roll_rad}, "autocollimator_roll", "", "angle", roll_rad}, PublishedScenario());
}

// Each reading is of a new seat: of n values a standard deviation is known to 1 / sqrt(2 n) of it, and to a
// little less where unknowns are fitted to them as well.
TEST(TurntableDiagnosis, StatesTheSeatingsScatterAsWellAsSoManySeatsTellIt) {
  const Scenario scenario = CarefulScenario();
  const std::vector<Reading> readings = BenchReadings(scenario, {.seating_rad = 1.0 * arcsec}, 21);
  const DiagnosisRun run = Diagnosed(readings, scenario);
  const Cause* cause = OnlyCause(run, "multitooth_seating");
  ASSERT_TRUE(cause) << test::Told(run);
  const ParameterEstimate& scatter = ParameterOf(*cause, "scatter");
  const double of_seats = scatter.value / std::sqrt(2.0 * static_cast<double>(readings.size()));
  EXPECT_THAT(scatter.u, testing::AllOf(testing::Gt(0.9 * of_seats), testing::Lt(1.6 * of_seats)));
}

TEST(TurntableDiagnosis, NamesWhatMovesTheZeroInTime) {
  for (const std::size_t axis : {0u, 1u}) {
    const auto on_axis = [axis](double size) { return axis == 0 ? std::array{size, 0.0} : std::array{0.0, size}; };
    const char* where = axis == 0 ? "x" : "y";
    const double rate_rad_s = 3.0 * arcsec / units::hour;
    for (const Named& named : std::vector<Named>{
             {{.drift_rad_s = on_axis(rate_rad_s)}, "autocollimator_drift", where, "rate", rate_rad_s},
             {{.creep_rad = on_axis(0.2 * arcsec)}, "mount_creep", where, "amplitude", 0.2 * arcsec},
             {{.slip_rad = on_axis(0.4 * arcsec)}, "slip", where, "step", 0.4 * arcsec},
             {{.tone_rad = on_axis(0.2 * arcsec), .modulation = 0.1}, "tone", where, "amplitude", 0.2 * arcsec},
             {{.kelvin_rad = on_axis(2.0 * arcsec), .lag_s = 10.0}, "autocollimator_temperature", where,
              "coefficient", 2.0 * arcsec}})
      ExpectNamed(named);
  }
}

// Whose size and time constant stand for each other: neither is known, but that is no reason to believe in a drift.
TEST(TurntableDiagnosis, LeavesASlowCreepOpenBesideADrift) {
  for (const std::uint64_t seed : twinbench::test::Seeds({21u, 22u, 23u, 24u})) {
    const Wrong creep{.creep_rad = {0.0, 0.3 * arcsec}, .creep_s = 300.0};
    const DiagnosisRun run = DiagnosisOf(CarefulScenario(), creep, seed);
    std::vector<Cause> open = run.diagnosis.causes;
    open.insert(open.end(), run.less_likely.begin(), run.less_likely.end());
    const auto is_creep = [](const Cause& c) { return c.effect == "mount_creep" && c.where == "y"; };
    EXPECT_TRUE(std::ranges::any_of(open, is_creep)) << seed << "\n" << test::Told(run);
  }
}

/// Every cause once, with a probability and sizes.
void ExpectComplete(const std::vector<Cause>& suspects) {
  std::set<std::pair<std::string, std::string>> keys;
  double sum = 0.0;
  for (const Cause& suspect : suspects) {
    EXPECT_TRUE(keys.insert({suspect.effect, suspect.where}).second) << suspect.effect;
    EXPECT_GE(suspect.probability, 0.0) << suspect.effect;
    EXPECT_FALSE(suspect.parameters.empty()) << suspect.effect;
    sum += suspect.probability;
  }
  EXPECT_LE(sum, 1.0 + 1e-9);
  EXPECT_EQ(keys.count({"autocollimator_drift", "x"}) + keys.count({"autocollimator_drift", "y"}), 2u);
}

TEST(TurntableDiagnosis, SaysHowLargeEveryCauseWouldBeAlone) {
  const std::vector<Cause> suspects = DiagnosisOf(CarefulScenario(), {.backlash_rad = 0.5 * arcsec}).suspects;
  ExpectComplete(suspects);
  ASSERT_EQ(suspects.front().effect, "backlash");
  const ParameterEstimate& width = ParameterOf(suspects.front(), "width");
  EXPECT_NEAR(width.value, 0.5 * arcsec, 4.0 * width.u);
  EXPECT_GT(suspects.front().log_evidence, 20.0);
  ExpectComplete(DiagnosisOf(CarefulScenario(), Wrong{}).suspects);
}

// A wander follows a faint wave and the noise as well. Between two frequencies of the grid the wave is told
// nevertheless.
TEST(TurntableDiagnosis, NamesAFaintToneRatherThanAWander) {
  for (const double period_s : {470.0, 610.0, 700.0}) {
    SCOPED_TRACE(period_s);
    const Wrong tone{.tone_rad = {0.07 * arcsec, 0.0}, .tone_s = period_s};
    ExpectNamed({tone, "tone", "x", "frequency", 1.0 / period_s});
  }
}

// Faintly: the first of these is told by where a rectangle has its overtones only.
TEST(TurntableDiagnosis, TakesWhatSwitchesForNoTone) {
  const auto switching = [](const Reading& r) {
    const double turns = ToSeconds(r.time) / 260.0 + 0.13;
    return Eigen::Vector2d(turns - std::floor(turns) < 0.4 ? 0.2 * arcsec : 0.0, 0.0);
  };
  for (const std::uint64_t seed : twinbench::test::Seeds({32u, 33u, 34u}))
    EXPECT_GT(DiagnosisOf(CarefulScenario(), {.other = switching}, seed).diagnosis.unknown.probability, 0.7)
        << seed;
}

TEST(TurntableDiagnosis, CallsTheRollInvisibleWithOneTiltAndNoSweep) {
  const Scenario scenario = Altered(
      PublishedScenario(), {"turntable_procedure.tilts_arcsec=[60]", "turntable_procedure.tilt_azimuths_deg=[0]",
                            "turntable_procedure.passes=[1, -1]"});
  const Diagnosis d = DiagnosisOf(scenario, {.roll_rad = 10e-3}).diagnosis;
  EXPECT_EQ(d.verdict, Verdict::kNone);
  for (const char* effect : {"autocollimator_roll", "autocollimator_scale", "mirror_flatness"}) {
    EXPECT_THAT(test::CouldBias(d, effect), HasSubstr("turntable.ez of a position up to")) << effect;
  }
  EXPECT_THAT(test::CouldBias(d, "autocollimator_roll"), HasSubstr("another tilt of the multi-tooth table"));
}

TEST(TurntableDiagnosis, TiesBacklashAndSettlingWithOneDwell) {
  const Scenario scenario = Altered(CarefulScenario(), {"turntable_procedure.dwell_s=[1]"});
  const Diagnosis d = DiagnosisOf(scenario, {.backlash_rad = 0.6 * arcsec}).diagnosis;
  ASSERT_EQ(d.verdict, Verdict::kTie);
  ASSERT_EQ(d.causes.size(), 2u);
  for (const Cause& cause : d.causes) {
    EXPECT_THAT(cause.effect, AnyOf("backlash", "settling"));
    EXPECT_THAT(cause.next_measurement, HasSubstr("dwells from 0.5 to 20 s"));
  }
}

TEST(TurntableDiagnosis, ExtendsTheScenarioSoThatNothingIsLeft) {
  const Scenario scenario = CarefulScenario();
  const std::vector<Reading> readings =
      BenchReadings(scenario, {.roll_rad = 4e-3, .tone_rad = {0.0, 0.3 * arcsec}}, 21);
  const DiagnosisRun found = Diagnosed(readings, scenario);
  const Scenario extended = ParseScenario(ExtendedToml(scenario, found, "a test"), "extended.toml", "/elsewhere");
  EXPECT_EQ(Diagnosed(readings, extended).diagnosis.verdict, Verdict::kNone) << test::Told(found);
  EXPECT_EQ(extended.effects.size(), 2u);
}

}  // namespace
}  // namespace twinbench::diagnose::turntable
