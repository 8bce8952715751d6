#include "tests/scenarios/as_shipped.h"
#include "tests/support/night.h"

#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/turntable_autocollimator/bench.h"

// The answers that the scenarios of the turntable and the hobbing machine promise.
namespace twinbench {
namespace {

using separate::hob::HobAnalysis, separate::hob::OrderStatus, separate::turntable::TurntableAnalysis, units::arcsec;

test::BenchRun Shipped(const std::string& file, const std::vector<std::string>& overrides) {
  return test::RunBench(LoadScenario(test::ScenarioPath(file), overrides));
}

TurntableAnalysis Analysed(const test::BenchRun& run) {
  return separate::turntable::AnalyseTurntable(run.readings, run.scenario, Estimator::kRigorous);
}

/// True index error of a table at its own angle, in arcsec; the truth lists whole degrees.
double Truth_arcsec(const nlohmann::json& table, double angle_rad) {
  const auto& ez = table.at("ez_arcsec");
  const auto k = static_cast<std::size_t>(std::llround(angle_rad / units::deg)) % ez.size();
  return ez.at(k).get<double>();
}

/// estimate - truth at each position, the mean taken out.
std::vector<double> Errors_arcsec(const separate::turntable::AngleSeries& series, const nlohmann::json& table) {
  std::vector<double> errors;
  double mean = 0.0;
  for (std::size_t k = 0; k < series.position_rad.size(); ++k) {
    errors.push_back(series.value_rad[static_cast<Eigen::Index>(k)] / arcsec -
                     Truth_arcsec(table, series.position_rad[k]));
    mean += errors.back() / static_cast<double>(series.position_rad.size());
  }
  for (double& error : errors) error -= mean;
  return errors;
}

/// Mean of (error / u)^2.
double MeanChi2(const separate::turntable::AngleSeries& series, const nlohmann::json& table) {
  const auto errors = Errors_arcsec(series, table);
  double sum = 0.0;
  for (std::size_t k = 0; k < errors.size(); ++k)
    sum += std::pow(errors[k] * arcsec / series.U_rad(static_cast<Eigen::Index>(k)), 2);
  return sum / static_cast<double>(errors.size());
}

TEST(TurntableAutocollimator, IsCompensatedToTwoArcsecAtTheCheckPositionsAndFindsTheRollOfTheCrosshair) {
  const TurntableAnalysis a = Analysed(test::AsShipped("turntable_autocollimator.toml"));
  EXPECT_NEAR(a.before.peak_to_valley_rad / arcsec, 17.82, 0.9) << "the paper's turntable; noise of both ends 0.25";
  ASSERT_TRUE(a.check);
  EXPECT_EQ(a.check->after.count, 144);
  EXPECT_LE(a.check->after.largest_rad / arcsec, 2.0);
  EXPECT_NEAR(a.separation->roll.gamma_rad, 10.47e-3, 4.0 * a.separation->roll.u_gamma_rad);
  EXPECT_LT(a.separation->roll.u_gamma_rad, 1.5e-3) << "0.25 arcsec / (40 arcsec rms over 144 differences)";
}

/// The largest error of equation 5 that was not left out, both counted from the start.
double WorstPointwise_arcsec(const TurntableAnalysis& a, const nlohmann::json& table) {
  double worst = 0.0;
  const double start_arcsec = Truth_arcsec(table, 0.0);
  for (const auto& point : a.pointwise) {
    if (!std::isfinite(point.value_rad)) continue;
    const double truth_arcsec = Truth_arcsec(table, point.turntable_rad) - start_arcsec;
    worst = std::max(worst, std::abs(point.value_rad / arcsec - truth_arcsec));
  }
  return worst;
}

double WorstGlobal_arcsec(const TurntableAnalysis& a, const nlohmann::json& table) {
  double worst = 0.0;
  for (const double error : Errors_arcsec(a.separation->turntable, table)) worst = std::max(worst, std::abs(error));
  return worst;
}

TEST(TurntableAutocollimator, ErrsFarLessThanEquation5AtItsPolesAndIsCompensatedOverManySeeds) {
  const int seeds = test::ByNight(200, 25);
  double pointwise = 0.0, global = 0.0, largest_after = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const test::BenchRun run = Shipped("turntable_autocollimator.toml", {"seed=" + std::to_string(seed)});
    const TurntableAnalysis a = Analysed(run);
    const auto& table = run.truth.at("turntable");
    pointwise += WorstPointwise_arcsec(a, table) / seeds;
    global += WorstGlobal_arcsec(a, table) / seeds;
    largest_after = std::max(largest_after, a.check->after.largest_rad / arcsec);
  }
  EXPECT_GT(pointwise, 5.0 * global) << "mean over seeds of the worst point [arcsec]";
  EXPECT_LE(largest_after, 2.0) << "of 144 checks";
}

/// One shift of the teeth counts them as the turntable's, whatever their certificate says.
TEST(TurntableAutocollimator, KnowsItsTeethNoBetterThanItsScenarioSaysTheyErr) {
  for (const char* errs : {"multitooth.tooth_rms_arcsec=2", "multitooth.random.ez_arcsec=2"}) {
    const test::BenchRun run = Shipped("turntable_autocollimator.toml", {errs});
    EXPECT_LT(MeanChi2(Analysed(run).separation->turntable, run.truth.at("turntable")), 3.0) << errs;
  }
}

TEST(TurntableShifts, SeparateTurntableAndTeethWithinTheirUncertainties) {
  const test::BenchRun& run = test::AsShipped("turntable_shifts.toml");
  const TurntableAnalysis a = Analysed(run);
  EXPECT_EQ(a.separation->status, separate::turntable::IndexingStatus::kSeparated);
  // 36 values: mean 1, deviation sqrt(2 / 36) = 0.24; four of these.
  EXPECT_NEAR(MeanChi2(a.separation->turntable, run.truth.at("turntable")), 1.0, 0.95);
  EXPECT_NEAR(MeanChi2(a.separation->multitooth, run.truth.at("multitooth")), 1.0, 0.95);
}

TEST(TurntableShifts, AreScoredByWhatTheyTellApart) {
  for (const char* shifts : {"[0, 60, 120, 300]", "[0, 180, 0, 180]", "[0, 5, 65, 60]", "[0, 120, 240, 0]"}) {
    const test::BenchRun run =
        Shipped("turntable_shifts.toml", {std::string("turntable_procedure.shifts_teeth=") + shifts, "mechanics.fidelity=kinematic"});
    const auto score = benches::turntable::ScoreRun(run.scenario, run.readings, run.truth, Estimator::kRigorous).json;
    for (const char* table : {"turntable", "multitooth"})
      EXPECT_LT(score.at(table).at("ez").at("mean_chi2").get<double>(), 4.0) << table << " " << shifts;
  }
}

// --- hobbing machine ---

HobAnalysis Analysed(const test::BenchRun& run, Estimator estimator) {
  return separate::hob::AnalyseHob(run.readings, run.scenario, estimator);
}

/// What the interferometer shows at stops holds its calibrator's error in full; its uncertainty says so.
TEST(HobTransmission, ShowsThirteenAndTenArcsecFindsTheEncoderAndAgreesAtRestWithinWhatTheInterferometerErrs) {
  const HobAnalysis a = Analysed(test::AsShipped("hob_transmission.toml"), Estimator::kPublished);
  for (const auto& position : a.positions) {
    const double expected = position.setup == 0 ? 13.0 : 10.0;
    EXPECT_NEAR(separate::hob::Amplitude(position.series.At(1)) / arcsec, expected, 0.3) << position.setup;
  }
  ASSERT_TRUE(a.two_positions);
  EXPECT_NEAR(separate::hob::Amplitude(a.two_positions->encoder) / arcsec, 5.8, 0.3);
  EXPECT_NEAR(separate::hob::Phase(a.two_positions->encoder), 2.72, 0.01);
  ASSERT_TRUE(a.is_interferometer_at_rest);
  const auto& first = a.encoder_against_interferometer.front();
  ASSERT_EQ(first.order, 1);
  EXPECT_NEAR(std::abs(first.difference.value) / arcsec, 0.3, 0.1);
  EXPECT_LT(first.normalised_error, 1.0);
}

TEST(HobTransmission, FindsTheEncoderOverSeedsAndAgreesAtRestToTheNoiseWithAPerfectCalibrator) {
  for (int seed = 1; seed <= test::ByNight(10, 4); ++seed) {
    const HobAnalysis a =
        Analysed(Shipped("hob_transmission.toml", {"seed=" + std::to_string(seed), "mechanics.fidelity=kinematic",
                                                   "interferometer.calibrator=[]", "interferometer.u_calibrator_arcsec=0"}),
                 Estimator::kPublished);
    const auto& first = a.encoder_against_interferometer.front();
    EXPECT_LT(std::abs(first.difference.value) / arcsec, 0.2);  // 0.3 in 72 stops: 0.05 either part
    EXPECT_LT(first.normalised_error, 2.0);                     // 1 is two standard uncertainties
    EXPECT_NEAR(separate::hob::Amplitude(a.two_positions->encoder) / arcsec, 5.8, 0.3);
    EXPECT_NEAR(separate::hob::Phase(a.two_positions->encoder), 2.72, 0.01);
  }
}

/// Steps of both rings that are alike at every visit of a stop.
TEST(HobTransmission, KnowsItsEncoderAtRestNoBetterThanInItsSteps) {
  for (const char* steps : {"table_encoder.interpolation=1", "table_encoder.interpolation=7",
                            "table_encoder.interpolation=50", "hob_encoder.lines=100"}) {
    const test::BenchRun run =
        Shipped("hob_transmission.toml", {steps, "mechanics.fidelity=kinematic", "hob_procedure.turns=2", "hob_procedure.samples_per_turn=360"});
    const auto scored = benches::hob::ScoreRun(run.scenario, run.readings, run.truth, Estimator::kRigorous).json;
    const double chi2 = scored.at("interferometer at rest").at("amplitude").at("mean_chi2").get<double>();
    EXPECT_LT(chi2, 4.0) << steps;
    EXPECT_GT(chi2, 0.05) << steps;
  }
}

/// The gears err by their own angle, which wind-up and backlash hold from the table's; and a fast table is looked at more often.
TEST(HobTransmission, FindsTheGearsErrorsHoweverSoftWornOrFastItIs) {
  for (const char* how : {"transmission.stiffness_Nm_mrad=2", "transmission.backlash_arcsec=1000",
                          "hob_procedure.hob_speeds_rev_min=[20000]"}) {
    const test::BenchRun run = Shipped("hob_transmission.toml", {how, "mechanics.fidelity=kinematic", "hob_procedure.turns=2", "hob_procedure.samples_per_turn=360"});
    const auto scored = benches::hob::ScoreRun(run.scenario, run.readings, run.truth, Estimator::kRigorous).json;
    for (const char* direction : {"transmission +1", "transmission -1"})
      EXPECT_LT(scored.at(direction).at("amplitude").at("mean_chi2").get<double>(), 2.0) << how << ", " << direction;
  }
}

TEST(HobTransmission, AgreesInMotionWithAnInterferometerThatErrsItself) {
  const HobAnalysis a =
      Analysed(Shipped("hob_transmission.toml", {"interferometer.stops=0", "mechanics.fidelity=kinematic"}), Estimator::kPublished);
  const auto& one_place = a.encoder_against_one_place.front();
  ASSERT_EQ(one_place.order, 1);
  // 0.3 arcsec of its calibrator, in full with one place of the head; over two nearly opposite ones a tenth of it.
  const double one_arcsec = std::abs(one_place.difference.value) / arcsec;
  const double mean_arcsec = std::abs(a.encoder_against_interferometer.front().difference.value) / arcsec;
  EXPECT_NEAR(one_arcsec, 0.3, 0.08)
      << "noise of 0.3 arcsec in 720 samples of six turns, and the second harmonic of the hob";
  EXPECT_LT(mean_arcsec, 0.08);
}

TEST(HobTransmission, HasALineAtOrder22AndTheSameHigherOrdersInBothPositions) {
  const HobAnalysis a = Analysed(test::AsShipped("hob_transmission.toml"), Estimator::kRigorous);
  for (const auto& direction : a.directions)
    EXPECT_TRUE(std::ranges::count(direction.lines, 22)) << "once a turn of the hob";
  for (const auto& order : a.separation->orders) {
    if (order.order < 2 || order.dof_alike == 0) continue;
    // With psi = 0: chi-squared of few degrees of freedom; 99 orders, 1e-4 each.
    EXPECT_LT(order.chi2_alike, 4.0 * order.dof_alike + 20.0) << order.order;
  }
}

TEST(HobThreeHeads, TellAllOrdersOfTheEncoderFromThoseOfTheMachine) {
  const test::BenchRun& run = test::AsShipped("hob_three_heads.toml");
  const HobAnalysis a = Analysed(run, Estimator::kRigorous);
  for (const int order : {1, 2, 6}) {
    EXPECT_EQ(a.separation->At(order).status, OrderStatus::kSeparated) << order;
    const auto truth =
        std::ranges::find_if(run.truth.at("table_encoder"), [&](const auto& h) { return h.at("order") == order; });
    const std::complex<double> expected =
        std::polar(truth->at("amplitude_arcsec").get<double>(), truth->at("phase_deg").get<double>() * units::deg);
    const auto& found = a.encoder.At(order);
    EXPECT_LT(std::abs(found.value / arcsec - expected),
              5.0 * separate::hob::LargestUncertainty(found) / arcsec + 0.005)
        << order;
  }
  int sums = 0;
  for (const auto& order : a.separation->orders) sums += order.status == OrderStatus::kSumOnly;
  EXPECT_EQ(sums, 0) << "no order is lost";
}

}  // namespace
}  // namespace twinbench
