#include "tests/support/in_parallel.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/separated_table.h"
#include "tests/support/truth_rows.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/tables.h"
#include "twin/core/linear_algebra.h"

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

TEST(IndependentRuns, AreSeparatedWithinTheStatedUncertainties) {
  for (const char* without_an_effect : {"002", "005", "013", "020"}) {
    SCOPED_TRACE(without_an_effect);
    const std::string folder = test::DataPath(std::string("challenge/") + without_an_effect);
    test::TwinRun run;
    run.scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
    run.readings = ReadReadingsCsv(folder + "/readings.csv");
    const separate::Separation s = test::Evaluate(run);
    const TrueTables truth = TablesOf(test::ReadTruthFile(folder + "/truth.json").at("tables"));
    for (const test::SeparatedTable& t : test::BothTables(s, truth)) {
      for (const Component c : {Component::kEx, Component::kEy, Component::kEz, Component::kDy}) {
        // 36 values, correlated over positions: mean 1, deviation about sqrt(2 / 18) = 0.33; three and a half of
        // these.
        EXPECT_GT(MeanChi2(t, c), 0.2) << t.Name(c);
        EXPECT_LT(MeanChi2(t, c), 2.2) << t.Name(c);
      }
    }
    EXPECT_EQ(s.scale, Eigen::Vector4d::Ones().eval()) << "nothing is hidden here, so nothing may exceed the noise";
  }
}

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

void ExpectOracle(const std::string& clamping, const std::string& fidelity) {
  SCOPED_TRACE(clamping + " " + fidelity);
  const Scenario scenario = OracleScenario(clamping, fidelity);
  const auto oracle = ReadReadingsCsv(test::DataPath("oracle/full_circle_" + clamping + ".csv"));
  const test::TwinRun run = test::RunTwin(scenario);
  const std::vector<Reading>& readings = run.readings;
  EXPECT_EQ(run.rays_traced > 0, fidelity == "traced");
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

TEST(FullCircleOracle, TheTwinReadsTheIndependentValuesToANanometre) {
  for (const char* clamping : {"reclamp", "reseat"})
    for (const char* fidelity : {"traced", "closed"}) ExpectOracle(clamping, fidelity);
}

constexpr int kSeeds = 200;

Scenario RandomTables(const std::string& clamping, const std::vector<std::string>& more) {
  const std::string tables =
      "bench = \"rotary_4dof\"\nmechanics.fidelity = \"kinematic\"\n"
      "target.random = { ex_arcsec = 4, ey_arcsec = 4, ez_arcsec = 5, dx_um = 2, dy_um = 2, dz_um = 1 }\n"
      "reference.random = { ex_arcsec = 8, ey_arcsec = 8, ez_arcsec = 15, dx_um = 3, dy_um = 3, dz_um = 2 }\n";
  return Altered(ParseScenario(tables, "tables.toml", "", {"procedure.clamping=" + clamping}), more);
}

/// Without a calibration gains are exact, so that only the readings scatter.
Scenario NoisyScenario(const std::string& clamping) {
  return RandomTables(clamping, {"procedure.phases=[\"full_circle\"]", "procedure.positions=12", "procedure.shifts=[0, 1, 4, 6]",
                                 "procedure.passes=[1, -1]", "adc.every_sample=false"});
}

/// Values of the components in one vector, in the order of TableEstimate::cov.
Eigen::VectorXd Stack(const TableErrors& errors, const std::vector<Component>& components) {
  const std::size_t n = errors.position_rad.size();
  Eigen::VectorXd stacked(static_cast<Eigen::Index>(components.size() * n));
  for (std::size_t s = 0; s < components.size(); ++s) {
    for (std::size_t i = 0; i < n; ++i) stacked[static_cast<Eigen::Index>(s * n + i)] = errors[components[s]][i];
  }
  return stacked;
}

/// error' cov^-1 error in the directions that the covariance knows, and how many these are.
std::pair<double, int> ChiSquared(const Eigen::VectorXd& error, const Eigen::MatrixXd& cov) {
  // Angles and lengths are brought to one scale before ranks are counted.
  const Eigen::VectorXd sd = cov.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation = sd.cwiseInverse().asDiagonal() * cov * sd.cwiseInverse().asDiagonal();
  const auto [values, vectors] = EigenOfSymmetric(correlation);
  const Eigen::VectorXd scores = vectors.transpose() * error.cwiseQuotient(sd);
  double sum = 0.0;
  int rank = 0;
  for (Eigen::Index k = 0; k < scores.size(); ++k) {
    if (values[k] < 1e-9 * values.maxCoeff()) continue;
    sum += scores[k] * scores[k] / values[k];
    ++rank;
  }
  return {sum, rank};
}

void ExpectStatedScatter(const std::string& clamping) {
  SCOPED_TRACE(clamping);
  double chi2 = 0.0, dof = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scenario scenario = NoisyScenario(clamping);
    scenario.seed = static_cast<std::uint64_t>(seed);
    const test::TwinRun run = test::RunTwin(scenario);
    for (const test::SeparatedTable& t : test::BothTables(test::Evaluate(run), run.truth)) {
      const std::vector<Component>& components = t.estimate.components;
      const Eigen::VectorXd error = Stack(t.estimate.value, components) - Stack(t.truth, components);
      const auto [sum, rank] = ChiSquared(error, t.estimate.cov.ToDense());
      chi2 += sum;
      dof += rank;
    }
  }
  // chi2 has mean dof and standard deviation sqrt(2 dof) if the two tables were independent; they share readings,
  // which at most doubles its variance. Four of these deviations.
  EXPECT_NEAR(chi2, dof, 4.0 * std::sqrt(4.0 * dof));
  EXPECT_GT(dof, 200 * 60);
}

