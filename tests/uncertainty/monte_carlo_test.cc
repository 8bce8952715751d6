#include "tests/uncertainty/bench_budget.h"
#include "twin/uncertainty/agreement.h"
#include "twin/uncertainty/one_at_a_time.h"

namespace twinbench::uncertainty {
namespace {

using test::Computing, test::FourInputs, test::Input, test::InputKeys;

std::vector<Quantity> Sum(const Scenario& s) {
  double sum = 0.0;
  for (std::size_t k = 0; k < InputKeys().size(); ++k) sum += 1e6 * Input(s, k);
  return {{"sum", sum, 0.0}};
}

Scenario FourOf(Distribution distribution, double u = 1e-6) {
  std::vector<StatedUncertainty> stated;
  for (const std::string& key : InputKeys()) stated.push_back({key, u, distribution});
  return FourInputs(stated);
}

/// JCGM 101, 9.2.3: the sum of four rectangular distributions of u = 1 has u = 2 and [-3.88, 3.88].
TEST(MonteCarlo, OfFourRectanglesIsThatOfTheSupplement) {
  const Spread spread = Propagate(FourOf(Distribution::kUniform), Sum, test::Trials(8000)).spreads.at(0);
  EXPECT_NEAR(spread.sd, 2.0, 0.05);
  EXPECT_NEAR(spread.symmetric[0], -3.88, 0.2);
  EXPECT_NEAR(spread.symmetric[1], 3.88, 0.2);
  EXPECT_NEAR(spread.shortest[1] - spread.shortest[0], 2.0 * 3.88, 0.25);
}

TEST(MonteCarlo, StopsWhenTwoDigitsStand) {
  const MonteCarlo result = Propagate(FourOf(Distribution::kNormal), Sum, {});
  EXPECT_TRUE(result.settled);
  EXPECT_LT(result.trials, 20000);
  EXPECT_NEAR(result.spreads.at(0).sd, 2.0, 0.06);
  EXPECT_FALSE(Propagate(FourOf(Distribution::kNormal), Sum, {.most_trials = 1000}).settled)
      << "and says when they do not";
}

TEST(MonteCarlo, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const auto by_threads = [](int threads) {
    return Propagate(FourOf(Distribution::kTriangular), Sum, {.most_trials = 2000, .threads = threads});
  };
  const MonteCarlo a = by_threads(1), b = by_threads(4);
  ASSERT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.spreads.at(0).sd, b.spreads.at(0).sd);
  EXPECT_EQ(a.spreads.at(0).shortest, b.spreads.at(0).shortest);
}

Contribution Of(std::size_t k) {
  return {InputKeys()[k], [k](Scenario& s) {
            Scenario usual = test::FourInputs({});
            NumbersAt(s, InputKeys()[k])[0] = NumbersAt(usual, InputKeys()[k])[0];
          }};
}

/// Errors of 3 and 4 um in the first two.
Scenario OfThreeAndFour() {
  Scenario scenario = test::FourInputs({});
  NumbersAt(scenario, InputKeys()[0])[0] += 3e-3;
  NumbersAt(scenario, InputKeys()[1])[0] += 4e-3;
  return scenario;
}

TEST(OneAtATime, SharesOutWhatAddsInQuadrature) {
  const auto run = [](const Scenario& s) {
    return std::vector<Figure>{{"sd", std::hypot(1e3 * Input(s, 0), 1e3 * Input(s, 1))}};
  };
  const OneAtATime found = RunOneAtATime(OfThreeAndFour(), {Of(0), Of(1), Of(2)}, run);
  EXPECT_NEAR(found.total.at(0).value, 5.0, 1e-9);
  EXPECT_NEAR(found.none.at(0), 0.0, 1e-9);
  ASSERT_EQ(found.shares.size(), 2U) << "the third changes nothing";
  EXPECT_NEAR(found.shares[0].alone.at(0), 3.0, 1e-9);
  EXPECT_NEAR(found.shares[0].without.at(0), 4.0, 1e-9);
  EXPECT_NEAR(found.InQuadrature(0), 5.0, 1e-9);
}

/// A converter without the noise that stays would round the other away.
TEST(OneAtATime, KeepsWhatStaysBesideEveryOther) {
  const auto run = [](const Scenario& s) {
    const double noise = 1e3 * Input(s, 1);
    return std::vector<Figure>{{"sd", noise > 1e-9 ? std::hypot(1e3 * Input(s, 0), noise) : 0.0}};
  };
  Contribution noise = Of(1);
  noise.stays = true;
  const OneAtATime found = RunOneAtATime(OfThreeAndFour(), {Of(0), noise}, run);
  EXPECT_NEAR(found.none.at(0), 4.0, 1e-9);
  EXPECT_NEAR(found.shares[0].alone.at(0), 5.0, 1e-9);
  EXPECT_TRUE(found.shares[1].alone.empty());
  EXPECT_NEAR(found.InQuadrature(0), 5.0, 1e-9);
}

/// GUM and trials of every quantity.
struct Both {
  std::vector<Budget> budgets;
  MonteCarlo trials;

