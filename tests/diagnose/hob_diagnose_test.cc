#include "tests/diagnose/found_causes.h"
#include "tests/diagnose/hob_chain.h"
#include "tests/support/angle_benches.h"
#include "tests/support/thresholds.h"
#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/registry.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/scenario_text.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"
#include "twin/diagnose/extend.h"

/// Readings of a chain with a hidden cause (tests/diagnose/hob_chain.h), and what the diagnosis says of them.
namespace twinbench::diagnose::hob {
namespace {

using test::HiddenCause, test::HobChain;
using units::arcsec, units::deg;

/// "hob_runout", "eccentricity hob".
std::string NameOf(const std::string& effect, const std::string& where) {
  return where.empty() ? effect : effect + " " + where;
}

HobChain Short() {
  return {.turns = 2, .seed = 7};
}

DiagnosisRun DiagnosisOf(const HobChain& chain) {
  return Diagnose(ReadingsOf(chain), ScenarioOf(chain), twinbench::test::QuickOptions());
}

std::set<std::string> NamesIn(const Diagnosis& diagnosis) {
  std::set<std::string> names;
  for (const Cause& cause : diagnosis.causes) names.insert(NameOf(cause.effect, cause.where));
  return names;
}

struct Trial {
  HiddenCause cause;
  std::set<std::string> alike = {};  // that these readings cannot tell from it
  bool interferometer = false;
};

void PrintTo(const Trial& trial, std::ostream* out) {
  *out << NameOf(trial.cause.name, trial.cause.where) << (trial.interferometer ? ", watched" : "");
}

/// The saw-tooth of counts repeats with each turn, and at a steady speed in time.
TEST(HobDiagnosis, WavesNoLargerThanCountsLeaveAreNotSure) {
  const HobChain chain = Short();
  std::vector<Reading> readings = ReadingsOf(chain);
  const double count_rad = 2.0 * units::kPi / 2000.0;
  for (Reading& r : readings) r.reference_rad = count_rad * std::round(r.reference_rad / count_rad);
  const DiagnosisRun run = Diagnose(readings, ScenarioOf(chain), twinbench::test::QuickOptions());
  for (const Cause& cause : run.diagnosis.causes) {
    if (cause.effect != "periodic" && cause.effect != "tone") continue;
    EXPECT_LE(cause.probability, 0.5) << test::Told(run);
  }
}

class HiddenHobCause : public ::testing::TestWithParam<Trial> {};

TEST_P(HiddenHobCause, IsNamedOrTiedWithWhatLooksTheSame) {
  const Trial& trial = GetParam();
  HobChain chain = Short();
  chain.interferometer = trial.interferometer;
  chain.hidden = {trial.cause};
  const DiagnosisRun run = DiagnosisOf(chain);
  const std::string own = NameOf(trial.cause.name, trial.cause.where);
  const std::set<std::string> names = NamesIn(run.diagnosis);
  SCOPED_TRACE(test::Told(run));
  EXPECT_TRUE(names.contains(own));
  for (const std::string& name : names) EXPECT_TRUE(name == own || trial.alike.contains(name)) << name;
  EXPECT_EQ(run.diagnosis.verdict, names.size() > 1 ? Verdict::kTie : Verdict::kNamed);
  if (own == "hob_runout" && names.size() > 1) {  // what splits a tie
    EXPECT_NE(run.diagnosis.causes[0].next_measurement.find("interferometer"), std::string::npos);
  }
  for (const Cause& cause : run.diagnosis.causes) {
    if (NameOf(cause.effect, cause.where) != own) continue;
    for (const ParameterEstimate& p : cause.parameters) {
      double error = p.value - trial.cause.value.at(p.name);
      if (p.name == "phase") error = std::remainder(error, 2.0 * units::kPi);
      // Whole numbers have no uncertainty.
      EXPECT_LE(std::abs(error), std::max(3.0 * p.u, 1e-12)) << p.name;
    }
  }
}

const std::set<std::string> kBehind = {"backlash", "latency", "hysteresis"};

// Signatures of 20 to 60 times the noise: some tenths of an arcsecond at the table.
INSTANTIATE_TEST_SUITE_P(
    Causes, HiddenHobCause,
    ::testing::Values(
        Trial{{"eccentricity", "table", {{"amplitude", 0.1 * arcsec}, {"phase", 1.0}}}},
        Trial{{"eccentricity", "hob", {{"amplitude", 2.0 * arcsec}, {"phase", 5.0}}}, {"hob_runout"}},
        Trial{{"eccentricity", "hob", {{"amplitude", 2.0 * arcsec}, {"phase", 5.0}}}, {}, true},
        Trial{{"ellipticity", "table", {{"amplitude", 1.5 * arcsec}, {"phase", 2.0}}}},
        Trial{{"ellipticity", "hob", {{"amplitude", 2.0 * arcsec}, {"phase", 0.3}}}, {"gear_mesh"}},
        Trial{{"periodic", "table", {{"order", 7.0}, {"amplitude", 0.1 * arcsec}, {"phase", 4.0}}}},
        Trial{{"periodic", "hob", {{"order", 4.0}, {"amplitude", 3.0 * arcsec}, {"phase", 4.0}}}},
        Trial{{"signal_offset", "", {{"offset_sin", 0.1}, {"offset_cos", -0.05}}}},
        Trial{{"amplitude_mismatch", "", {{"ratio", 0.2}}}}, Trial{{"quadrature_error", "", {{"angle", 0.2}}}},
        Trial{{"hob_runout", "", {{"amplitude", 0.1 * arcsec}, {"phase", 6.0}}}, {"eccentricity hob"}},
        Trial{{"hob_runout", "", {{"amplitude", 0.1 * arcsec}, {"phase", 6.0}}}, {}, true},
        Trial{{"worm", "", {{"amplitude", 0.1 * arcsec}, {"phase", 2.5}}}},
        Trial{{"gear_mesh", "", {{"amplitude", 0.1 * arcsec}, {"phase", 2.5}}}, {"ellipticity hob"}},
        Trial{{"backlash", "", {{"width", 0.2 * arcsec}}}, kBehind},
        Trial{{"latency", "", {{"delay", 2e-6}}}, kBehind}, Trial{{"latency", "", {{"delay", 2e-6}}}, {}, true},
        Trial{{"hysteresis", "", {{"lag", 1.0 * arcsec}, {"settles_over", 40.0 * deg}}}},
        Trial{{"drift", "", {{"rate", 10.0 * arcsec / units::hour}, {"curvature", 0.5}}}},
        Trial{{"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 2000.0}}}, {"slip hob"}},
        Trial{{"slip", "hob", {{"step", 5.0 * arcsec}, {"at_reading", 4000.0}}}, {"slip table"}},
        Trial{{"tone", "", {{"amplitude", 0.1 * arcsec}, {"frequency", 0.3}, {"phase", 1.0}}}},
        Trial{{"outliers", "", {{"fraction", 0.003}, {"size", 10.0 * arcsec}}}}));

/// Encoders of a train of 40 to 1 against each other, forth and back: the table errs once per turn of the hob.
std::vector<Reading> OnceATurnOfTheHob(double error_arcsec, std::uint64_t seed) {
  Stream noise(seed, "once_a_turn");
  std::vector<Reading> readings;
  constexpr int kRows = 2 * 40 * 18;
  for (int i = 0; i < 2 * kRows; ++i) {
    Reading r{.reading = i, .pass = i < kRows ? 0 : 1, .direction = i < kRows ? 1 : -1, .position = i % kRows,
              .reference_rad = (i < kRows ? i : 2 * kRows - 1 - i) * 20.0 * deg, .velocity_rad_s = kNaN,
              .head_rad = 0.0};
    r.measured_rad = r.reference_rad / 40.0 + arcsec * (error_arcsec * std::cos(r.reference_rad - 0.7) + 0.2 * noise.Normal());
    readings.push_back(r);
  }
  return readings;
}

/// By 1600 arcsec of the hob its wave bends: nothing of that is evidence for one of the names, for none or for a further one.
TEST(HobDiagnosis, SaysTheSameOfWhatLooksTheSameHoweverLargeItIs) {
  const Scenario train = ParseScenario(
      "bench = \"hob_transmission\"\n[transmission]\ngear_teeth = 40\nhob_starts = 1\nworm_wheel_teeth = 0\n"
      "[hob_encoder]\nlines = 10000000\n[hob_procedure]\nheads_deg = [0]\n[interferometer]\nused = false\n",
      "test", "");
  for (const double error_arcsec : {2.0, 15.0, 30.0, 40.0, 60.0, 100.0}) {
    const Diagnosis found = Diagnose(OnceATurnOfTheHob(error_arcsec, 3), train, twinbench::test::QuickOptions()).diagnosis;
    EXPECT_EQ(found.verdict, Verdict::kTie) << error_arcsec;
    EXPECT_EQ(NamesIn(found), (std::set<std::string>{"gear_mesh", "hob_runout", "eccentricity hob"})) << error_arcsec;
    EXPECT_EQ(found.causes.front().effect, "hob_runout") << error_arcsec;
    EXPECT_TRUE(found.unknown.signature.empty()) << found.unknown.signature;
  }
}

TEST(HobDiagnosis, TellsADelayFromAGapAtTwoSpeeds) {
  HobChain chain = Short();
  chain.hob_speeds_rev_min = {50.0, 25.0};
  chain.hidden = {{"latency", "", {{"delay", 2e-6}}}};
  EXPECT_EQ(NamesIn(DiagnosisOf(chain).diagnosis), (std::set<std::string>{"latency"}));
  chain.hidden = {{"backlash", "", {{"width", 0.2 * arcsec}}}};
  EXPECT_FALSE(NamesIn(DiagnosisOf(chain).diagnosis).contains("latency"));
}

TEST(HobDiagnosis, ListsWhatOppositeHeadsCannotSeeWithWhatItWouldBias) {
  HobChain chain = Short();
  chain.heads_deg = {0.0, 180.0};
  chain.hidden = {{"ellipticity", "table", {{"amplitude", 5.0 * arcsec}, {"phase", 1.0}}}};
  const Diagnosis diagnosis = DiagnosisOf(chain).diagnosis;
  EXPECT_EQ(diagnosis.verdict, Verdict::kNone);  // it goes into order 2 of the transmission
  EXPECT_THAT(test::CouldBias(diagnosis, "ellipticity", "table"), testing::HasSubstr("transmission of order 2"));
  EXPECT_THAT(test::CouldBias(diagnosis, "eccentricity", "table"), testing::HasSubstr("would be seen"));
}

TEST(HobDiagnosis, SeesTheRingOfOneHeadAgainstTheInterferometer) {
  HobChain chain = Short();
  chain.heads_deg = {0.0};
  EXPECT_THAT(test::CouldBias(DiagnosisOf(chain).diagnosis, "eccentricity", "table"),
              testing::Not(testing::HasSubstr("would be seen")));
  chain.interferometer = true;
  chain.hidden = {{"eccentricity", "table", {{"amplitude", 0.2 * arcsec}, {"phase", 1.0}}}};
  EXPECT_EQ(NamesIn(DiagnosisOf(chain).diagnosis), (std::set<std::string>{"eccentricity table"}));
}

TEST(HobDiagnosis, TabulatesTheLinesOfTheChain) {
  HobChain chain = Short();
  chain.hidden = {{"worm", "", {{"amplitude", 1.0 * arcsec}, {"phase", 2.0}}},
                  {"hob_runout", "", {{"amplitude", 2.0 * arcsec}, {"phase", 1.0}}}};
  const Diagnosis diagnosis = DiagnosisOf(chain).diagnosis;
  std::map<int, Harmonic> by_order;
  for (const Harmonic& h : diagnosis.harmonics) by_order[h.order] = h;
  for (const int order : {1, 2, 12, 22, 44, 90}) ASSERT_TRUE(by_order.contains(order)) << order;
  // u = 0.06 arcsec / sqrt(1920 / 2) = 0.002 arcsec.
  EXPECT_NEAR(by_order[22].amplitude_rad / arcsec, 2.0, 0.01);
  EXPECT_NEAR(by_order[90].amplitude_rad / arcsec, 1.0, 0.01);
  EXPECT_NE(by_order[90].meaning.find("worm"), std::string::npos);
}

HobChain Quiet() {
  return {.turns = 1, .table_noise_arcsec = 0.0, .hob_noise_arcsec = 0.0, .hob_steps = false};
}

LinearRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return benches::hob::Linear(readings, scenario, Estimator::kRigorous);
}

/// Rms that the free unknowns leave.
double Left_rad(const LinearRun& run) {
  const Eigen::MatrixXd free = run.nuisance.jacobian.toDense();
  const Eigen::VectorXd left = run.residual - free * SolveShortest(free, run.residual);
  return left.norm() / std::sqrt(static_cast<double>(left.size()));
}

/// The ring's geometry: its middle is off by e towards azimuth A on it, where azimuths run against its angle s. The
/// line under the head then has the azimuth -(s + e / R sin(s + A)): it shows e / R cos(s + A - 90 deg) too much.
TEST(HobRun, TakesOffTheStatedEccentricityOfTheRing) {
  const double amplitude_rad = 6.0 * arcsec;
  HobChain chain = Quiet();
  chain.hidden = {{"eccentricity", "table", {{"amplitude", amplitude_rad}, {"phase", 40.0 * deg - 90.0 * deg}}}};
  Scenario scenario = ScenarioOf(chain);
  HobOf(scenario).table_encoder.radius_m = 0.1;
  HobOf(scenario).table_encoder.eccentricity_m = 0.1 * amplitude_rad;
  HobOf(scenario).table_encoder.eccentricity_azimuth_rad = 40.0 * deg;
  EXPECT_LT(Left_rad(RunOf(ReadingsOf(chain), scenario)), 1e-3 * arcsec);
}

TEST(HobRun, TakesSamplesTogetherAsFarAsTheWormKeepsItsSize) {
  HobChain chain;
  const LinearRun run = RunOf(ReadingsOf(chain), ScenarioOf(chain));
  // A mean over three of 720 samples leaves sin(3 x) / (3 sin x) = 0.805 of order 90 (x = 22.5 deg); over four
  // 0.65.
  EXPECT_EQ(run.Rows(), 2 * 2 * 3 * 240);
  // Noise of one sample: 0.1 arcsec of the table, 0.5 / 22 of the hob, and the hob's steps of 1.44 / 22 / sqrt(12).
  EXPECT_NEAR(run.sigma[0] / arcsec, std::hypot(0.1, 0.5 / 22.0, 1.44 / 22.0 / std::sqrt(12.0)) / std::sqrt(3.0),
              1e-6);
  EXPECT_TRUE(run.sigma_stated);
}

TEST(HobRun, EstimatesANoiseThatNobodyTold) {
  HobChain chain;
  chain.noise_told = false;
  chain.hidden = {{"worm", "", {{"amplitude", 2.0 * arcsec}, {"phase", 3.0}}}};  // repeats from turn to turn
  const std::vector<Reading> readings = ReadingsOf(chain);
  const LinearRun run = RunOf(readings, ScenarioOf(chain));
  EXPECT_FALSE(run.sigma_stated);
  const double truth_rad = std::hypot(0.1, 0.5 / 22.0, 1.44 / 22.0 / std::sqrt(12.0)) * arcsec;
  // 8640 samples say 1 / sqrt(8640) = 1 %; what repeats of the steps' errors from turn to turn is not seen: 3 %.
  const double together = static_cast<double>(readings.size()) / run.Rows();
  EXPECT_NEAR(run.sigma[0] * std::sqrt(together) / truth_rad, 1.0, 0.06);
}

// Angles that an encoder shows have its noise: of those that lie near each other the errors lie in the same order.
TEST(HobRun, EstimatesTheNoiseOfTheEncoderThatShowsTheAngle) {
  const auto with_noise = [](const char* noise) {
    return LoadScenario(twinbench::test::ScenarioPath("hob_transmission.toml"), {"hob_encoder.noise_arcsec=0", noise});
  };
  const std::vector<Reading> readings = twinbench::test::RunBench(with_noise("table_encoder.noise_arcsec=0.1")).readings;
  const LinearRun run = RunOf(readings, with_noise("table_encoder.noise_arcsec=0"));
  const double together = static_cast<double>(readings.size()) / run.Rows();
  EXPECT_NEAR(run.sigma[0] * std::sqrt(together) / (0.1 * arcsec), 1.0, 0.06);
}

TEST(HobRun, LeavesOutSamplesThatLieFarOutsideButNoStep) {
  HobChain chain;
  chain.hidden = {{"outliers", "", {{"fraction", 0.003}, {"size", 10.0 * arcsec}}},
                  {"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 2000.0}}}};
  const std::vector<Reading> readings = ReadingsOf(chain);
  chain.hidden.erase(chain.hidden.begin());
  const std::vector<Reading> without = ReadingsOf(chain);
  int far = 0;  // beyond ten deviations of the noise of a sample
  for (std::size_t i = 0; i < readings.size(); ++i)
    far += std::abs(readings[i].measured_rad - without[i].measured_rad) > 1.0 * arcsec;
  const LinearRun run = RunOf(readings, ScenarioOf(chain));
  // A row is the mean of three samples at most, and says by its noise of how many.
  const double used = 3.0 * (run.sigma.minCoeff() / run.sigma.array()).square().sum();
  const int left_out = static_cast<int>(readings.size()) - static_cast<int>(std::lround(used));
  EXPECT_GE(left_out, far);
  EXPECT_LE(left_out, far + 3);  // of smaller ones one in twenty is as far
}

TEST(HobRun, NeedsTheHeadOfEverySetUp) {
  HobChain chain = Quiet();
  std::vector<Reading> readings = ReadingsOf(chain);
  readings[20].head_rad = kNaN;
  EXPECT_THROW(RunOf(readings, ScenarioOf(chain)), InputError);
}

}  // namespace
}  // namespace twinbench::diagnose::hob
