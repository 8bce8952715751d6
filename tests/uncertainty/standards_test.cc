#include "tests/support/over_seeds.h"
#include "tests/uncertainty/bench_budget.h"
#include "twin/uncertainty/standards.h"

// The published estimators of the other benches: an uncertainty that holds, or none (rotary_4dof:
// tests/scenarios/uncertainties_test.cc; equation 5 and two head positions: tests/separate).
namespace twinbench::uncertainty {
namespace {

using test::Small, test::SmallBenches;

/// (error / u)^2 of each list of the score, mean over its values and the seeds. What is invalid is not scored.
std::map<std::string, double> MeanSquares(std::size_t bench, int seeds) {
  std::map<std::string, std::pair<double, int>> sums;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Scenario scenario = Small(SmallBenches()[bench], {"seed=" + std::to_string(seed)});
    const test::BenchRun run = test::RunBench(scenario);
    const auto score = BenchOf(scenario).score(scenario, run.readings, run.truth, Estimator::kPublished);
    for (const report::ScoredValue& v : score.values) {
      EXPECT_GT(v.u, 0.0) << v.name;
      auto& [sum, count] = sums[KindOf(v.name)];
      sum += std::pow((v.value - v.truth) / v.u, 2);
      ++count;
    }
  }
  std::map<std::string, double> means;
  for (const auto& [kind, sum] : sums) means[kind] = sum.first / sum.second;
  return means;
}

void ExpectHonest(std::size_t bench, int seeds, const std::vector<std::string>& kinds) {
  const std::map<std::string, double> means = MeanSquares(bench, seeds);
  for (const std::string& kind : kinds) {
    ASSERT_TRUE(means.contains(kind)) << kind;
    testing::Test::RecordProperty(kind, std::to_string(means.at(kind)));
    EXPECT_LT(means.at(kind), 2.0) << kind;
    EXPECT_GT(means.at(kind), 0.1) << kind;
  }
}

TEST(PublishedOfOtherBenches, HoldsForThePathOfTheBarAndTheMapOfTheTip) {
  ExpectHonest(3, 2, {"path[].dx_um", "path[].dy_um"});
  ExpectHonest(4, 2, {"error_map.dx_um", "error_map.dy_um", "error_map.dz_um"});
}

/// Both tilts alike at a position: the equation divides by nearly nothing. The number stays, its u does not.
TEST(PublishedOfOtherBenches, HasNoUncertaintyNearAPole) {
  const Scenario scenario = Small(SmallBenches()[1]);
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const nlohmann::json results = BenchOf(scenario).evaluate(scenario, readings, Estimator::kPublished).results;
  const nlohmann::json& points = results.at("equation_5");
  int near = 0;
  for (std::size_t i = 0; i < points.at("status").size(); ++i) {
    if (points.at("status")[i] != "near_pole" || points.at("u_ez_arcsec")[i] == 0.0) continue;
    EXPECT_TRUE(points.at("u_ez_arcsec")[i].is_null()) << i;
    ++near;
  }
  EXPECT_GT(near, 0);
  EXPECT_NE(results.at("notes").dump().find("INVALID"), std::string::npos);
}

/// The patent's equations know no pivot: they are named, and coefficients of theirs are no results.
TEST(PublishedOfOtherBenches, NamesWhatTheEquationsOfThePatentMiss) {
  const Scenario scenario = Small(SmallBenches()[4]);
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const report::Evaluation published = BenchOf(scenario).evaluate(scenario, readings, Estimator::kPublished);
  EXPECT_EQ(published.results.at("method_bias").at("dx_um").at("status"), "biased");
  EXPECT_FALSE(published.results.contains("squareness"));
  EXPECT_NE(published.summary.find("BIASED"), std::string::npos);
  EXPECT_NE(published.summary.find("INVALID"), std::string::npos);
}

Scenario Nominal() {
  return Small(SmallBenches()[0], {"laser.u_wavelength_nm=0.02", "psd_a.u_distance_mm=0.1",
                                   "psd_b.u_distance_mm=0.1", "autocollimator.u_gain_error=0.002"});
}

double TypeB2(const Budget& budget) {
  double sum2 = 0.0;
  for (const Source& source : budget.sources) sum2 += !IsOfReadings(source) ? source.u * source.u : 0.0;
  return sum2;
}

/// What standards that err do to the results of the twin - nobody who evaluates knows - against what the budget
/// says of it: the same seed with and without their errors, so that noise has no part.
TEST(RotaryUncertainty, IsWhatStandardsThatErrDo) {
  const Scenario nominal = Nominal();
  const std::vector<Reading> readings = test::RunTwin(nominal).readings;
  const auto budgets = Budgets(nominal, [&](const Scenario& s) { return test::QuantitiesFrom(s, readings); });
  ASSERT_FALSE(budgets.empty());
  std::map<std::string, std::pair<double, int>> ratio2;  // by list: sum of squares and count
  constexpr int kBenches = 40;
  for (int bench = 0; bench < kBenches; ++bench) {
    const test::TwinRun run = test::RunTwin(StandardsDrawn(nominal, 11, bench));
    const std::vector<Quantity> found = test::QuantitiesFrom(nominal, run.readings);
    ASSERT_EQ(found.size(), budgets.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double u2 = TypeB2(budgets[i]), u_readings = budgets[i].quantity.u;
      if (u2 < 0.01 * u_readings * u_readings) continue;  // no source of the standards' to speak of
      const double change = found[i].value - budgets[i].quantity.value;
      auto& [sum, count] = ratio2[ListOf(budgets[i].quantity.name)];
      sum += change * change / u2;
      ++count;
    }
  }
  ASSERT_FALSE(ratio2.empty());
  for (const auto& [name, sum] : ratio2) {
    EXPECT_GT(sum.first / sum.second, 0.5) << name;
    EXPECT_LT(sum.first / sum.second, 1.8) << name;
  }
}

Scenario Hob(const std::string& u_arcsec) {
  return LoadScenario(test::ScenarioPath("hob_transmission.toml"), {"interferometer.u_calibrator_arcsec=" + u_arcsec});
}

/// Both parts of every order of the calibrator scatter as it states, and what the scenario has in it is gone.
TEST(StandardsDrawn, DrawTheWavesOfACalibratorAndLeaveOneAloneThatIsSure) {
  const Scenario scenario = Hob("0.2");
  const Eigen::Array2d squares = test::MeanOverSeeds(400, [&](std::uint64_t trial) {
    const Scenario drawn = StandardsDrawn(scenario, 1, static_cast<int>(trial));
    const auto& waves = HobOf(drawn).interferometer.calibrator;
    EXPECT_EQ(waves.size(), 10U);
    EXPECT_EQ(waves.at(0).order, 1.0);
    const std::complex<double> wave =
        std::polar(waves.at(0).amplitude / (0.2 * units::arcsec), waves.at(0).phase_rad);
    return Eigen::Array2d(wave.real() * wave.real(), wave.real() * wave.imag());
  });
  EXPECT_NEAR(squares[0], 1.0, 0.25) << "400 trials: 7 % standard deviation";
  EXPECT_NEAR(squares[1], 0.0, 0.2);
  EXPECT_TRUE(StatesStandards(Hob("0.2")));
  EXPECT_FALSE(StatesStandards(Hob("0.0")));
  EXPECT_EQ(HobOf(StandardsDrawn(Hob("0.0"), 1, 3)).interferometer.calibrator.size(), 2U);
}

}  // namespace
}  // namespace twinbench::uncertainty
