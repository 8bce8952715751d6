#include <numeric>

#include "tests/uncertainty/bench_budget.h"

/// What the readings leave, by source: on every bench, and against what the scenario says of its instruments.
namespace twinbench::uncertainty {
namespace {

using test::BudgetsOf, test::Small, test::SmallBench, test::SmallBenches;

/// Sum over the quantities of a list of the variance of one source, over that of u.
double ShareOf(const std::vector<Budget>& budgets, const std::string& kind, const std::string& source) {
  double of_source = 0.0, all = 0.0;
  for (const Budget& budget : budgets) {
    if (KindOf(budget.quantity.name) != kind) continue;
    all += budget.u * budget.u;
    for (const Source& s : budget.sources) of_source += s.name == source ? s.u * s.u : 0.0;
  }
  EXPECT_GT(all, 0.0) << "no " << kind;
  return of_source / all;
}

double ShareOf(const Scenario& scenario, const std::string& kind, const std::string& source) {
  return ShareOf(BudgetsOf(scenario), kind, source);
}

/// The lists of results that a bench is built for.
const std::vector<std::string> kLists = {"separation.target.ez_arcsec",      "separation.reference.dy_um",
                                         "separation.turntable.ez_arcsec",   "separation.table_encoder.amplitude_arcsec",
                                         "errors.machine.squareness_arcsec", "error_map.dx_um",
                                         "device.ez_arcsec"};

/// The parts are shares that the estimator finds each for itself; nobody makes them sum to one.
TEST(Parts, OfEveryBenchAddUpToTheSquareOfU) {
  for (const SmallBench& bench : SmallBenches()) {
    int of_lists = 0;
    for (const Budget& budget : BudgetsOf(Small(bench))) {
      const Quantity& q = budget.quantity;
      of_lists += std::ranges::count(kLists, KindOf(q.name)) > 0 ? 1 : 0;
      const double sum =
          std::accumulate(q.parts.begin(), q.parts.end(), 0.0, [](double s, const Part& p) { return s + p.share; });
      EXPECT_NEAR(sum, 1.0, 0.01) << q.name;
      EXPECT_NEAR(budget.u, q.u, 0.005 * q.u) << q.name;
      for (const Part& part : q.parts) EXPECT_GE(part.share, -1e-9) << q.name << " " << part.name;
    }
    EXPECT_GE(of_lists, 1) << bench.file;
  }
}

/// Of what the steps and the noise leave in a list.
double ShareOfSteps(const std::vector<Budget>& budgets, const std::string& kind) {
  const double steps = ShareOf(budgets, kind, "quantisation");
  return steps / (steps + ShareOf(budgets, kind, "noise"));
}

/// A converter of 12 bits over +-10 V has steps of 4.9 mV; noise of 6 mV spreads over them, and the step's share of
/// what a sample scatters by is LSB^2 / 12 of noise^2 + LSB^2 / 12.
TEST(Parts, OfAConverterAreTheStepsOverTwelve) {
  const double lsb = 20.0 / 4096.0, share = lsb * lsb / 12.0 / (36e-6 + lsb * lsb / 12.0);
  const Scenario scenario = Small(SmallBenches()[0], {"adc.bits=12", "amplifier.noise_mV=6.0", "adc.every_sample=true"});
  EXPECT_NEAR(ShareOfSteps(BudgetsOf(scenario), "separation.target.ez_arcsec"), share, 0.15 * share)
      << "other noise than the amplifier's is small";
}

/// Noise as large as a step dithers it: a thirteenth of what a reading scatters by is the step's, and of means by angle; what passes differ by
/// is repeatability.
TEST(Parts, OfAnEncoderAndOfItsMeansAreItsStepsOverTwelve) {
  const std::vector<std::string> coarse = {"device.resolution_deg=0.002", "device.noise_deg=0.002"};
  const std::vector<Budget> budgets = BudgetsOf(Small(SmallBenches()[5], coarse));
  for (const char* kind : {"device.ez_arcsec", "means.both.ez_arcsec"})
    EXPECT_NEAR(ShareOfSteps(budgets, kind), 1.0 / 13.0, 0.35 / 13.0) << "noise is what is left of 144 residuals";
  const double in_reversal = ShareOf(budgets, "reversal.mean_arcsec", "quantisation");
  EXPECT_GT(in_reversal, 0.0);
  EXPECT_LE(in_reversal, 1.35 / 13.0);
}

/// The gains of the rotary bench's detectors: of their readings and of the autocollimator, as both are stated.
TEST(Parts, OfGainsKnowTheAutocollimator) {
  const std::string kind = "calibration.gain.psd_a_x";
  const double quiet = ShareOf(Small(SmallBenches()[0], {"autocollimator.noise_arcsec=0.002"}), kind, "standard"),
               loud = ShareOf(Small(SmallBenches()[0], {"autocollimator.noise_arcsec=1.0"}), kind, "standard");
  EXPECT_LT(quiet, 1e-3);
  EXPECT_GT(loud, 0.5);
}

/// What the published equations are wrong by, in the lists that begin so: the largest share, and how many numbers have one.
std::pair<double, int> LargestOfModel(const Scenario& scenario, const std::vector<std::string>& lists) {
  double largest = 0.0;
  int count = 0;
  for (const Quantity& q : test::QuantitiesFrom(scenario, test::ReadingsOf(scenario), Estimator::kPublished)) {
    if (std::ranges::none_of(lists, [&](const std::string& list) { return KindOf(q.name).starts_with(list); })) continue;
    ++count;
    double sum = 0.0;
    for (const Part& part : q.parts) {
      sum += part.share;
      if (part.name == "model") largest = std::max(largest, part.share);
    }
    EXPECT_NEAR(sum, 1.0, 0.01) << q.name;
  }
  return {largest, count};
}

/// Equal-division averaging with a head 5 deg off equal division errs by far more than its readings scatter; and the
/// published map's uncertainty holds what it is off by, which is more than its noise.
TEST(Parts, OfPublishedHeadsAndMapsHoldWhatTheirEquationsAreWrongBy) {
  const Scenario heads = LoadScenario(test::ScenarioPath("encoder_heads.toml"),
                                      {"encoder_procedure.heads_deg=[0.0, 95.0, 180.0, 270.0]", "encoder_procedure.stops_per_turn=72"});
  const auto [of_heads, of_ring] = LargestOfModel(heads, {"device", "harmonics"});
  EXPECT_GT(of_ring, 360);
  EXPECT_GT(of_heads, 0.9);
  const auto [of_map, points] = LargestOfModel(Small(SmallBenches()[4]), {"error_map"});
  EXPECT_EQ(points, 300);
  EXPECT_GT(of_map, 0.5);
}

/// Seating of 0.3 arcsec beside 0.1 arcsec of the autocollimator is nine tenths of the scatter.
TEST(Parts, OfSeatingAreRepeatability) {
  const Scenario scenario = Small(SmallBenches()[1], {"autocollimator.noise_arcsec=0.1", "multitooth.repeatability.ez_arcsec=0.3",
                                                      "multitooth.u_tooth_arcsec=0.0"});
  const std::vector<Budget> budgets = BudgetsOf(scenario);
  const double noise = ShareOf(budgets, "separation.turntable.ez_arcsec", "noise"),
               seating = ShareOf(budgets, "separation.turntable.ez_arcsec", "repeatability");
  // 48 degrees of freedom: a fifth of the variance.
  EXPECT_NEAR(seating / noise, 9.0, 5.0);
  EXPECT_NEAR(ShareOf(budgets, "separation.roll.gamma_mrad", "repeatability"), 0.9, 0.07) << "the same readings show the roll";
}

/// The noise of a turntable's readings is estimated: nothing that is made of it has a coverage factor of 1.96.
TEST(Parts, OfAnEstimatedNoiseKnowHowManyReadingsAreBehindIt) {
  std::set<std::string> kinds;
  for (const Budget& budget : BudgetsOf(Small(SmallBenches()[1], {"turntable_procedure.positions=12"}))) {
    kinds.insert(KindOf(budget.quantity.name).substr(0, 5));
    EXPECT_LT(budget.quantity.dof, 200.0) << budget.quantity.name;
  }
  for (const char* kind : {"equat", "iso23", "model", "separ"}) EXPECT_EQ(kinds.count(kind), 1u) << kind;
}

/// One shift leaves the teeth in the turntable's errors: their stated uncertainty is type B.
TEST(Parts, OfTheTeethAreTheStandards) {
  const std::vector<Budget> budgets = BudgetsOf(Small(SmallBenches()[1], {"multitooth.u_tooth_arcsec=0.5"}));
  EXPECT_GT(ShareOf(budgets, "separation.turntable.ez_arcsec", "standard"), 0.8);
  const std::vector<Source>& sources = budgets.back().sources;
  const auto teeth = std::ranges::find(sources, "standard", &Source::name);
  ASSERT_NE(teeth, sources.end());
  EXPECT_EQ(teeth->type, 'B');
}

/// Teeth and readings scatter alike from place to place: the orders of the model share as the curve does.
TEST(Parts, OfAModelAreThoseOfItsCurve) {
  const std::vector<Budget> budgets = BudgetsOf(
      Small(SmallBenches()[1], {"turntable_procedure.positions=36", "multitooth.u_tooth_arcsec=0.1"}));
  const double of_curve = ShareOf(budgets, "separation.turntable.ez_arcsec", "standard");
  EXPECT_GT(of_curve, 0.2);
  EXPECT_LT(of_curve, 0.8);
  EXPECT_NEAR(ShareOf(budgets, "model.terms[].amplitude_arcsec", "standard"), of_curve, 0.1);
  EXPECT_NEAR(ShareOf(budgets, "model.terms[].phase_deg", "standard"), of_curve, 0.1);
}

/// A machine that repeats to nothing leaves noise and quanta of the instruments.
TEST(Parts, OfAMachineThatRepeatsAreNoiseAndQuanta) {
  const std::string kind = "errors.machine.squareness_arcsec";
  EXPECT_GT(ShareOf(Small(SmallBenches()[3]), kind, "repeatability"), 0.3) << "0.2 um a reading as it stands";
  EXPECT_LT(ShareOf(Small(SmallBenches()[3], {"machine.noise_um=0.0"}), kind, "repeatability"), 0.15);
}

/// The calibrator of the hobbing machine's interferometer is stated, and far larger than what is read at rest.
TEST(Parts, OfACalibratorAreTheStandards) {
  const std::vector<Budget> budgets = BudgetsOf(Small(SmallBenches()[2]));
  EXPECT_GT(ShareOf(budgets, "table_encoder_by_interferometer.amplitude_arcsec", "standard"), 0.9);
}

}  // namespace
}  // namespace twinbench::uncertainty