TEST(Scatter, MatchesTheStatedUncertaintyOver200Seeds) {
  for (const char* clamping : {"reclamp", "reseat"}) ExpectStatedScatter(clamping);
}

/// Mean of (error / u)^2 over tables and components of some seeds, the largest.
double LargestMeanChi2(Scenario scenario) {
  constexpr int kRuns = 4;
  std::map<std::string, double> sums;
  for (int seed = 1; seed <= kRuns; ++seed) {
    scenario.seed = static_cast<std::uint64_t>(seed);
    const test::TwinRun run = test::RunTwin(scenario);
    for (const test::SeparatedTable& t : test::BothTables(test::Evaluate(run), run.truth))
      for (const Component c : {Component::kEx, Component::kEy, Component::kEz, Component::kDy})
        sums[t.Name(c)] += MeanChi2(t, c) / kRuns;
  }
  double largest = 0.0;
  for (const auto& [name, mean] : sums) largest = std::max(largest, mean);
  return largest;
}

Scenario FewPositions() {
  return Altered(NoisyScenario("reseat"), {"procedure.positions=9", "procedure.shifts=[0, 1, 2]"});
}

/// The block takes 16 ms and the hum 20 ms; the tables stop after whole hundredths of a second, so that the hum's
/// phase goes with the position, in every pass.
TEST(StatedUncertainty, CoversAHumThatTheSamplesOfABlockShare) {
  const Scenario scenario = LoadScenario(
      test::ScenarioPath("one_of_everything.toml"),
      {"procedure.positions=9", "procedure.shifts=[0,1,2]", "procedure.phases=[\"calibration\",\"full_circle\"]",
       "procedure.keep_raw=false", "adc.samples=1000", "effect=[]", "mechanics.fidelity=\"kinematic\""});
  EXPECT_LT(LargestMeanChi2(scenario), 4.0);
}

/// One position is lost in all set-ups: its error is in no mean.
TEST(Score, TakesWhatIsLostOutOfTruthAndEstimateOverTheSamePositions) {
  test::TwinRun run = test::RunTwin(FewPositions());
  for (Reading& r : run.readings) {
    if (r.phase != Phase::kFullCircle || r.position != 3) continue;
    r.status = ReadingStatus::kClippedSpot;
    r.mean_V.fill(kNaN);
  }
  const benches::rotary::Score score =
      benches::rotary::CompareWithTruth(test::Evaluate(run), run.truth.target, run.truth.reference);
  for (const auto& row : score.components) {
    if (row.positions == 0) continue;
    EXPECT_LT(row.mean_chi2, 4.0) << row.table << " " << static_cast<int>(row.component);
  }
}