  const Budget& BudgetOf(const std::string& name) const {
    return *std::ranges::find(budgets, name, [](const Budget& b) -> const auto& { return b.quantity.name; });
  }
  const Spread& SpreadOf(const std::string& name) const {
    return *std::ranges::find(trials.spreads, name, [](const Spread& s) -> const auto& { return s.quantity.name; });
  }
  Agreement Of(const std::string& name) const { return Compare(BudgetOf(name), SpreadOf(name), trials.trials); }
};

Both BothOf(const Scenario& scenario, const Evaluate& evaluate, int trials) {
  return {Budgets(scenario, evaluate), Propagate(scenario, evaluate, test::Trials(trials))};
}

TEST(Agreement, HasTheToleranceOfTheSupplement) {
  EXPECT_DOUBLE_EQ(NumericalTolerance(0.25, 1), 0.05);   // JCGM 101, 7.9.2: 2 x 10^-1
  EXPECT_DOUBLE_EQ(NumericalTolerance(0.25, 2), 0.005);  // 25 x 10^-2
  EXPECT_DOUBLE_EQ(NumericalTolerance(37.0, 1), 5.0);
}

/// A sum of normal inputs, and one that repeats to few degrees of freedom.
TEST(Agreement, IsThereForWhatIsLinear) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3}, {InputKeys()[1], 2e-3}});
  const auto sum = Computing("y", [](const Scenario& s) { return 1e3 * (Input(s, 0) + Input(s, 1)); }, 2.0);
  const Agreement agreement = BothOf(scenario, sum, 4000).Of("y");
  EXPECT_EQ(agreement.verdict, Verdict::kAgree) << agreement.d_low << " " << agreement.d_high;
}

/// y = x^2 about 0 has no first order at all: u is right by the second, the interval is not. With x standard normal y is chi-squared of one
/// degree of freedom: all of it lies above zero, and the shortest 95 % interval is not the symmetric one.
TEST(Agreement, IsNotThereForASquare) {
  const Scenario scenario = FourInputs({{InputKeys()[0], 1e-3}});
  const Both both = BothOf(scenario, Computing("y", test::SquareOfFirst), 8000);
  EXPECT_NEAR(both.BudgetOf("y").u, std::sqrt(2.0), 1e-9);
  const Spread& spread = both.SpreadOf("y");
  EXPECT_NEAR(spread.sd, std::sqrt(2.0), 0.15);
  EXPECT_NEAR(spread.shortest[0], 0.0, 0.01);
  EXPECT_NEAR(spread.shortest[1], 3.84, 0.15);
  EXPECT_NEAR(spread.symmetric[1], 5.02, 0.25);
  EXPECT_EQ(both.Of("y").verdict, Verdict::kDiffer);
  EXPECT_NEAR(both.Of("y").d_low, 1.96 * std::sqrt(2.0), 0.01) << "no trial lies below zero";
}

TEST(Agreement, SaysWhenTrialsAreTooFew) {
  const Budget budget{{"y", 0.0, 9.0}, {}, 9.0};
  const Spread spread{{"y", 0.0, 9.0}, 0.0, 9.0, {-17.0, 17.3}, {}};
  EXPECT_EQ(Compare(budget, spread, 200).verdict, Verdict::kTooFewTrials);
}

/// scenarios/circular_encoder_tilt.toml: a lean t of the encoder's axis is an error of t^2 / 4 twice a turn. Both leans of
/// 5 mrad: 1.289 arcsec times chi-squared of two degrees of freedom, whose 97.5 % quantile is 7.38.
TEST(Agreement, IsNotThereForTheTiltOfAnEncoder) {
  const Scenario scenario = test::Small({"circular_encoder_tilt.toml", {}});
  const std::vector<Reading> readings = test::ReadingsOf(scenario);
  const Both both = BothOf(scenario, [&](const Scenario& s) { return test::QuantitiesFrom(s, readings); }, 250);
  const std::string tilted = "errors.encoder.ellipticity_arcsec", straight = "errors.machine.squareness_arcsec";
  const double unit_arcsec = 0.25 * 25e-6 / units::arcsec;
  EXPECT_NEAR(both.BudgetOf(tilted).u, 2.0 * unit_arcsec, 0.4 * unit_arcsec) << "in second order alone, and noise";
  // Of 250 trials the quantile is known to 0.8 of the unit.
  EXPECT_NEAR(both.SpreadOf(tilted).symmetric[1], 7.38 * unit_arcsec, 2.4 * unit_arcsec);
  EXPECT_GT(both.SpreadOf(tilted).shortest[0], -0.5) << "an amplitude is not below zero";
  EXPECT_EQ(both.Of(tilted).verdict, Verdict::kDiffer);
  EXPECT_NE(both.Of(straight).verdict, Verdict::kDiffer);
}

}  // namespace
}  // namespace twinbench::uncertainty