/// All passes go over the same turn, so that none shows what the next turn would bring.
TEST(StatedUncertainty, CoversWhatBearingsDoNotRepeat) {
  for (const double radial_um : {1.0, 30.0}) {
    Scenario scenario = FewPositions();
    RotaryOf(scenario).mechanics.asynchronous_radial_m = {radial_um * units::um, radial_um * units::um};
    RotaryOf(scenario).mechanics.asynchronous_tilt_rad = {radial_um * units::arcsec, radial_um * units::arcsec};
    EXPECT_LT(LargestMeanChi2(scenario), 2.5) << radial_um;
  }
}

/// The issue of this project: 0.02 arcsec and 0.02 um rms. Second-order terms alone would be 0.001 arcsec.
void ExpectErrorsReturn(const test::TwinRun& run) {
  for (const test::SeparatedTable& t : test::BothTables(test::Evaluate(run), run.truth)) {
    EXPECT_GE(t.estimate.components.size(), 4u) << "ex, ey, ez and dy are read";
    for (const Component c : t.estimate.components)
      EXPECT_LT(t.RmsError(c), 0.02 * (IsAngle(c) ? units::arcsec : units::um)) << t.Name(c);
  }
}

TEST(NoiseFree, TheRigorousEstimatorReturnsTheInjectedErrorsAlsoBehindRealisticMountings) {
  for (const char* clamping : {"reclamp", "reseat"}) {
    for (const char* seed : {"seed=1", "seed=2", "seed=3"}) {
      SCOPED_TRACE(std::string(clamping) + " " + seed);
      const Scenario scenario = RandomTables(clamping, {"noise_free=true", seed});
      ExpectErrorsReturn(test::RunTwin(scenario));
      // Not random from reading to reading, so noise_free does not take it: the mounting of the body.
      ExpectErrorsReturn(test::RunTwin(
          Altered(scenario, {"reference.mount_tilt_arcsec=[30, -20]", "reference.centring_um=[20, -15]"})));
    }
  }
}

/// Runs seeds 1..count on this many threads, each taking the next seed that is free.
std::vector<std::string> RunSeeds(const Scenario& scenario, std::size_t count, int threads) {
  std::vector<std::string> texts(count);
  test::InParallel(count, threads, [&](std::size_t k) {
    Scenario mine = scenario;
    mine.seed = k + 1;
    texts[k] = test::TextOf(test::RunTwin(mine).readings);
  });
  return texts;
}

TEST(SameSeed, GivesTheSameBitsOnAnyNumberOfThreadsAlsoInFullDynamics) {
  const Scenario few =
      LoadScenario(test::ScenarioPath("rotary_4dof.toml"), {"procedure.positions=12", "procedure.shifts=[0, 1]"});
  for (const char* fidelity : {"kinematic", "linear"}) {
    const Scenario scenario = Altered(few, {std::string("mechanics.fidelity=") + fidelity});
    const auto alone = RunSeeds(scenario, 6, 1);
    for (const int threads : {2, 5}) EXPECT_EQ(alone, RunSeeds(scenario, 6, threads)) << fidelity;
    EXPECT_NE(alone[0], alone[1]) << "another seed must give other bits";
  }
  const Scenario bodies = Altered(few, {"mechanics.fidelity=bullet", "procedure.phases=[\"full_circle\"]",
                                        "procedure.positions=4", "procedure.passes=[1]"});
  EXPECT_EQ(RunSeeds(bodies, 2, 1), RunSeeds(bodies, 2, 2));
}

TEST(OneCauseOneStream, SwitchingOneNoiseOffDoesNotChangeAnother) {
  Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"),
                                   {"mechanics.fidelity=kinematic", "procedure.phases=[\"full_circle\"]", "procedure.shifts=[0]",
                                    "procedure.passes=[1]"});
  const auto with = test::RunTwin(scenario).readings;
  scenario.environment.sensor_noise_K = 0.0;
  const auto without = test::RunTwin(scenario).readings;
  for (std::size_t k = 0; k < with.size(); ++k) EXPECT_EQ(with[k].mean_V, without[k].mean_V);
}

}  // namespace
}  // namespace twinbench
